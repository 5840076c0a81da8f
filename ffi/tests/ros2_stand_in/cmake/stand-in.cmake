# Stands for the packages of ROS 2 that ros2/CMakeLists.txt finds. scripts/colcon.sh gives each name a file that includes
# this one.
if(NOT TARGET stand_in)
  add_library(stand_in INTERFACE IMPORTED)
  target_include_directories(stand_in INTERFACE ${CMAKE_CURRENT_LIST_DIR}/../include)
  target_compile_features(stand_in INTERFACE cxx_std_17)
  add_library(rclcpp::rclcpp ALIAS stand_in)
  add_library(tf2_ros::tf2_ros ALIAS stand_in)
  function(ament_package)
  endfunction()
endif()
set(${CMAKE_FIND_PACKAGE_NAME}_TARGETS stand_in)
