#include "engine/world/microscope/sketch.hpp"

#include "engine/math/rotation.hpp"

namespace tumble {

void Sketch::add(const Sketch& other) {
  const auto append = [](auto& to, const auto& from) {
    to.insert(to.end(), from.begin(), from.end());
  };
  append(points, other.points);
  append(lines, other.lines);
  append(surfaces, other.surfaces);
  append(labels, other.labels);
  append(ghosts, other.ghosts);
}

void add_polygon(Sketch& out, const std::vector<Vec3>& corners, Ink ink, float opacity) {
  if (corners.size() < 3) return;
  Sketch::Surface surface{{}, ink, opacity};
  for (size_t i = 2; i < corners.size(); ++i)
    surface.triangles.push_back({corners[0], corners[i - 1], corners[i]});
  out.surfaces.push_back(std::move(surface));
  for (size_t i = 0; i < corners.size(); ++i)
    out.line(corners[i], corners[(i + 1) % corners.size()], ink, 1.5f);
}

void add_plane(Sketch& out, const Vec3& centre, const Vec3& normal, double half_width, Ink ink) {
  Vec3 u, v;
  tangent_frame(normal, u, v);
  u *= half_width;
  v *= half_width;
  add_polygon(out, {centre - u - v, centre + u - v, centre + u + v, centre - u + v}, ink, 0.22f);
}

}  // namespace tumble
