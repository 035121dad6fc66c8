#include "engine/dynamics/contact/shape_pairs.hpp"

#include "engine/collision/mesh_pairs/mesh_surface.hpp"
#include "engine/collision/shapes/polyhedral.hpp"
#include "engine/dynamics/bodies/whole_body.hpp"
#include "engine/dynamics/contact/tolerances.hpp"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

/// Calls f(i) for the shapes of a side whose bounds overlap a box in the frame of the body.
template <class F>
void for_shapes_in(const SideShapes& side, const Aabb& box, const F& f) {
  if (!side.tree) {
    f(0u);
    return;
  }
  side.tree->overlapping(box, [&f](uint32_t i) {
    f(i);
    return true;
  });
}

/// Whether a box in the frame of a mesh overlaps a leaf of its tree.
bool meets_leaf(const MeshSurface& mesh, const Aabb& box) {
  const AabbTree& tree = *mesh.tree;
  const Aabb at = Aabb{box.min - tree.origin(), box.max - tree.origin()}.inflated(
      tolerances::leaf_of_size * mesh.size);
  static thread_local std::vector<uint32_t> waiting;
  waiting.clear();
  waiting.push_back(0);
  while (!waiting.empty()) {
    const uint32_t i = waiting.back();
    waiting.pop_back();
    const AabbTree::Node& n = tree.nodes()[i];
    if (!at.overlaps({Vec3(n.min[0], n.min[1], n.min[2]), Vec3(n.max[0], n.max[1], n.max[2])}))
      continue;
    if (n.is_leaf()) return true;
    waiting.push_back(n.start);
    waiting.push_back(i + 1);
  }
  return false;
}

/// Whether a shape may be near the surface of another one; always true unless that is a mesh, whose
/// bounds contain much empty space. `pose` is that of the first shape in the frame of the other's
/// body.
bool near_surface(const Shape& shape, const Pose& pose, const BodyShape& other, double reach) {
  if (!other.shape->is_mesh()) return true;
  const Aabb box = shape.bounds(other.pose.inverse() * pose).inflated(reach);
  return meets_leaf(other.shape->polyhedral()->surface(), box);
}

/// Lower bound on the distance of two boxes [m].
double boxes_apart(const Aabb& a, const Aabb& b) {
  const double d = (a.min - b.max).cwiseMax(b.min - a.max).cwiseMax(0.0).norm();
  return std::isfinite(d) ? d : 0;
}

/// Bounds of all shapes of a side, with its body at `pose`.
Aabb side_bounds(const SideShapes& side, const Pose& pose) {
  if (side.tree) return whole_bounds(*side.tree, pose);
  return side.shapes[0].shape->bounds(pose * side.shapes[0].pose);
}

/// Lower bound on the distance of the boxes about two sides, along the axes of either [m].
double sides_apart(const SideShapes& a, const SideShapes& b) {
  const auto beyond = [](const SideShapes& one, const SideShapes& other) {
    const Aabb of_other = side_bounds(other, one.body.pose.inverse() * other.body.pose);
    return boxes_apart(side_bounds(one, Pose()), of_other);
  };
  return std::max(beyond(a, b), beyond(b, a));
}

/// Lower bound on the distance between the bounds of shapes of two sides, the second of which has
/// at least as many; no more than the radius of the smaller body [m].
double shapes_apart(const SideShapes& few, const SideShapes& many) {
  if (!many.tree) return 0;
  const Pose in_many = many.body.pose.inverse() * few.body.pose;
  double apart = std::min(few.body.bounding_radius, many.body.bounding_radius);
  for (const BodyShape& s : few.shapes) {
    const Vec3 x = in_many.point(s.pose.x);
    const double radius = s.shape->bounding_radius();
    if (!std::isfinite(radius)) return 0;
    many.tree->around(x, std::max(0.0, apart + radius), [&](uint32_t j) {
      const Aabb other = many.shapes[j].shape->bounds(many.shapes[j].pose);
      const double away = (other.min - x).cwiseMax(x - other.max).cwiseMax(0.0).norm() - radius;
      apart = std::max(0.0, std::min(apart, away));
      return apart + radius;
    });
  }
  return apart;
}

}  // namespace

SideShapes side_shapes(const RigidBody& body, uint32_t shape) {
  if (body.tree) return {body, body.shapes, 0, body.tree.get()};
  return {body, std::span(body.shapes).subspan(shape, 1), shape};
}

double find_shape_pairs(const SideShapes& a, const SideShapes& b, double reach,
                        std::vector<ShapesNear>& out) {
  out.clear();
  const double sides = sides_apart(a, b);
  if (sides > reach) return sides;
  const bool first = a.shapes.size() <= b.shapes.size();
  const SideShapes &few = first ? a : b, &many = first ? b : a;
  const Pose in_few = few.body.pose.inverse() * many.body.pose, in_many = in_few.inverse();
  for_shapes_in(few, side_bounds(many, in_few).inflated(reach), [&](uint32_t i) {
    const BodyShape& s = few.shapes[i];
    const Pose there = in_many * s.pose;
    const Aabb box = many.tree ? s.shape->bounds(there) : Aabb();
    for_shapes_in(many, box.inflated(reach), [&](uint32_t j) {
      const BodyShape& t = many.shapes[j];
      if (!near_surface(*s.shape, there, t, reach) ||
          !near_surface(*t.shape, in_few * t.pose, s, reach))
        return;
      const double between = (there.x - t.pose.x).norm();
      const double radii = s.shape->bounding_radius() + t.shape->bounding_radius();
      const double apart = std::max(0.0, between - radii);
      const uint32_t of_few = few.first + i, of_many = many.first + j;
      out.push_back({first ? ShapesOfPair{of_few, of_many} : ShapesOfPair{of_many, of_few}, apart});
    });
  });
  std::ranges::sort(out, {}, &ShapesNear::shapes);
  return out.empty() ? std::max(reach, shapes_apart(few, many)) : reach;
}

}  // namespace tumble
