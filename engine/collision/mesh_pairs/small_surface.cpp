#include "engine/collision/mesh_pairs/small_surface.hpp"

#include <algorithm>
#include <limits>

namespace tumble {
namespace {

/// How far three heights over a plane are from it on one side; negative if they are on both.
double beyond(double x, double y, double z) {
  return std::max(std::min({x, y, z}), -std::max({x, y, z}));
}

template <class T>
std::vector<T>& memory() {
  static thread_local std::vector<T> items;
  return items;
}

}  // namespace

SmallSurface::SmallSurface(const PlacedSurface& small, const PlacedSurface& large, bool is_a,
                           double reach, std::vector<TriangleIds>& pairs)
    : large_(large),
      corners_(memory<Vec3>()),
      facets_(memory<Facet>()),
      heights_(memory<double>()),
      reach_(reach),
      rounding_(1e-6 * (small.s.size + large.s.size)),  // boxes are in single precision
      nearest_left_out_(std::numeric_limits<double>::infinity()),
      is_a_(is_a),
      pairs_(pairs) {
  const Mat3 R = large.R.transpose() * small.R;
  const Vec3 x = large.R.transpose() * (small.x - large.x);
  const TriangleMesh& mesh = *small.s.mesh;
  corners_.resize(mesh.vertices.size());
  heights_.resize(mesh.vertices.size());
  for (size_t i = 0; i < corners_.size(); ++i) corners_[i] = R * mesh.vertices[i] + x;
  facets_.resize(mesh.triangles.size());
  for (size_t i = 0; i < facets_.size(); ++i) {
    Facet& f = facets_[i];
    f.corners = mesh.triangles[i];
    const Vec3 &p = corners_[f.corners[0]], &q = corners_[f.corners[1]],
               &r = corners_[f.corners[2]];
    f.box = {p.cwiseMin(q).cwiseMin(r), p.cwiseMax(q).cwiseMax(r)};
    f.normal = R * small.s.topology.face_normals[i];
    f.offset = f.normal.dot(p);
    if (i == 0) box_ = f.box;
    box_ = {box_.min.cwiseMin(f.box.min), box_.max.cwiseMax(f.box.max)};
  }
}

bool SmallSurface::apart(double distance) {
  if (distance <= reach_) return false;
  nearest_left_out_ = std::min(nearest_left_out_, distance);
  return true;
}

void SmallSurface::meet(uint32_t triangle) {
  const TriangleMesh& mesh = *large_.s.mesh;
  const Vec3 &p = mesh.corner(triangle, 0), &q = mesh.corner(triangle, 1),
             &r = mesh.corner(triangle, 2);
  const Aabb box{p.cwiseMin(q).cwiseMin(r), p.cwiseMax(q).cwiseMax(r)};
  if (apart(gap_between(box, box_))) return;
  const Vec3 normal = large_.s.topology.face_normals[triangle];
  const double offset = normal.dot(p);
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (size_t i = 0; i < corners_.size(); ++i) {
    heights_[i] = normal.dot(corners_[i]) - offset;
    low = std::min(low, heights_[i]);
    high = std::max(high, heights_[i]);
  }
  if (apart(std::max(low, -high))) return;
  for (uint32_t i = 0; i < facets_.size(); ++i) {
    const Facet& f = facets_[i];
    if (apart(gap_between(box, f.box))) continue;
    const double of_facet =
        beyond(heights_[f.corners[0]], heights_[f.corners[1]], heights_[f.corners[2]]);
    const double of_triangle =
        beyond(f.normal.dot(p) - f.offset, f.normal.dot(q) - f.offset, f.normal.dot(r) - f.offset);
    if (apart(std::max(of_facet, of_triangle))) continue;
    pairs_.push_back(is_a_ ? TriangleIds{i, triangle} : TriangleIds{triangle, i});
  }
}

double SmallSurface::run(size_t most) {
  const AabbTree& tree = *large_.s.tree;
  const Vec3 origin = tree.origin();
  const Aabb box{box_.min - origin, box_.max - origin};
  std::vector<uint32_t>& stack = memory<uint32_t>();
  stack.assign(1, 0);
  while (!stack.empty() && pairs_.size() <= most) {
    const uint32_t at = stack.back();
    stack.pop_back();
    const AabbTree::Node& node = tree.nodes()[at];
    const Aabb bounds{Vec3(node.min[0], node.min[1], node.min[2]),
                      Vec3(node.max[0], node.max[1], node.max[2])};
    if (apart(gap_between(bounds, box) - rounding_)) continue;
    if (!node.is_leaf()) {
      stack.push_back(node.start);
      stack.push_back(at + 1);
      continue;
    }
    for (uint32_t i = 0; i < node.count; ++i) meet(tree.triangle_order()[node.start + i]);
  }
  return nearest_left_out_;
}

}  // namespace tumble
