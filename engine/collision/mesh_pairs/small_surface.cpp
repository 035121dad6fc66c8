#include "engine/collision/mesh_pairs/small_surface.hpp"

#include <algorithm>
#include <limits>

namespace tumble {
namespace {

/// How far three heights over a plane are from it on one side; negative if they are on both.
double beyond(double x, double y, double z) {
  return std::max(std::min(x, std::min(y, z)), -std::max(x, std::max(y, z)));
}

template <class T>
std::vector<T>& memory() {
  static thread_local std::vector<T> items;
  return items;
}

}  // namespace

SmallSurface::SmallSurface(const PlacedSurface& small, const PlacedSurface& large, bool is_a,
                           NearPairs& pairs)
    : small_(small),
      large_(large),
      R_(large.R.transpose() * small.R),
      corners_(memory<Vec3>()),
      heights_(memory<double>()),
      near_(memory<NearFacet>()),
      is_a_(is_a),
      pairs_(pairs) {
  const Vec3 x = large.R.transpose() * (small.x - large.x);
  const std::vector<Vec3>& vertices = small.s.mesh->vertices;
  corners_.resize(vertices.size());
  heights_.resize(vertices.size());
  near_.resize(small.s.mesh->triangles.size());
  for (size_t i = 0; i < corners_.size(); ++i) {
    corners_[i] = R_ * vertices[i] + x;
    if (i == 0) box_ = {corners_[i], corners_[i]};
    box_ = {box_.min.cwiseMin(corners_[i]), box_.max.cwiseMax(corners_[i])};
  }
}

double SmallSurface::distance(uint32_t facet, const Aabb& box,
                              const std::array<Vec3, 3>& triangle) const {
  const Triangle& ids = small_.s.mesh->triangles[facet];
  const Vec3 &p = corners_[ids[0]], &q = corners_[ids[1]], &r = corners_[ids[2]];
  const double between = gap_between(box, {p.cwiseMin(q).cwiseMin(r), p.cwiseMax(q).cwiseMax(r)});
  if (between > pairs_.reach) return between;
  const Vec3 normal = R_ * small_.s.topology.face_normals[facet];
  const double offset = normal.dot(p);
  return std::max(between,
                  beyond(normal.dot(triangle[0]) - offset, normal.dot(triangle[1]) - offset,
                         normal.dot(triangle[2]) - offset));
}

/// Chosen without a jump: which facets are near cannot be foreseen.
std::span<const SmallSurface::NearFacet> SmallSurface::facets_near_plane() {
  const std::vector<Triangle>& facets = small_.s.mesh->triangles;
  size_t count = 0;
  double left_out = std::numeric_limits<double>::infinity();
  for (uint32_t i = 0; i < facets.size(); ++i) {
    const Triangle& f = facets[i];
    const double over = beyond(heights_[f[0]], heights_[f[1]], heights_[f[2]]);
    const bool near = over <= pairs_.reach;
    near_[count] = {i, over};
    count += near;
    left_out = near ? left_out : std::min(left_out, over);
  }
  pairs_.nearest_left_out = std::min(pairs_.nearest_left_out, left_out);
  return {near_.data(), count};
}

void SmallSurface::meet(uint32_t triangle) {
  const TriangleMesh& mesh = *large_.s.mesh;
  const std::array<Vec3, 3> p{mesh.corner(triangle, 0), mesh.corner(triangle, 1),
                              mesh.corner(triangle, 2)};
  const Aabb box{p[0].cwiseMin(p[1]).cwiseMin(p[2]), p[0].cwiseMax(p[1]).cwiseMax(p[2])};
  if (pairs_.apart(gap_between(box, box_))) return;
  const Vec3 normal = large_.s.topology.face_normals[triangle];
  const double offset = normal.dot(p[0]);
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (size_t i = 0; i < corners_.size(); ++i) {
    heights_[i] = normal.dot(corners_[i]) - offset;
    low = std::min(low, heights_[i]);
    high = std::max(high, heights_[i]);
  }
  if (pairs_.apart(std::max(low, -high))) return;
  for (const auto& [facet, over] : facets_near_plane()) {
    const double away = std::max(over, distance(facet, box, p));
    if (pairs_.apart(away)) continue;
    pairs_.add(is_a_ ? TriangleIds{facet, triangle} : TriangleIds{triangle, facet}, away);
  }
}

void SmallSurface::run(size_t most) {
  const AabbTree& tree = *large_.s.tree;
  const Vec3 origin = tree.origin();
  const Aabb box{box_.min - origin, box_.max - origin};
  const double rounding = 1e-6 * (small_.s.size + large_.s.size);  // of the tree's boxes
  std::vector<uint32_t>& stack = memory<uint32_t>();
  stack.assign(1, 0);
  while (!stack.empty() && pairs_.within.size() <= most) {
    const uint32_t at = stack.back();
    stack.pop_back();
    const AabbTree::Node& node = tree.nodes()[at];
    const Aabb bounds{Vec3(node.min[0], node.min[1], node.min[2]),
                      Vec3(node.max[0], node.max[1], node.max[2])};
    if (pairs_.apart(gap_between(bounds, box) - rounding)) continue;
    if (!node.is_leaf()) {
      stack.push_back(node.start);
      stack.push_back(at + 1);
      continue;
    }
    for (uint32_t i = 0; i < node.count; ++i) meet(tree.triangle_order()[node.start + i]);
  }
}

}  // namespace tumble
