#pragma once
// Pairs of convex hulls for benchmarks of distance and depth: hulls of N points on ellipsoids with
// semi-axes in (0.5, 1.5), 32 shapes for each N, in this library's form and in FCL's.
#include "engine/collision/gjk/gjk.hpp"
#include "engine/collision/shapes/convex_hull.hpp"
#include "engine/collision/v_clip/v_clip.hpp"
#include "engine/core/random.hpp"
#include "engine/math/dense.hpp"
#include "engine/math/det/det.hpp"
#include "engine/math/rotation.hpp"

#include <cmath>

#include <fcl/fcl.h>

namespace tumble::bench {

struct Body {
  std::shared_ptr<const Shape> shape;
  VoronoiPolyhedron voronoi;
  std::shared_ptr<fcl::Convex<double>> peer;
};

struct Query {
  const Body *a, *b;
  Mat3 Ra, Rb;
  Vec3 xa, xb;
};

inline Vec3 direction(Random& r) {
  const double z = r.uniform(-1, 1), phi = r.uniform(0, 2 * det::pi), s = std::sqrt(1 - z * z);
  return {s * det::cos(phi), s * det::sin(phi), z};
}

inline Mat3 rotation(Random& r) {
  return axis_angle(direction(r), r.uniform(0, 2 * det::pi)).toRotationMatrix();
}

inline Body body(Random& r, int n) {
  const double x = r.uniform(.5, 1.5), y = r.uniform(.5, 1.5), z = r.uniform(.5, 1.5);
  auto mesh = std::make_shared<TriangleMesh>();
  for (int i = 0; i < n; ++i) mesh->vertices.push_back(direction(r).cwiseProduct(Vec3(x, y, z)));
  Body b;
  b.shape = *make_shape({.type = ShapeType::convex_hull, .mesh = mesh});
  const auto& p = static_cast<const ConvexHullShape&>(*b.shape).polyhedron();
  b.voronoi = *make_voronoi_polyhedron(p);
  auto vertices = std::make_shared<std::vector<fcl::Vector3d>>();
  for (const Vec3& v : p.vertices) vertices->push_back(dense(v));
  auto faces = std::make_shared<std::vector<int>>();
  for (size_t f = 0; f < p.face_count(); ++f) {
    faces->push_back(int(p.face(f).size()));
    for (uint32_t v : p.face(f)) faces->push_back(int(v));
  }
  b.peer = std::make_shared<fcl::Convex<double>>(vertices, int(p.face_count()), faces);
  return b;
}

inline VClipResult by_v_clip(const Query& q, const VClipOptions& options = {}) {
  return v_clip({q.a->voronoi, q.Ra, q.xa}, {q.b->voronoi, q.Rb, q.xb}, options);
}

/// The cores of a pair, in the frame that FCL is asked in. Written where they stay: copies of what
/// has just been written in other widths would make the processor wait.
struct PlacedPair {
  PlacedCore a, b;
};
inline PlacedPair placed(const Query& q) {
  return {{*q.a->shape->convex(), q.Ra, q.xa}, {*q.b->shape->convex(), q.Rb, q.xb}};
}

inline GjkResult by_gjk(const Query& q, const GjkOptions& options = {}) {
  const auto [A, B] = placed(q);
  return gjk(A, B, options);
}

/// Negative by the depth where they overlap, if it is `signed_distance` that is asked for.
inline double fcl_distance(const Query& q, bool signed_distance) {
  const auto transform = [](const Mat3& R, const Vec3& x) {
    fcl::Transform3<double> t = fcl::Transform3<double>::Identity();
    t.linear() = dense(R);
    t.translation() = dense(x);
    return t;
  };
  fcl::DistanceRequest<double> request;
  request.enable_signed_distance = signed_distance;
  fcl::DistanceResult<double> result;
  fcl::distance(q.a->peer.get(), transform(q.Ra, q.xa), q.b->peer.get(), transform(q.Rb, q.xb),
                request, result);
  return result.min_distance;
}
inline double by_fcl(const Query& q) {
  return std::max(fcl_distance(q, false), 0.0);
}
inline double depth_by_fcl(const Query& q) {
  return std::max(-fcl_distance(q, true), 0.0);
}

/// sep: gap U(0.1, 2); near: gap 1e-3 along the exact normal; shallow: the same, overlapping by
/// U(1e-3, 0.05); deep: centres 0.3 apart.
enum class Family { sep, near, shallow, deep };

inline std::vector<Query> queries(Random& r, const std::vector<Body>& bodies, Family family,
                                  size_t count) {
  std::vector<Query> out;
  while (out.size() < count) {
    Query q{&bodies[r.below(uint32_t(bodies.size()))],
            &bodies[r.below(uint32_t(bodies.size()))],
            rotation(r),
            rotation(r),
            5 * direction(r),
            {}};
    const Vec3 d = direction(r);
    q.xb = q.xa + (family == Family::deep ? 0.3 : 6.0) * d;
    if (family != Family::deep) {
      const VClipResult v = by_v_clip(q);
      const double gap = family == Family::sep    ? r.uniform(0.1, 2)
                         : family == Family::near ? 1e-3
                                                  : -r.uniform(1e-3, 0.05);
      q.xb -= (v.distance - gap) * v.normal;
    }
    out.push_back(q);
  }
  return out;
}

/// Each of several pairs goes through its orbit at radius 3.2: 0.01 rad and half a degree a frame.
inline std::vector<Query> orbits(Random& r, const std::vector<Body>& bodies, size_t pairs,
                                 int frames) {
  std::vector<Query> out;
  for (size_t k = 0; k < pairs; ++k) {
    const Body *a = &bodies[r.below(uint32_t(bodies.size()))],
               *b = &bodies[r.below(uint32_t(bodies.size()))];
    const Mat3 tilt = rotation(r), start = rotation(r);
    const Vec3 axis = direction(r), centre = 5 * direction(r);
    for (int i = 0; i < frames; ++i) {
      const double angle = 0.01 * i;
      const Mat3 turned = axis_angle(axis, det::pi / 360 * i).toRotationMatrix() * start;
      const Vec3 at = tilt * Vec3(3.2 * det::cos(angle), 0, 3.2 * det::sin(angle));
      out.push_back({a, b, tilt, turned, centre, centre + at});
    }
  }
  return out;
}

double sum(const std::vector<Query>& all, auto distance) {
  double total = 0;
  for (const Query& q : all) total += distance(q);
  return total;
}

}  // namespace tumble::bench
