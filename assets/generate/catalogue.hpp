#pragma once
#include "assets/generate/mesh.hpp"

#include <string>

namespace tumble::assets {

/// One mesh of assets/meshes.
struct Asset {
  const char* name;  ///< file name without .obj
  const char* what;  ///< a line for people: what it is and where its origin and axis are
  Mesh (*make)();
};

/// Every asset, sorted by name. To add one: write its function, declare it in makers.hpp, add a
/// line here, run generate_assets, and put the line it prints for it into assets/README.md.
const std::vector<Asset>& all_assets();

/// The line of the table in assets/README.md.
std::string table_row(const Asset& asset);

}  // namespace tumble::assets
