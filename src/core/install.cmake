# Installs the library for find_package and pkg-config, the command if it is built with its man pages and completions, the
# scenes and the documentation. Every path is relative to the prefix, which may be moved. `cmake --build BUILD --target
# uninstall` removes it all. The components are the Debian packages (src/packaging/packages.cmake).
include(CMakePackageConfigHelpers)

set(SHEAF_PACKAGE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/sheaf)
if(SHEAF_BUILD_COMMAND)
  install(TARGETS sheaf RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT command)
endif()
install(TARGETS sheaf_lib EXPORT sheafTargets
  ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT development
  LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT library NAMELINK_COMPONENT development)
if(OPENIMAGEIO_FOUND)
  install(TARGETS sheaf_openimageio LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT images)
endif()
if(TARGET sheaf_window)
  install(TARGETS sheaf_window LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT window)
endif()
if(TARGET sheaf_mpi)
  install(TARGETS sheaf_mpi LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT mpi)
endif()
install(EXPORT sheafTargets NAMESPACE sheaf:: DESTINATION ${SHEAF_PACKAGE_DIR} COMPONENT development)
install(DIRECTORY src/sheaf DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT development FILES_MATCHING PATTERN "*.h")
install(DIRECTORY scenes DESTINATION ${CMAKE_INSTALL_DATADIR}/sheaf COMPONENT command FILES_MATCHING PATTERN "*.json")

# The documentation, and what the parts are made of (SPDX 2.3).
set(SHEAF_DOC_DIR ${CMAKE_INSTALL_DATADIR}/doc/sheaf)
install(FILES README.md CHANGELOG.md DESTINATION ${SHEAF_DOC_DIR} COMPONENT command)
install(DIRECTORY docs DESTINATION ${SHEAF_DOC_DIR} COMPONENT command PATTERN site EXCLUDE PATTERN build.sh EXCLUDE)
if(NOT SHEAF_DEBIAN)  # Debian has the text of its own
  install(FILES LICENSES/Apache-2.0.txt RENAME LICENSE DESTINATION ${SHEAF_DOC_DIR} COMPONENT command)
endif()
include(src/core/bill_of_materials.cmake)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/sheaf.spdx.json DESTINATION ${SHEAF_DOC_DIR} COMPONENT command)

# Man pages and completions are what the command says of itself.
if(SHEAF_BUILD_COMMAND AND NOT CMAKE_CROSSCOMPILING)
  set(SHEAF_MANUAL ${CMAKE_CURRENT_BINARY_DIR}/manual)
  add_custom_command(OUTPUT ${SHEAF_MANUAL}/sheaf.1
    COMMAND ${CMAKE_COMMAND} -DSHEAF=$<TARGET_FILE:sheaf> -DTO=${SHEAF_MANUAL} -DCOMPRESS=${SHEAF_DEBIAN}
      -P ${CMAKE_CURRENT_SOURCE_DIR}/src/app/write_manual.cmake
    DEPENDS sheaf src/app/write_manual.cmake COMMENT "Writing man pages and completions")
  add_custom_target(sheaf_manual ALL DEPENDS ${SHEAF_MANUAL}/sheaf.1)
  if(SHEAF_DEBIAN)
    set(SHEAF_ZSH_DEFAULT ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions)
    set(SHEAF_PAGES "*.1.gz")
  else()
    set(SHEAF_ZSH_DEFAULT ${CMAKE_INSTALL_DATADIR}/zsh/site-functions)
    set(SHEAF_PAGES "*.1")
  endif()
  set(SHEAF_ZSH_DIR ${SHEAF_ZSH_DEFAULT} CACHE STRING "Where completions for zsh are installed, below the prefix")
  install(DIRECTORY ${SHEAF_MANUAL}/ DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT command FILES_MATCHING PATTERN ${SHEAF_PAGES})
  install(FILES ${SHEAF_MANUAL}/sheaf.bash RENAME sheaf DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions COMPONENT command)
  install(FILES ${SHEAF_MANUAL}/_sheaf DESTINATION ${SHEAF_ZSH_DIR} COMPONENT command)
endif()
add_custom_target(uninstall
  COMMAND ${CMAKE_COMMAND} -DBUILD=${CMAKE_CURRENT_BINARY_DIR} -P ${CMAKE_CURRENT_SOURCE_DIR}/src/core/uninstall.cmake)

write_basic_package_version_file(sheafConfigVersion.cmake COMPATIBILITY SameMinorVersion)
configure_package_config_file(src/core/sheafConfig.cmake.in sheafConfig.cmake INSTALL_DESTINATION ${SHEAF_PACKAGE_DIR})
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/sheafConfig.cmake ${CMAKE_CURRENT_BINARY_DIR}/sheafConfigVersion.cmake
  DESTINATION ${SHEAF_PACKAGE_DIR} COMPONENT development)

# What a static library leaves to link, for pkg-config --static. A shared one has linked it.
if(BUILD_SHARED_LIBS)
  set(SHEAF_PC_CFLAGS " -DSHEAF_SHARED")
else()
  set(SHEAF_PC_REQUIRES "libhwy, tbb, fmt, libpng, tinygltf, libturbojpeg")
  if(OpenEXR_FOUND)
    string(APPEND SHEAF_PC_REQUIRES ", OpenEXR")
  endif()
  set(SHEAF_PC_LIBS "-pthread -lstdc++ -lm")
  if(OpenImageDenoise_FOUND)  # it has no file for pkg-config
    string(PREPEND SHEAF_PC_LIBS "-lOpenImageDenoise ")
  endif()
endif()
file(RELATIVE_PATH SHEAF_PC_PREFIX /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
configure_file(src/core/sheaf.pc.in sheaf.pc @ONLY)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/sheaf.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT development)
