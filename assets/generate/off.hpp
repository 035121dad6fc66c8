#pragma once
#include "assets/generate/mesh.hpp"

#include <string>

namespace tumble::assets {

/// The whole OFF file: a header, then vertices with as many digits as tell them from all other
/// numbers, then faces. For meshes that must fit to rounding: many readers of OBJ files keep single
/// precision only.
std::string off_text(const std::string& name, const Mesh& mesh);

}  // namespace tumble::assets
