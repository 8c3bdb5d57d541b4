# The Debian packages, by CPack: one a component of the installation. src/packaging/build.sh configures, builds and checks them.
#
# The library's package has the number of its soname in its name, as Debian's policy (8.1) wants it: libsheaf.so.0.2.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME sheaf)
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGE_VENDOR "The Sheaf authors")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "")  # each package has its own
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
  OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)

set(SHEAF_SONAME_PACKAGE libsheaf${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
set(SHEAF_MAINTAINER "The Sheaf authors <sheaf@users.noreply.github.com>" CACHE STRING "Of the Debian packages")
set(CPACK_DEBIAN_PACKAGE_MAINTAINER ${SHEAF_MAINTAINER})
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${CMAKE_BINARY_DIR})

# What each component's package is called, and says of itself. The first line of a description is the short one.
function(sheaf_package component name section description)
  string(TOUPPER ${component} upper)
  set(CPACK_DEBIAN_${upper}_PACKAGE_NAME ${name} PARENT_SCOPE)
  set(CPACK_DEBIAN_${upper}_PACKAGE_SECTION ${section} PARENT_SCOPE)
  set(CPACK_DEBIAN_${upper}_DESCRIPTION "${description}" PARENT_SCOPE)

  # What Debian wants below share/doc of each package, and its exceptions from lintian's rules.
  set(folder ${CMAKE_BINARY_DIR}/packaging/${name})
  file(MAKE_DIRECTORY ${folder})
  configure_file(${PROJECT_SOURCE_DIR}/src/packaging/copyright ${folder}/copyright COPYONLY)
  string(TIMESTAMP date "%a, %d %b %Y %H:%M:%S +0000" UTC)
  file(WRITE ${folder}/changelog "sheaf (${PROJECT_VERSION}) unstable; urgency=medium

  * Version ${PROJECT_VERSION}; /usr/share/doc/sheaf/CHANGELOG.md says what is new.

 -- ${SHEAF_MAINTAINER}  ${date}
")
  execute_process(COMMAND gzip -9nf ${folder}/changelog COMMAND_ERROR_IS_FATAL ANY)
  install(FILES ${folder}/copyright ${folder}/changelog.gz DESTINATION share/doc/${name} COMPONENT ${component})
  if(EXISTS ${PROJECT_SOURCE_DIR}/src/packaging/lintian/${component})
    file(READ ${PROJECT_SOURCE_DIR}/src/packaging/lintian/${component} overrides)
    string(REPLACE "@PACKAGE@" ${name} overrides "${overrides}")
    file(WRITE ${folder}/overrides "${overrides}")
    install(FILES ${folder}/overrides RENAME ${name} DESTINATION share/lintian/overrides COMPONENT ${component})
  endif()
endfunction()

set(CPACK_COMPONENTS_ALL command library development)
sheaf_package(command sheaf graphics
"SIMD packet ray tracer for CPUs
The command sheaf renders scenes and models (glTF, OBJ, PLY, NFF and its own
JSON) with mirrors, glass and hard shadows after Whitted. A picture has the
same bits on every processor and with any number of threads.")
sheaf_package(library ${SHEAF_SONAME_PACKAGE} libs
"SIMD packet ray tracer for CPUs - library
Sheaf traces rays in packets as wide as the processor's vectors, against
triangles, spheres and disks, watertight and with the same bits on every
processor, and renders scenes after Whitted.

This is the shared library.")
# What other packages that link it depend on, and that the linker's cache is renewed.
file(WRITE ${CMAKE_BINARY_DIR}/packaging/shlibs
  "libsheaf ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR} ${SHEAF_SONAME_PACKAGE} (>= ${PROJECT_VERSION})\n")
file(WRITE ${CMAKE_BINARY_DIR}/packaging/triggers "activate-noawait ldconfig\n")
set(CPACK_DEBIAN_LIBRARY_PACKAGE_CONTROL_EXTRA
  ${CMAKE_BINARY_DIR}/packaging/shlibs ${CMAKE_BINARY_DIR}/packaging/triggers)
sheaf_package(development libsheaf-dev libdevel
"SIMD packet ray tracer for CPUs - development files
Sheaf traces rays in packets as wide as the processor's vectors, against
triangles, spheres and disks, watertight and with the same bits on every
processor, and renders scenes after Whitted.

These are the headers for C++20 and for C99, and files for CMake and
pkg-config.")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS "${SHEAF_SONAME_PACKAGE} (= ${PROJECT_VERSION}), libglm-dev")
if(OPENIMAGEIO_FOUND)
  list(APPEND CPACK_COMPONENTS_ALL images)
  sheaf_package(images sheaf-openimageio graphics
"SIMD packet ray tracer for CPUs - more image formats
With this package sheaf, its library and its Python module read textures and
surroundings of BMP, TGA, TIFF, WebP, HDR and EXR, by OpenImageIO.")
  set(CPACK_DEBIAN_COMMAND_PACKAGE_SUGGESTS sheaf-openimageio)
  set(CPACK_DEBIAN_LIBRARY_PACKAGE_SUGGESTS sheaf-openimageio)
endif()
if(TARGET sheaf_python)
  list(APPEND CPACK_COMPONENTS_ALL python)
  sheaf_package(python python3-sheaf python
"SIMD packet ray tracer for CPUs - Python module
Traces rays against triangles, spheres and disks, and renders scenes, on the
arrays of NumPy as they lie in memory. A stand-in for the rays of trimesh is
there, too.")
  math(EXPR SHEAF_NEXT_PYTHON "${Python_VERSION_MINOR} + 1")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS
    "python3 (>= 3.${Python_VERSION_MINOR}), python3 (<< 3.${SHEAF_NEXT_PYTHON}), python3-numpy, ${SHEAF_SONAME_PACKAGE} (= ${PROJECT_VERSION})")
  # Compiles the package's files where it is installed, and removes what that made.
  foreach(script postinst prerm)
    configure_file(${PROJECT_SOURCE_DIR}/src/packaging/python.${script} ${CMAKE_BINARY_DIR}/packaging/${script} COPYONLY
      FILE_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
    list(APPEND CPACK_DEBIAN_PYTHON_PACKAGE_CONTROL_EXTRA ${CMAKE_BINARY_DIR}/packaging/${script})
  endforeach()
endif()
include(CPack)
