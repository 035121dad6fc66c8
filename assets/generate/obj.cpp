#include "assets/generate/obj.hpp"

#include <cmath>
#include <iterator>

#include <fmt/format.h>

namespace tumble::assets {

std::string obj_text(const std::string& name, const Mesh& mesh) {
  std::string text;
  auto out = std::back_inserter(text);
  fmt::format_to(out, "# Tumble mesh {}, made by generate_assets, MIT licence, metres, Y up\n",
                 name);
  fmt::format_to(out, "o {}\n", name);
  for (const Vec3& p : mesh.vertices) {
    // + 0.0 turns -0 into 0.
    fmt::format_to(out, "v {:.6f} {:.6f} {:.6f}\n", p.x() + 0.0, p.y() + 0.0, p.z() + 0.0);
  }
  for (const auto& t : mesh.triangles) {
    fmt::format_to(out, "f {} {} {}\n", t[0] + 1, t[1] + 1, t[2] + 1);
  }
  return text;
}

}  // namespace tumble::assets
