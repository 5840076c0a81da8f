# Files of `make install` and of the Debian package. They refer to each other by relative paths, so the installation can
# be moved.
install(TARGETS hangpose_static hangpose_shared EXPORT hangpose-targets
  ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(FILES include/hangpose.h include/hangpose.hpp DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(FILES include/hangpose/values.hpp DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/hangpose)

set(config_dir ${CMAKE_INSTALL_LIBDIR}/cmake/hangpose)
install(EXPORT hangpose-targets NAMESPACE hangpose:: DESTINATION ${config_dir})
write_basic_package_version_file(hangpose-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ffi/cmake/hangpose-config.cmake ${CMAKE_CURRENT_BINARY_DIR}/hangpose-config-version.cmake
  DESTINATION ${config_dir})

# Relative path from the folder of hangpose.pc to the prefix.
file(RELATIVE_PATH to_prefix /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
string(REGEX REPLACE "/$" "" to_prefix "${to_prefix}")
configure_file(ffi/cmake/hangpose.pc.in hangpose.pc @ONLY)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/hangpose.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)

# ROS 2 finds packages through these files.
install(FILES package.xml DESTINATION ${CMAKE_INSTALL_DATADIR}/hangpose)
file(WRITE ${CMAKE_CURRENT_BINARY_DIR}/hangpose "")
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/hangpose
  DESTINATION ${CMAKE_INSTALL_DATADIR}/ament_index/resource_index/packages)

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_PACKAGE_VENDOR "the hangpose developers")
set(CPACK_PACKAGE_CONTACT "the hangpose developers <hangpose@example.org>")
set(CPACK_DEBIAN_PACKAGE_NAME libhangpose-dev)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_DESCRIPTION "${PROJECT_DESCRIPTION}
 Predicts ranked poses from a triangle mesh of the object and a point cloud of the supporter, in memory that the caller
 owns. Contains libhangpose.a, libhangpose.so, the headers for C and C++, and the CMake and pkg-config files.")
install(FILES ${CMAKE_CURRENT_SOURCE_DIR}/LICENSE-MIT DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/libhangpose-dev
  RENAME copyright)
install(FILES LICENSE-APACHE DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/libhangpose-dev)
include(CPack)
