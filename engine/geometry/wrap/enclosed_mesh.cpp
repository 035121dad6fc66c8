#include "engine/geometry/wrap/enclosed_mesh.hpp"

#include "engine/geometry/hierarchy/aabb_tree.hpp"

#include <algorithm>
#include <numeric>

namespace tumble {
namespace {

/// All corners of `t` are farther than `distance` from the plane of `from`, on one side.
bool beyond_plane(const TriangleCorners& from, const TriangleCorners& t, double distance) {
  const Vec3 normal = (from[1] - from[0]).cross(from[2] - from[0]);
  const double far = distance * normal.norm() * (1 + 1e-9);
  const double a = normal.dot(t[0] - from[0]), b = normal.dot(t[1] - from[0]),
               c = normal.dot(t[2] - from[0]);
  return std::min({a, b, c}) > far || std::max({a, b, c}) < -far;
}

Aabb box_of(const TriangleCorners& t) {
  Aabb out;
  for (const Vec3& p : t) out.include(p);
  return out;
}

}  // namespace

EnclosedMesh::EnclosedMesh(const Hierarchy& mesh, double clearance)
    : mesh_(mesh), clearance_(clearance) {
  auto points = std::make_shared<TriangleMesh>();
  points->vertices = one_point_of_each_part(mesh.mesh());
  for (uint32_t n = 0; n < points->vertices.size(); ++n) points->triangles.push_back({n, n, n});
  witnesses_ = std::move(points);
  witness_tree_ = std::make_unique<AabbTree>(witnesses_);
}

bool EnclosedMesh::clear_of(const TriangleCorners& t) const {
  thread_local std::vector<uint32_t> near;
  near.clear();
  mesh_.overlap(box_of(t).inflated(clearance_), near);
  for (const uint32_t id : near) {
    const TriangleCorners own = corners(mesh_.mesh(), id);
    if (beyond_plane(t, own, clearance_) || beyond_plane(own, t, clearance_)) continue;
    if (closest_triangle_triangle(t, own).squared_distance < clearance_ * clearance_) return false;
  }
  return true;
}

void EnclosedMesh::witnesses_in(const Aabb& box, std::vector<uint32_t>& out) const {
  witness_tree_->overlap(box, out);
}

std::vector<Vec3> one_point_of_each_part(const TriangleMesh& mesh) {
  std::vector<uint32_t> parent(mesh.vertices.size());
  std::iota(parent.begin(), parent.end(), 0u);
  const auto root = [&](uint32_t v) {
    while (parent[v] != v) v = parent[v] = parent[parent[v]];
    return v;
  };
  for (const Triangle& t : mesh.triangles)
    for (const uint32_t v : {t[1], t[2]}) {
      const uint32_t a = root(t[0]), b = root(v);
      parent[std::max(a, b)] = std::min(a, b);
    }
  std::vector<uint32_t> roots;
  for (const Triangle& t : mesh.triangles)
    if (root(t[0]) == t[0] || root(t[1]) == t[1] || root(t[2]) == t[2]) roots.push_back(root(t[0]));
  std::sort(roots.begin(), roots.end());
  roots.erase(std::unique(roots.begin(), roots.end()), roots.end());
  std::vector<Vec3> out;
  for (const uint32_t v : roots) out.push_back(mesh.vertices[v]);
  return out;
}

}  // namespace tumble
