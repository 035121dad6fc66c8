// References: brute force over all pairs of features in extended precision (80 bits, error below
// 1e-18 of the scale); GJK for large polyhedra, 1e-9 of the scale; closed forms for boxes that are
// parallel to the axes.
#include "engine/collision/gjk/gjk.hpp"
#include "engine/collision/shapes/convex_hull.hpp"
#include "tests/collision/polyhedron_draws.hpp"
#include "tests/collision/polyhedron_reference.hpp"

#include <bit>
#include <cmath>

using namespace tumble;
using namespace tumble::test;

namespace {

/// Compares one answer with the reference: state, distance, features, witness points, normal.
void check_answer(const VoronoiPolyhedron& a, const Pose& pa, const VoronoiPolyhedron& b,
                  const Pose& pb, const VClipResult& r) {
  const ReferencePair pair(a, pa, b, pb);
  const ReferenceDistance exact = pair.distance();
  const double scale = pair_scale(a, pa, b, pb),
               tolerance = 1e-12 * scale + a.flatness + b.flatness;
  REQUIRE(r.state != VClipState::invalid);
  if (r.state == VClipState::penetrating) {
    CHECK((exact.overlap >= 0 || exact.distance <= tolerance));
    CHECK(r.distance == 0);
    return;
  }
  CHECK(exact.overlap <= tolerance);
  CHECK(std::abs(r.distance - double(exact.distance)) <= tolerance);
  CHECK(std::abs(double(pair.between(r.features)) - r.distance) <= tolerance);
  CHECK(double(pair.from_feature(r.a - pa.x, 0, r.features[0])) <= tolerance);
  CHECK(double(pair.from_feature(r.b - pa.x, 1, r.features[1])) <= tolerance);
  CHECK(r.normal.norm() == doctest::Approx(1));
  if (r.distance > 1e-3 * scale) {
    CHECK((r.b - r.a - r.distance * r.normal).norm() < 1e-12 * scale + 1e-15 * pa.x.norm());
  }
}

VClipResult clip(const VoronoiPolyhedron& a, const Pose& pa, const VoronoiPolyhedron& b,
                 const Pose& pb, const ClosestFeatures* start = nullptr) {
  VClipOptions options;
  options.start = start;
  return v_clip({a, pa}, {b, pb}, options);
}

bool same_bits(const VClipResult& x, const VClipResult& y) {
  const auto bits = [](double d) { return std::bit_cast<uint64_t>(d); };
  bool same = x.state == y.state && x.features == y.features && x.steps == y.steps &&
              bits(x.distance) == bits(y.distance);
  for (int i = 0; i < 3; ++i)
    same = same && bits(x.a[i]) == bits(y.a[i]) && bits(x.b[i]) == bits(y.b[i]) &&
           bits(x.normal[i]) == bits(y.normal[i]);
  return same;
}

/// B on a circle about A, turning as it goes.
Pose orbit(int frame) {
  const double angle = 0.01 * frame;
  return {3.2 * Vec3(det::cos(angle), 0.3 * det::sin(2 * angle), det::sin(angle)),
          axis_angle({1, 2, 3}, det::pi / 360 * frame)};
}

}  // namespace

TEST_CASE("V-Clip agrees with brute force for all kinds of polyhedra, poses and starts") {
  Random r(71);
  std::vector<VoronoiPolyhedron> shapes;
  std::array<int, 4> seen{};
  const int n = cases(6000);
  int searched = 0, cycles = 0;
  for (int i = 0; i < n; ++i) {
    if (i % 2000 == 0) shapes = small_polyhedra(r);
    const auto& [a, b, pa, pb] = draw_pair(r, shapes, i);
    const ClosestFeatures start = random_features(r, a, b);
    const VClipResult first = clip(a, pa, b, pb, i % 4 < 2 ? &start : nullptr);
    check_answer(a, pa, b, pb, first);
    ++seen[size_t(first.state)];
    searched += first.answer != VClipAnswer::walk;
    cycles += first.answer == VClipAnswer::search_after_cycle;
    const VClipResult swapped = clip(b, pb, a, pa);
    check_answer(b, pb, a, pa, swapped);
    const double scale = pair_scale(a, pa, b, pb);
    CHECK(std::abs(first.distance - swapped.distance) <= 2e-12 * scale);
    CHECK(same_bits(first, clip(a, pa, b, pb, i % 4 < 2 ? &start : nullptr)));
  }
  if (n < 1000) return;
  CHECK(seen[size_t(VClipState::separated)] > 0.2 * n);
  CHECK(seen[size_t(VClipState::penetrating)] > 0.2 * n);
  CHECK(seen[size_t(VClipState::touching)] > 10);
  CHECK(searched < 0.03 * n);
  // The walk went round between an edge and a face, once in a hundred of these pairs, where an edge
  // passes through the other within the tolerance or grazes the outline of the face.
  CHECK(cycles <= n / 2000);
}

TEST_CASE("V-Clip agrees with GJK on a million pairs of 4 to 512 vertices") {
  Random r(72);
  struct Both {
    VoronoiPolyhedron voronoi;
    std::shared_ptr<const Shape> shape;
  };
  std::vector<Both> shapes;
  for (int n : {4, 5, 8, 8, 12, 16, 32, 64, 128, 512}) {
    const Vec3 axes = random_vec(r, 0.3, 1.5);
    const auto s = random_hull(r, n, axes);
    shapes.push_back({voronoi(static_cast<const ConvexHullShape&>(*s).polyhedron()), s});
  }
  const int n = cases(1000000);
  int wrong = 0, apart = 0, searched = 0;
  for (int i = 0; i < n; ++i) {
    const uint32_t most = i % 16 ? 7 : 10;  // large ones now and then
    const Both &a = shapes[r.below(most)], &b = shapes[r.below(most)];
    const Pose pa{Vec3::Zero(), random_rotation(r)};
    const Pose pb{random_direction(r) * r.uniform(0.5, 3.5), random_rotation(r)};
    const VClipResult v = clip(a.voronoi, pa, b.voronoi, pb);
    const GjkResult g = gjk({*a.shape->convex(), pa.q, pa.x}, {*b.shape->convex(), pb.q, pb.x});
    const double scale = pair_scale(a.voronoi, pa, b.voronoi, pb);
    const bool overlap = v.state == VClipState::penetrating;
    wrong += std::abs(v.distance - g.distance) > 1e-9 * scale;
    wrong += overlap != (g.status == GjkStatus::intersecting) && g.distance > 1e-9 * scale;
    apart += !overlap;
    searched += v.answer != VClipAnswer::walk;
  }
  CHECK(wrong == 0);
  CHECK(searched <= 1 + n / 100000);
  if (n >= 1000) CHECK((apart > 0.3 * n && apart < 0.95 * n));
}

TEST_CASE("V-Clip from the last features: the distance of a cold start, at near constant cost") {
  Random r(73);
  for (int n : {8, 32, 128, 512}) {
    const VoronoiPolyhedron a = random_polyhedron(r, n, {1, 0.7, 1.3}),
                            b = random_polyhedron(r, n, {0.8, 1.2, 0.6});
    ClosestFeatures last;
    const int frames = cases(2000);
    double warm = 0, cold = 0;
    for (int k = 0; k < frames; ++k) {
      const Pose pb = orbit(k);
      const VClipResult c = clip(a, {}, b, pb), w = clip(a, {}, b, pb, &last);
      CHECK(std::abs(c.distance - w.distance) < 1e-12 * pair_scale(a, {}, b, pb));
      CHECK(c.state == VClipState::separated);
      last = w.features;
      warm += w.steps;
      cold += c.steps;
    }
    CHECK(warm <= 2.0 * frames + 60);  // the first start is cold
    CHECK(warm <= cold + 20);
  }
}

TEST_CASE("V-Clip from any pair of features reaches the same distance") {
  Random r(74);
  const std::array<VoronoiPolyhedron, 4> shapes{random_polyhedron(r, 512, {1, 0.7, 1.3}),
                                                random_polyhedron(r, 100, {0.8, 1.2, 1e-3}),
                                                prism(64, {1, 1, 1}), box_polyhedron({1, 1, 1})};
  for (int i = 0; i < cases(3000); ++i) {
    const auto &a = shapes[r.below(4)], &b = shapes[r.below(4)];
    const Pose pb = draw_pose(r, i % 2 ? PoseFamily::random : PoseFamily::near, a, b);
    const ClosestFeatures start = random_features(r, a, b);
    const VClipResult cold = clip(a, {}, b, pb), other = clip(a, {}, b, pb, &start);
    const double scale = pair_scale(a, {}, b, pb);
    CHECK(std::abs(cold.distance - other.distance) < 2e-12 * scale);
    if (cold.distance > 1e-11 * scale) CHECK(other.state == VClipState::separated);
  }
}

TEST_CASE("V-Clip of parallel boxes on a lattice has the closed form") {
  Random r(75);
  for (int i = 0; i < cases(4000); ++i) {
    const Vec3 ha = (random_vec(r, 0.5, 4.5).array().round() / 4).matrix(),
               hb = (random_vec(r, 0.5, 4.5).array().round() / 4).matrix();
    const VoronoiPolyhedron a = box_polyhedron(ha), b = box_polyhedron(hb);
    const Pose pb{(random_vec(r, -10, 10).array().round() / 4).matrix(), Quat::Identity()};
    const Vec3 gaps = pb.x.cwiseAbs() - ha - hb;
    const VClipResult v = clip(a, {}, b, pb);
    const double exact = gaps.cwiseMax(0.0).norm();
    CHECK(std::abs(v.distance - exact) < 1e-14);
    const double greatest = gaps.maxCoeff();
    CHECK(v.state == (greatest > 0    ? VClipState::separated
                      : greatest == 0 ? VClipState::touching
                                      : VClipState::penetrating));
    CHECK(v.answer == VClipAnswer::walk);
    if (exact > 0) {
      Vec3 towards = gaps.cwiseMax(0.0) / exact;
      for (int k = 0; k < 3; ++k) towards[k] = std::copysign(towards[k], pb.x[k]);
      CHECK((v.normal - towards).norm() < 1e-14);
    }
  }
}

TEST_CASE("V-Clip at small gaps of edges almost parallel, and faces almost parallel") {
  Random r(76);
  const VoronoiPolyhedron a = prism(3, {1, 3, 1}), b = prism(64, {1, 1, 1}),
                          c = box_polyhedron({1, 0.5, 2});
  for (int i = 0; i < cases(1000); ++i) {
    const double gap = std::pow(10.0, -r.uniform(1, 12)), turn = std::pow(10.0, -r.uniform(1, 14));
    // Ridge over ridge, crossing at a small angle.
    const Vec3 along(0, r.uniform(-1.5, 1.5), 0);
    const Pose ridge{Vec3(2 + gap, 0, 0) + along,
                     axis_angle(Vec3::UnitX(), turn) * axis_angle(Vec3::UnitY(), det::pi)};
    check_answer(a, {}, a, ridge, clip(a, {}, a, ridge));
    // Many-sided cap over cap, and over a box; the same corners above each other.
    const Pose cap{Vec3(0, 1 + gap, 0), axis_angle(random_direction(r), turn)};
    if (i % 50 == 0) check_answer(b, {}, b, cap, clip(b, {}, b, cap));
    check_answer(c, {}, c, cap, clip(c, {}, c, cap));
    const ClosestFeatures start = random_features(r, c, c);
    check_answer(c, {}, c, cap, clip(c, {}, c, cap, &start));
  }
}

TEST_CASE("V-Clip far from the origin loses nothing: the poses count as they are given") {
  Random r(77);
  const VoronoiPolyhedron a = random_polyhedron(r, 20, {1, 0.5, 1}),
                          b = box_polyhedron({0.5, 1, 1});
  for (int i = 0; i < cases(1000); ++i) {
    const Pose pa{random_direction(r) * std::pow(10.0, r.uniform(3, 7)), random_rotation(r)};
    const Pose pb{pa.x + random_direction(r) * r.uniform(0, 4), random_rotation(r)};
    const VClipResult v = clip(a, pa, b, pb);
    const ReferenceDistance exact = ReferencePair(a, pa, b, pb).distance();
    CHECK(std::abs(v.distance - double(exact.distance)) < 1e-12 * pair_scale(a, pa, b, pb));
    CHECK((v.state == VClipState::penetrating) == (exact.overlap > 0));
  }
}

TEST_CASE("thin bodies that almost coincide are seen to overlap, whatever GJK says") {
  Random r(78);
  const VoronoiPolyhedron needle = random_polyhedron(r, 12, {1, 1e-4, 1e-4}),
                          slab = random_polyhedron(r, 7, {1, 1, 1e-4}),
                          plate = prism(5, {1, 1e-4, 1});
  for (int i = 0; i < cases(2000); ++i) {
    for (const VoronoiPolyhedron* p : {&needle, &slab, &plate}) {
      Pose pb = draw_pose(r, PoseFamily::coincident, *p, *p);
      if (pb.x.norm() > 1e-6 || pb.q.vec().norm() > 1e-6) continue;
      const ClosestFeatures start = random_features(r, *p, *p);
      CHECK(clip(*p, {}, *p, pb).state == VClipState::penetrating);
      CHECK(clip(*p, {}, *p, pb, &start).state == VClipState::penetrating);
    }
  }
}

TEST_CASE("V-Clip with hostile input") {
  Random r(79);
  const VoronoiPolyhedron a = box_polyhedron({1, 1, 1});
  const double inf = std::numeric_limits<double>::infinity(), nan = std::nan("");
  for (double bad : {inf, -inf, nan}) {
    CHECK(clip(a, {}, a, {{3, bad, 0}, Quat::Identity()}).state == VClipState::invalid);
    CHECK(clip(a, {{bad, 0, 0}, Quat::Identity()}, a, {}).state == VClipState::invalid);
    CHECK(clip(a, {}, a, {{3, 0, 0}, Quat(bad, 0, 0, 0)}).state == VClipState::invalid);
    CHECK(clip(a, {{3, 0, 0}, Quat(0, bad, 0, 0)}, a, {}).state == VClipState::invalid);
  }
  CHECK(clip(a, {}, a, {{1e200, 0, 0}, Quat::Identity()}).state == VClipState::invalid);
  const Pose pb{{3, 0, 0}, Quat::Identity()};
  using enum FeatureKind;
  for (const ClosestFeatures& start :
       {ClosestFeatures{{{vertex, 8}, {vertex, 0}}}, ClosestFeatures{{{face, 0}, {face, 1}}},
        ClosestFeatures{{{edge, 12}, {face, 6}}},
        ClosestFeatures{{{FeatureKind(7), 0}, {edge, 1}}}})
    CHECK(clip(a, {}, a, pb, &start).distance == 1);

  ConvexPolyhedron p = hull_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}});
  p.vertices[0] = {1, 1, 1};
  CHECK(!make_voronoi_polyhedron(p).ok());
  p.vertices[0] = {nan, 0, 0};
  CHECK(!make_voronoi_polyhedron(p).ok());
  auto folded = make_polyhedron({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.2, 0.2, 0.1}, {0, 0, 1}},
                                {{0, 2, 1}, {0, 1, 4}, {0, 4, 2}, {1, 3, 4}, {1, 2, 3}, {2, 4, 3}});
  REQUIRE(folded.ok());
  CHECK(!make_voronoi_polyhedron(*folded).ok());
}

TEST_CASE(
    "V-Clip's trace starts where it is told, ends at the answer, and moves one step at a time") {
  Random r(80);
  const VoronoiPolyhedron a = random_polyhedron(r, 60, {1, 1, 1});
  for (int i = 0; i < cases(200); ++i) {
    const ClosestFeatures start = random_features(r, a, a);
    std::vector<ClosestFeatures> trace;
    VClipOptions options;
    options.start = &start;
    options.trace = &trace;
    const VClipResult v = v_clip({a, Pose{}}, {a, orbit(i)}, options);
    REQUIRE(trace.size() == size_t(v.steps));
    CHECK(trace.front() == start);
    CHECK(trace.back() == v.features);
    for (size_t k = 1; k < trace.size(); ++k)
      CHECK((trace[k][0] == trace[k - 1][0]) != (trace[k][1] == trace[k - 1][1]));
  }
}
