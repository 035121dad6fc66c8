#include "engine/scene/workloads/solid_depth.hpp"

#include "engine/collision/shapes/convex_hull.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tumble {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

/// Adds a direction unless it, or its opposite, is in the list.
void add_line(std::vector<Vec3>& lines, const Vec3& d) {
  for (const Vec3& l : lines)
    if (std::abs(l.dot(d)) > 1 - 1e-12) return;
  lines.push_back(d);
}

void make_box(const Vec3& half, const Pose& pose, MeasuredSolid& out) {
  out.half_extents = half;
  out.pose = pose;
  for (int k = 0; k < 8; ++k)
    out.vertices.push_back(pose.point({k & 1 ? half.x() : -half.x(), k & 2 ? half.y() : -half.y(),
                                       k & 4 ? half.z() : -half.z()}));
  for (int axis = 0; axis < 3; ++axis) out.normals.push_back(pose.direction(Vec3::Unit(axis)));
  out.edges = out.normals;
}

void make_hull(const ConvexPolyhedron& hull, const Pose& pose, MeasuredSolid& out) {
  for (const Vec3& v : hull.vertices) out.vertices.push_back(pose.point(v));
  for (const Plane& p : hull.planes) add_line(out.normals, pose.direction(p.normal));
  for (const PolyhedronEdge& e : hull.edges) {
    const Vec3 along = out.vertices[e.vertices[1]] - out.vertices[e.vertices[0]];
    add_line(out.edges, along.normalized());
  }
}

struct Interval {
  double low = infinite, high = -infinite;
};

Interval shadow(const std::vector<Vec3>& points, const Vec3& n) {
  Interval out;
  for (const Vec3& p : points) {
    const double h = n.dot(p);
    out.low = std::min(out.low, h);
    out.high = std::max(out.high, h);
  }
  return out;
}

/// Overlap of the projections on the direction `n`; negative if they are disjoint.
double shadow_overlap(const MeasuredSolid& a, const MeasuredSolid& b, const Vec3& n) {
  const Interval of_a = shadow(a.vertices, n), of_b = shadow(b.vertices, n);
  return std::min(of_a.high - of_b.low, of_b.high - of_a.low);
}

double polyhedra_depth(const MeasuredSolid& a, const MeasuredSolid& b) {
  double least = infinite;
  for (const std::vector<Vec3>* normals : {&a.normals, &b.normals}) {
    for (const Vec3& n : *normals) {
      least = std::min(least, shadow_overlap(a, b, n));
      if (least <= 0) return 0;
    }
  }
  for (const Vec3& along_a : a.edges) {
    for (const Vec3& along_b : b.edges) {
      const Vec3 n = along_a.cross(along_b);
      const double sine = n.norm();
      if (sine < 1e-6) continue;
      least = std::min(least, shadow_overlap(a, b, n / sine));
      if (least <= 0) return 0;
    }
  }
  return least;
}

/// Minimum of a convex function on [0, 1], by interval reduction.
template <class F>
double least_value(const F& f) {
  double low = 0, high = 1;
  for (int i = 0; i < 80; ++i) {
    const double s = low + (high - low) / 3, t = high - (high - low) / 3;
    (f(s) < f(t) ? high : low) = f(s) < f(t) ? t : s;
  }
  return std::min({f(0.0), f(1.0), f(0.5 * (low + high))});
}

double point_segment_distance(const Vec3& x, const Vec3& a, const Vec3& b) {
  const Vec3 along = b - a;
  const double length2 = along.squaredNorm();
  const double t = length2 > 0 ? std::clamp((x - a).dot(along) / length2, 0.0, 1.0) : 0;
  return (a + t * along - x).norm();
}

/// Minimum of `distance` over the core of a sphere or capsule.
template <class F>
double least_over_core(const MeasuredSolid& round, const F& distance) {
  const Vec3 &a = round.vertices.front(), &b = round.vertices.back();
  if (round.vertices.size() == 1) return distance(a);
  return least_value([&](double s) { return distance(a + s * (b - a)); });
}

}  // namespace

MeasuredSolid measured_solid(const Shape& shape, const Pose& pose) {
  MeasuredSolid out;
  const ShapeDef& def = shape.def();
  if (def.type == ShapeType::sphere || def.type == ShapeType::capsule) out.radius = def.radius;
  if (def.type == ShapeType::sphere) out.vertices = {pose.x};
  if (def.type == ShapeType::capsule)
    for (const double end : {0.5, -0.5})
      out.vertices.push_back(pose.point({0, end * def.height, 0}));
  if (def.type == ShapeType::box) make_box(def.half_extents, pose, out);
  if (const auto* hull = dynamic_cast<const ConvexHullShape*>(&shape))
    make_hull(hull->polyhedron(), pose, out);
  for (const Vec3& v : out.vertices) out.bounds.include(v);
  out.bounds = out.bounds.inflated(out.radius);
  return out;
}

double box_distance(const Vec3& half_extents, const Vec3& x) {
  const Vec3 beyond = x.cwiseAbs() - half_extents;
  if (beyond.maxCoeff() <= 0) return beyond.maxCoeff();
  return beyond.cwiseMax(0).norm();
}

double solid_depth(const MeasuredSolid& a, const MeasuredSolid& b) {
  if (a.radius == 0 && b.radius == 0) return polyhedra_depth(a, b);
  if (a.radius == 0) return solid_depth(b, a);
  if (b.radius > 0) {
    const double apart = least_over_core(a, [&](const Vec3& x) {
      return point_segment_distance(x, b.vertices.front(), b.vertices.back());
    });
    return std::max(0.0, a.radius + b.radius - apart);
  }
  if (b.half_extents.isZero()) return 0;
  const double apart = least_over_core(
      a, [&](const Vec3& x) { return box_distance(b.half_extents, b.pose.inverse_point(x)); });
  return std::max(0.0, a.radius - apart);
}

}  // namespace tumble
