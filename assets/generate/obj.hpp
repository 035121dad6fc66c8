#pragma once
#include "assets/generate/mesh.hpp"

#include <string>

namespace tumble::assets {

/// The whole OBJ file: a header, then v lines with six decimals and f lines.
std::string obj_text(const std::string& name, const Mesh& mesh);

}  // namespace tumble::assets
