#pragma once
#include "assets/generate/mesh.hpp"

#include <string>

namespace tumble::assets {

/// One mesh of assets/meshes.
struct Asset {
  const char* name;  ///< file name without its ending
  const char* what;  ///< a line for people: what it is and where its origin and axis are
  Mesh (*make)();
  bool exact = false;  ///< off the grid of micrometres, written in full as OFF instead of OBJ
};

/// What stands in assets/meshes for it: the name of the file and its text.
std::string file_name(const Asset& asset);
std::string file_text(const Asset& asset, const Mesh& mesh);

/// Every asset, sorted by name. To add one: write its function, declare it in makers.hpp, add a
/// line here, run generate_assets, and put the line it prints for it into assets/README.md.
const std::vector<Asset>& all_assets();

/// The line of the table in assets/README.md.
std::string table_row(const Asset& asset);

}  // namespace tumble::assets
