#include "engine/geometry/constructions/surface_samples.hpp"

#include "engine/geometry/constructions/radical_inverse.hpp"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

/// Index of the item in which a cumulative sum reaches `fraction` of its total.
size_t item_at(const std::vector<double>& before, double fraction) {
  const auto above =
      std::upper_bound(before.begin() + 1, before.end() - 1, fraction * before.back());
  return size_t(above - before.begin()) - 1;
}

Vec3 on_triangle(const TriangleMesh& mesh, size_t t, double u, double v) {
  if (u + v > 1) u = 1 - u, v = 1 - v;
  return mesh.corner(t, 0) + u * (mesh.corner(t, 1) - mesh.corner(t, 0)) +
         v * (mesh.corner(t, 2) - mesh.corner(t, 0));
}

}  // namespace

SurfaceSamples::SurfaceSamples(const TriangleMesh& mesh)
    : mesh_(mesh), area_before_(mesh.triangles.size() + 1, 0) {
  for (size_t t = 0; t < mesh.triangles.size(); ++t)
    area_before_[t + 1] = area_before_[t] + face_area_vector(mesh, t).norm();
}

SurfaceSamples::Sample SurfaceSamples::operator()(size_t n) const {
  const size_t t = item_at(area_before_, radical_inverse(n, 2));
  return {on_triangle(mesh_, t, radical_inverse(n, 3), radical_inverse(n, 5)), uint32_t(t)};
}

InsideSamples::InsideSamples(const TriangleMesh& convex)
    : mesh_(convex), volume_before_(convex.triangles.size() + 1, 0) {
  for (const Vec3& v : convex.vertices) apex_ += v / double(convex.vertices.size());
  for (size_t t = 0; t < convex.triangles.size(); ++t)
    volume_before_[t + 1] =
        volume_before_[t] +
        std::max(face_area_vector(convex, t).dot(convex.corner(t, 0) - apex_), 0.0);
}

Vec3 InsideSamples::operator()(size_t n) const {
  const size_t t = item_at(volume_before_, radical_inverse(n, 2));
  const Vec3 far = on_triangle(mesh_, t, radical_inverse(n, 3), radical_inverse(n, 5));
  return apex_ + std::cbrt(radical_inverse(n, 7)) * (far - apex_);
}

}  // namespace tumble
