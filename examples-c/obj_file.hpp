// A minimal OBJ reader for the examples: `v`, and `f` with any number of corners.
#ifndef OBJ_FILE_HPP
#define OBJ_FILE_HPP

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <hangpose.hpp>
#include <sstream>
#include <string>
#include <vector>

struct ObjFile {
  std::vector<hangpose::vec3> vertices;
  std::vector<hangpose::triangle> triangles;

  explicit ObjFile(const char *path) {
    std::ifstream file(path);
    for (std::string line, word; std::getline(file, line);) {
      std::istringstream words(line);
      words >> word;
      if (hangpose::vec3 v; word == "v" && words >> v[0] >> v[1] >> v[2]) vertices.push_back(v);
      if (word != "f") continue;
      std::vector<std::uint32_t> corners;
      while (words >> word)
        corners.push_back(static_cast<std::uint32_t>(std::strtoul(word.c_str(), nullptr, 10) - 1));
      for (std::size_t i = 2; i < corners.size(); ++i)
        triangles.push_back({corners[0], corners[i - 1], corners[i]});
    }
    if (triangles.empty()) std::fprintf(stderr, "%s: cannot read this file, or it has no triangles\n", path);
  }
};

#endif
