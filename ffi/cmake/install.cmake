# Files of `make install` and of the Debian packages. They refer to each other by relative paths, so the installation can
# be moved. Components: `library` is what a program needs to run, `development` what it needs to be built, `command` the
# command hangpose, which is built by cargo and not by this project.
set(HANGPOSE_COMMAND "" CACHE FILEPATH
  "The built command hangpose, to be installed with its completions and man pages; empty for the library alone")

install(TARGETS hangpose_static hangpose_shared EXPORT hangpose-targets
  ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT development
  LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT library NAMELINK_COMPONENT development)
install(FILES include/hangpose.h include/hangpose.hpp DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT development)
install(FILES include/hangpose/ros2.hpp include/hangpose/second_thread.hpp include/hangpose/values.hpp
  DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/hangpose COMPONENT development)

set(config_dir ${CMAKE_INSTALL_LIBDIR}/cmake/hangpose)
install(EXPORT hangpose-targets NAMESPACE hangpose:: DESTINATION ${config_dir} COMPONENT development)
write_basic_package_version_file(hangpose-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ffi/cmake/hangpose-config.cmake ${CMAKE_CURRENT_BINARY_DIR}/hangpose-config-version.cmake
  DESTINATION ${config_dir} COMPONENT development)

# Relative path from the folder of hangpose.pc to the prefix.
file(RELATIVE_PATH to_prefix /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
string(REGEX REPLACE "/$" "" to_prefix "${to_prefix}")
configure_file(ffi/cmake/hangpose.pc.in hangpose.pc @ONLY)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/hangpose.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig
  COMPONENT development)

# ROS 2 finds packages through these files.
install(FILES package.xml DESTINATION ${CMAKE_INSTALL_DATADIR}/hangpose COMPONENT development)
file(WRITE ${CMAKE_CURRENT_BINARY_DIR}/hangpose "")
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/hangpose
  DESTINATION ${CMAKE_INSTALL_DATADIR}/ament_index/resource_index/packages COMPONENT development)

if(HANGPOSE_COMMAND)
  include(ffi/cmake/command.cmake)
endif()
include(ffi/cmake/debian.cmake)
