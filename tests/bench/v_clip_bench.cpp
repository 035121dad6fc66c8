// Distance of convex polyhedra, ns a query: hulls of N points on ellipsoids with semi-axes in
// (0.5, 1.5), 32 shapes for each N. Families: gap U(0.1, 2); gap 1e-3 along the exact normal; deep
// (centres 0.3 apart); an orbit at radius 3.2 that moves 0.01 rad and turns half a degree a frame,
// cold and from the last frame's features. Rotation matrices are given to all.
#include "engine/collision/gjk/gjk.hpp"
#include "engine/collision/shapes/convex_hull.hpp"
#include "engine/collision/v_clip/v_clip.hpp"
#include "engine/core/random.hpp"
#include "engine/math/det/det.hpp"
#include "engine/math/rotation.hpp"
#include "tests/bench/contest.hpp"

#include <cmath>

#include <fcl/fcl.h>

using namespace tumble;

namespace {

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

Vec3 direction(Random& r) {
  const double z = r.uniform(-1, 1), phi = r.uniform(0, 2 * det::pi), s = std::sqrt(1 - z * z);
  return {s * det::cos(phi), s * det::sin(phi), z};
}

Mat3 rotation(Random& r) {
  return axis_angle(direction(r), r.uniform(0, 2 * det::pi)).toRotationMatrix();
}

Body body(Random& r, int n) {
  const double x = r.uniform(.5, 1.5), y = r.uniform(.5, 1.5), z = r.uniform(.5, 1.5);
  auto mesh = std::make_shared<TriangleMesh>();
  for (int i = 0; i < n; ++i) mesh->vertices.push_back(direction(r).cwiseProduct(Vec3(x, y, z)));
  Body b;
  b.shape = *make_shape({.type = ShapeType::convex_hull, .mesh = mesh});
  const auto& p = static_cast<const ConvexHullShape&>(*b.shape).polyhedron();
  b.voronoi = *make_voronoi_polyhedron(p);
  auto vertices = std::make_shared<std::vector<Vec3>>(p.vertices);
  auto faces = std::make_shared<std::vector<int>>();
  for (size_t f = 0; f < p.face_count(); ++f) {
    faces->push_back(int(p.face(f).size()));
    for (uint32_t v : p.face(f)) faces->push_back(int(v));
  }
  b.peer = std::make_shared<fcl::Convex<double>>(vertices, int(p.face_count()), faces);
  return b;
}

VClipResult by_v_clip(const Query& q, const VClipOptions& options = {}) {
  return v_clip({q.a->voronoi, q.Ra, q.xa}, {q.b->voronoi, q.Rb, q.xb}, options);
}

double by_gjk(const Query& q, const Vec3& start = Vec3::Zero(), Vec3* normal = nullptr) {
  PlacedCore A, B;
  A.core = q.a->shape->convex();
  B.core = q.b->shape->convex();
  A.R = q.Ra;
  B.R = q.Rb;
  B.x = q.xb - q.xa;
  GjkOptions options;
  options.initial_direction = start;
  const GjkResult g = gjk(A, B, options);
  if (normal) *normal = g.normal;
  return g.distance;
}

double by_fcl(const Query& q) {
  fcl::Transform3<double> ta = fcl::Transform3<double>::Identity(), tb = ta;
  ta.linear() = q.Ra;
  ta.translation() = q.xa;
  tb.linear() = q.Rb;
  tb.translation() = q.xb;
  fcl::DistanceRequest<double> request;
  fcl::DistanceResult<double> result;
  fcl::distance(q.a->peer.get(), ta, q.b->peer.get(), tb, request, result);
  return std::max(result.min_distance, 0.0);
}

enum class Family { sep, near, deep };

std::vector<Query> queries(Random& r, const std::vector<Body>& bodies, Family family,
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
      const double gap = family == Family::sep ? r.uniform(0.1, 2) : 1e-3;
      q.xb -= (v.distance - gap) * v.normal;
    }
    out.push_back(q);
  }
  return out;
}

/// Each of several pairs goes through its orbit.
std::vector<Query> orbits(Random& r, const std::vector<Body>& bodies, size_t pairs, int frames) {
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

void compare(const char* title, const std::vector<bench::Candidate>& candidates, size_t count,
             const char* note = "") {
  const auto timings = bench::contest(candidates, 9);
  std::printf("  %-12s", title);
  for (size_t i = 0; i < candidates.size(); ++i)
    std::printf("  %s %7.1f ns", candidates[i].name.c_str(),
                1e6 * timings[i].milliseconds / double(count));
  const double error = std::abs(timings.back().answer - timings[0].answer) / double(count);
  std::printf("  %.3f x%s%s\n", timings.back().milliseconds / timings[0].milliseconds, note,
              error < 1e-5 ? "" : "  ANSWERS DIFFER");
  std::fflush(stdout);
}

double sum(const std::vector<Query>& all, auto distance) {
  double total = 0;
  for (const Query& q : all) total += distance(q);
  return total;
}

void cold(const char* title, const std::vector<Query>& all) {
  long steps = 0;
  for (const Query& q : all) steps += by_v_clip(q).steps;
  char note[64];
  std::snprintf(note, sizeof note, "  %.1f steps", double(steps) / double(all.size()));
  compare(
      title,
      {{"FCL", [&] { return sum(all, by_fcl); }},
       {"GJK", [&] { return sum(all, [](const Query& q) { return by_gjk(q); }); }},
       {"V-Clip", [&] { return sum(all, [](const Query& q) { return by_v_clip(q).distance; }); }}},
      all.size(), note);
}

void warm(const char* title, const std::vector<Query>& all) {
  ClosestFeatures last;
  Vec3 normal;
  long steps = 0;
  VClipOptions options;
  options.start = &last;
  const auto follow = [&](const Query& q) {
    const VClipResult v = by_v_clip(q, options);
    last = v.features;
    steps += v.steps;
    return v.distance;
  };
  sum(all, follow);
  char note[64];
  std::snprintf(note, sizeof note, "  %.2f steps", double(steps) / double(all.size()));
  compare(title,
          {{"FCL", [&] { return sum(all, by_fcl); }},
           {"GJK",
            [&] {
              normal.setZero();
              return sum(all, [&](const Query& q) { return by_gjk(q, normal, &normal); });
            }},
           {"V-Clip",
            [&] {
              last = {};
              return sum(all, follow);
            }}},
          all.size(), note);
}

}  // namespace

int main() {
  for (const int n : {8, 32, 128, 512}) {
    Random r{uint64_t(n)};
    std::vector<Body> bodies;
    for (int i = 0; i < 32; ++i) bodies.push_back(body(r, n));
    std::printf("%d points (last figure: V-Clip over FCL)\n", n);
    cold("apart", queries(r, bodies, Family::sep, 1024));
    cold("near", queries(r, bodies, Family::near, 1024));
    cold("deep", queries(r, bodies, Family::deep, 1024));
    const auto orbit = orbits(r, bodies, 4, 628);
    cold("orbit, cold", orbit);
    warm("orbit, warm", orbit);
  }
}
