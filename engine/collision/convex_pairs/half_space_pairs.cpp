#include "engine/collision/convex_pairs/half_space_pairs.hpp"

#include "engine/collision/feature_key.hpp"
#include "engine/collision/shapes/convex_shape.hpp"
#include "engine/collision/shapes/triangle_mesh.hpp"

#include <algorithm>

namespace tumble {
namespace {

struct Ground {
  Vec3 n;     ///< unit, out of the half-space
  Pose pose;  ///< of the shape relative to a point of the plane
  double height(const Vec3& x) const { return n.dot(x); }
};

Ground ground_of(const ShapePair& pair) {
  return {pair.pose_a.direction(Vec3::UnitY()), pair.pose_b};
}

void add(const Ground& ground, const Vec3& x, double gap, uint32_t id, ManifoldBuilder& out) {
  out.add(x - 0.5 * gap * ground.n, gap, feature_key(FeaturePair::face_vertex, 0, id));
}

}  // namespace

void collide_half_space_convex(const ShapePair& pair, std::vector<Manifold>& out) {
  const Ground ground = ground_of(pair);
  const ConvexShape& b = *pair.b.convex();
  const double r = b.rounding();
  const Vec3 down = pair.pose_b.inverse_direction(-ground.n);
  const double least = ground.height(pair.pose_b.point(b.support(down))) - r;
  if (least > pair.margin) {
    pair.found_apart(least, pair.pose_b.x.cwiseAbs().sum() + b.bounding_radius());
    return;
  }
  ManifoldBuilder points;
  const auto consider = [&](const Vec3& p, uint32_t id) {
    const Vec3 x = pair.pose_b.point(p) - r * ground.n;
    const double gap = ground.height(x);
    if (gap <= pair.margin) add(ground, x, gap, id, points);
  };
  if (const std::span<const Vec3> corners = b.corners(); !corners.empty()) {
    for (uint32_t v = 0; v < corners.size(); ++v) consider(corners[v], v);
  } else {
    SupportingFace face;
    b.supporting_face(down, face);
    for (int i = 0; i < face.count; ++i) consider(face.points[size_t(i)], face.ids[size_t(i)]);
  }
  emit(pair, points, ground.n, 0, out);
}

void collide_half_space_mesh(const ShapePair& pair, std::vector<Manifold>& out) {
  const Ground ground = ground_of(pair);
  const MeshSurface& s = pair.b.polyhedral()->surface();
  const Vec3 n_mesh = pair.pose_b.inverse_direction(ground.n);
  const double offset = ground.height(pair.pose_b.x);  // height of a vertex v is v.n_mesh + offset
  const auto& nodes = s.tree->nodes();
  const auto& order = s.tree->triangle_order();
  thread_local std::vector<ManifoldPoint> points;
  thread_local std::vector<uint32_t> low, stack;
  points.clear(), low.clear(), stack.assign(1, 0);
  while (!stack.empty()) {
    const uint32_t i = stack.back();
    stack.pop_back();
    const Aabb box = node_box(*s.tree, i);
    const double least =
        box.centre().dot(n_mesh) - 0.5 * box.extent().dot(n_mesh.cwiseAbs()) + offset;
    if (least > pair.margin) continue;
    if (!nodes[i].is_leaf()) {
      stack.push_back(nodes[i].start);
      stack.push_back(i + 1);
      continue;
    }
    for (uint32_t k = 0; k < nodes[i].count; ++k)
      for (uint32_t v : s.mesh->triangles[order[nodes[i].start + k]])
        if (s.vertex(v).dot(n_mesh) + offset <= pair.margin) low.push_back(v);
  }
  std::sort(low.begin(), low.end());
  low.erase(std::unique(low.begin(), low.end()), low.end());
  for (uint32_t v : low) {
    const double gap = s.vertex(v).dot(n_mesh) + offset;
    const Vec3 x = pair.pose_b.point(s.vertex(v)) - 0.5 * gap * ground.n;
    points.push_back({x, gap, feature_key(FeaturePair::face_vertex, 0, v)});
  }
  emit_nearest(pair, points, ground.n, 0, out);
}

}  // namespace tumble
