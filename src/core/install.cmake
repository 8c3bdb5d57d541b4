# Installs the library for find_package and pkg-config, the command if it is built, and the scenes. Every path is relative to
# the prefix, which may be moved.
include(CMakePackageConfigHelpers)

set(SHEAF_PACKAGE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/sheaf)
if(SHEAF_BUILD_COMMAND)
  install(TARGETS sheaf RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
endif()
install(TARGETS sheaf_lib EXPORT sheafTargets
  ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
if(OPENIMAGEIO_FOUND)
  install(TARGETS sheaf_openimageio LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
endif()
install(EXPORT sheafTargets NAMESPACE sheaf:: DESTINATION ${SHEAF_PACKAGE_DIR})
install(DIRECTORY src/sheaf DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} FILES_MATCHING PATTERN "*.h")
install(DIRECTORY scenes DESTINATION ${CMAKE_INSTALL_DATADIR}/sheaf FILES_MATCHING PATTERN "*.json")

write_basic_package_version_file(sheafConfigVersion.cmake COMPATIBILITY SameMinorVersion)
configure_package_config_file(src/core/sheafConfig.cmake.in sheafConfig.cmake INSTALL_DESTINATION ${SHEAF_PACKAGE_DIR})
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/sheafConfig.cmake ${CMAKE_CURRENT_BINARY_DIR}/sheafConfigVersion.cmake
  DESTINATION ${SHEAF_PACKAGE_DIR})

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
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/sheaf.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
