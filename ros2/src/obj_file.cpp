#include "obj_file.hpp"

#include <fstream>
#include <sstream>

namespace hangpose_ros {
namespace {

// The vertex of a corner `v`, `v/t`, `v//n` or `v/t/n`, counted from 0; false if there is no such vertex. A
// negative number counts back from the newest vertex.
bool vertex_of(const std::string &corner, std::size_t vertices, std::uint32_t &vertex) {
  std::istringstream digits(corner.substr(0, corner.find('/')));
  long long number = 0;
  if (!(digits >> number) || !digits.eof()) return false;
  if (number < 0) number += static_cast<long long>(vertices) + 1;
  if (number < 1 || number > static_cast<long long>(vertices)) return false;
  vertex = static_cast<std::uint32_t>(number - 1);
  return true;
}

}  // namespace

ObjFile::ObjFile(const std::string &path) {
  std::ifstream file(path);
  if (!file) {
    error = path + ": cannot be opened: check the parameter object_file";
    return;
  }
  std::size_t number = 0;
  for (std::string line; std::getline(file, line);) {
    ++number;
    std::istringstream words(line);
    std::string word;
    words >> word;
    if (word == "v") {
      hangpose::vec3 at{};
      if (!(words >> at[0] >> at[1] >> at[2])) {
        error = path + ":" + std::to_string(number) + ": a vertex needs three numbers: export the file anew";
        return;
      }
      vertices.push_back(at);
    } else if (word == "f") {
      std::vector<std::uint32_t> corners;
      while (words >> word) {
        std::uint32_t vertex = 0;
        if (!vertex_of(word, vertices.size(), vertex)) {
          error = path + ":" + std::to_string(number) + ": there is no vertex '" + word +
                  "' before this line: export the file anew";
          return;
        }
        corners.push_back(vertex);
      }
      for (std::size_t i = 2; i < corners.size(); ++i)
        triangles.push_back({corners[0], corners[i - 1], corners[i]});
    }
  }
  if (triangles.empty())
    error = path + ": has no triangles: pass a mesh in the OBJ format, with lines that begin with v and f";
}

}  // namespace hangpose_ros
