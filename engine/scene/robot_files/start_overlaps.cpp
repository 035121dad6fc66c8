#include "engine/scene/robot_files/start_overlaps.hpp"

#include "engine/collision/query.hpp"
#include "engine/scene/mesh_import.hpp"

#include <algorithm>

namespace tumble {
namespace {

struct PlacedShape {
  size_t body, tree;
  std::shared_ptr<const Shape> shape;
  Pose pose;
  Aabb box;
};

/// The root of a body's tree of joints: a free body, or one attached to the world.
size_t tree_of(const std::vector<RobotBody>& bodies, size_t body) {
  while (bodies[body].parent != RobotLink::world && !bodies[body].floating)
    body = bodies[body].parent;
  return body;
}

std::shared_ptr<const Shape> collision_shape(const RobotGeometry& g) {
  ShapeDef def = g.shape;
  if (!g.mesh.empty()) {
    auto read = import_mesh(g.mesh, {.stretch = g.scale});
    if (!read) return nullptr;
    def = robot_hull(std::make_shared<const TriangleMesh>(std::move(read->mesh)));
  }
  const auto shape = make_shape(def);
  return shape ? *shape : nullptr;
}

}  // namespace

std::vector<std::pair<size_t, size_t>> start_overlaps(const std::vector<RobotBody>& bodies) {
  std::vector<PlacedShape> placed;
  for (size_t b = 0; b < bodies.size(); ++b)
    for (const RobotGeometry& g : bodies[b].collides)
      if (const auto shape = collision_shape(g)) {
        const Pose pose = bodies[b].start * g.pose;
        placed.push_back({b, tree_of(bodies, b), shape, pose, shape->bounds(pose)});
      }
  std::vector<std::pair<size_t, size_t>> out;
  for (size_t i = 0; i < placed.size(); ++i)
    for (size_t k = i + 1; k < placed.size(); ++k) {
      const PlacedShape &a = placed[i], &b = placed[k];
      if (a.body == b.body || a.tree != b.tree) continue;
      if (!a.box.overlaps(b.box)) continue;
      const std::pair pair{a.body, b.body};
      if (!out.empty() && out.back() == pair) continue;
      if (overlap(*a.shape, a.pose, *b.shape, b.pose)) out.push_back(pair);
    }
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

}  // namespace tumble
