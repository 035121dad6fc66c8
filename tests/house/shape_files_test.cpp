// A shape answers for itself: which files name a type of shape. Reference: the text of the sources.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <set>
#include <string>

#include <doctest/doctest.h>

namespace fs = std::filesystem;

TEST_CASE("one more shape touches seven files: no others ask for a type") {
  // What makes shapes of a fixed kind for its own purpose is free to name it.
  const std::set<std::string> makers{
      "engine/scene/build/body_defs.cpp",         // meshes, by the mode that they are declared with
      "engine/scene/build/emitter_overlaps.cpp",  // the regions of emitters
      "engine/scene/build/mesh_parts.cpp",        // what meshes collide as
      "engine/scene/drop_in.cpp",                 // a table on a floor
      "engine/scene/robot_files/robot_model.cpp",  // the shapes of robot files
      "engine/scene/workloads/hulls.cpp",          // the fixed pieces of work of `tumble bench`
      "engine/scene/workloads/parts.cpp",
      "engine/scene/workloads/solid_depth.cpp",
      "engine/scene/workloads/tori.cpp",
      "engine/collision/fitting/primitive_kinds.hpp",  // what may stand for a mesh
      "engine/collision/fitting/primitive_kinds.cpp",
      "engine/collision/narrow_phase.cpp",  // closed forms of pairs of types
      "engine/collision/shape.hpp",
      "engine/collision/shape.cpp",
  };
  const fs::path root = TUMBLE_SOURCE_DIR;
  int named = 0;
  for (const char* top : {"engine", "viewer"})
    for (const auto& entry : fs::recursive_directory_iterator(root / top)) {
      const auto extension = entry.path().extension();
      if (extension != ".hpp" && extension != ".cpp") continue;
      const std::string here = fs::relative(entry.path(), root).generic_string();
      if (here.starts_with("engine/collision/shapes/") || makers.contains(here)) continue;
      std::ifstream in(entry.path());
      int number = 0;
      for (std::string line; std::getline(in, line);) {
        ++number;
        if (line.find("ShapeType::") == std::string::npos) continue;
        ++named;
        FAIL_CHECK(here << ":" << number << " names a type of shape; ask the shape instead "
                        << "(engine/collision/shapes/README.md)");
      }
    }
  CHECK(named == 0);
}

TEST_CASE("a type of shape is named in its own file of shapes/ alone") {
  const fs::path folder = fs::path(TUMBLE_SOURCE_DIR) / "engine/collision/shapes";
  int files = 0;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() != ".cpp" && entry.path().extension() != ".hpp") continue;
    std::ifstream in(entry.path());
    for (std::string line; std::getline(in, line);) {
      const size_t at = line.find("ShapeType::");
      if (at == std::string::npos) continue;
      ++files;
      const std::string type = line.substr(at + 11, line.find_first_of(",;)} ", at) - at - 11);
      CHECK(type == entry.path().stem().string());
    }
  }
  CHECK(files >= 10);
}
