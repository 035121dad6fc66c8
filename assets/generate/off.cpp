#include "assets/generate/off.hpp"

#include <iterator>

#include <fmt/format.h>

namespace tumble::assets {

std::string off_text(const std::string& name, const Mesh& mesh) {
  std::string text;
  auto out = std::back_inserter(text);
  fmt::format_to(out, "OFF\n# Tumble mesh {}, made by generate_assets, MIT licence, metres, Y up\n",
                 name);
  fmt::format_to(out, "{} {} 0\n", mesh.vertices.size(), mesh.triangles.size());
  // + 0.0 turns -0 into 0.
  for (const Vec3& p : mesh.vertices)
    fmt::format_to(out, "{} {} {}\n", p.x() + 0.0, p.y() + 0.0, p.z() + 0.0);
  for (const auto& t : mesh.triangles) fmt::format_to(out, "3 {} {} {}\n", t[0], t[1], t[2]);
  return text;
}

}  // namespace tumble::assets
