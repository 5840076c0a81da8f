// Reads the triangles of an OBJ file: `v`, and `f` with any number of corners.
#ifndef HANGPOSE_ROS_OBJ_FILE_HPP
#define HANGPOSE_ROS_OBJ_FILE_HPP

#include <hangpose.hpp>
#include <string>
#include <vector>

namespace hangpose_ros {

struct ObjFile {
  std::vector<hangpose::vec3> vertices;
  std::vector<hangpose::triangle> triangles;
  // What is wrong with the file and where, or empty.
  std::string error;

  explicit ObjFile(const std::string &path);
};

}  // namespace hangpose_ros

#endif
