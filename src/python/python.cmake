# The Python package, where Python, NumPy and pybind11 are found. It is built to python/sheaf in the build folder, so that
# PYTHONPATH=build/release/python finds it, and installed where the system's Python looks.

# The system's Python, which has the system's NumPy: another one that is first in PATH has seldom its own.
if(NOT DEFINED Python_EXECUTABLE AND NOT DEFINED Python_ROOT_DIR AND EXISTS /usr/bin/python3)
  set(Python_EXECUTABLE /usr/bin/python3)
endif()
find_package(Python 3.9 COMPONENTS Interpreter Development.Module NumPy QUIET)
if(Python_FOUND)
  find_package(pybind11 2.9 CONFIG QUIET)
endif()
if(NOT Python_FOUND OR NOT pybind11_FOUND)
  sheaf_note_missing("Python 3.9 with NumPy and pybind11" "no Python module is built")
  return()
endif()

file(GLOB SHEAF_PYTHON_SOURCES CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/python/*.cc)
file(GLOB SHEAF_PYTHON_FILES CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/python/sheaf/*)
list(FILTER SHEAF_PYTHON_FILES EXCLUDE REGEX "__pycache__")
set(SHEAF_PYTHON_BUILD ${PROJECT_BINARY_DIR}/python/sheaf)
file(MAKE_DIRECTORY ${SHEAF_PYTHON_BUILD})
foreach(file IN LISTS SHEAF_PYTHON_FILES)
  get_filename_component(name ${file} NAME)
  file(CREATE_LINK ${file} ${SHEAF_PYTHON_BUILD}/${name} SYMBOLIC)
endforeach()

pybind11_add_module(sheaf_python MODULE NO_EXTRAS ${SHEAF_PYTHON_SOURCES})
target_link_libraries(sheaf_python PRIVATE sheaf_lib sheaf_flags Python::NumPy)
set_target_properties(sheaf_python PROPERTIES
  OUTPUT_NAME _sheaf LIBRARY_OUTPUT_DIRECTORY ${SHEAF_PYTHON_BUILD} CXX_VISIBILITY_PRESET hidden)

if(SHEAF_INSTALL)
  if(EXISTS /usr/lib/python3/dist-packages)  # Debian's place, the same for all versions of Python 3
    set(SHEAF_PYTHON_DEFAULT lib/python3/dist-packages)
  else()
    set(SHEAF_PYTHON_DEFAULT lib/python${Python_VERSION_MAJOR}.${Python_VERSION_MINOR}/site-packages)
  endif()
  set(SHEAF_PYTHON_DIR ${SHEAF_PYTHON_DEFAULT} CACHE STRING "Where the Python package is installed, below the prefix")
  file(RELATIVE_PATH SHEAF_PYTHON_TO_LIBRARY /${SHEAF_PYTHON_DIR}/sheaf /${CMAKE_INSTALL_LIBDIR})
  set_target_properties(sheaf_python PROPERTIES INSTALL_RPATH "$ORIGIN/${SHEAF_PYTHON_TO_LIBRARY}")
  install(TARGETS sheaf_python LIBRARY DESTINATION ${SHEAF_PYTHON_DIR}/sheaf COMPONENT python)
  install(FILES ${SHEAF_PYTHON_FILES} DESTINATION ${SHEAF_PYTHON_DIR}/sheaf COMPONENT python)
endif()
