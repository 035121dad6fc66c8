// What onlookers get of GJK, EPA and advancement. References: the plain calls without an onlooker,
// the closed-form distance of two balls, supports of the difference, Euler's formula.
#include "engine/collision/continuous/advancement.hpp"
#include "engine/collision/gjk/epa.hpp"
#include "tests/collision/support.hpp"

using namespace tumble;
using namespace tumble::test;

namespace {

PlacedCore core_at(const std::shared_ptr<const Shape>& shape, const Pose& pose) {
  return PlacedCore(*shape->convex(), pose.q, pose.x);
}

}  // namespace

TEST_CASE("EPA answers the same when watched, and its stages close in on the depth") {
  Random r(91);
  int grown = 0;
  for (int i = 0; i < cases(100); ++i) {
    const auto a = random_hull(r, 12, Vec3::Ones()), b = random_hull(r, 12, Vec3::Ones());
    const PlacedCore A = core_at(a, {Vec3::Zero(), random_rotation(r)});
    const PlacedCore B = core_at(b, {random_direction(r) * 0.6, random_rotation(r)});
    const GjkResult g = gjk(A, B);
    if (g.status != GjkStatus::intersecting) continue;
    EpaTrace trace;
    const EpaResult watched = epa(A, B, g.simplex, 1e-9, &trace), plain = epa(A, B, g.simplex);
    CHECK(watched.depth == plain.depth);
    CHECK(watched.normal == plain.normal);
    REQUIRE(trace.size() == size_t(plain.iterations));
    grown += trace.size() > 2;
    for (size_t k = 0; k < trace.size(); ++k) {
      const EpaStage& s = trace[k];
      REQUIRE(s.nearest < s.faces.size());
      CHECK(s.faces.size() % 2 == 0);  // 2 V - 4 triangles
      CHECK(s.lower <= plain.depth + 1e-12);
      CHECK(s.upper >= plain.depth - 1e-12);
      const Vec3 out = A.R * s.normal;
      CHECK(std::abs(s.normal.dot(s.support) - out.dot(A.support(out) - B.support(-out))) < 1e-12);
      if (k > 0) CHECK(s.lower >= trace[k - 1].lower - 1e-12);
    }
    CHECK(trace.back().upper - trace.back().lower < 1e-9);
  }
  if (cases(100) >= 100) CHECK(grown > 20);
}

TEST_CASE("GJK stopped after k steps is on the way to its answer") {
  Random r(92);
  for (int i = 0; i < cases(100); ++i) {
    const auto a = random_hull(r, 12, Vec3::Ones()), b = random_hull(r, 12, Vec3::Ones());
    const PlacedCore A = core_at(a, {Vec3::Zero(), random_rotation(r)});
    const PlacedCore B = core_at(b, {random_direction(r) * 3, random_rotation(r)});
    const GjkResult plain = gjk(A, B);
    double last = std::numeric_limits<double>::infinity();
    GjkResult g;
    g.status = GjkStatus::max_iterations;
    int k = 0;
    for (; !g.converged() && k <= 64; ++k) {
      GjkOptions options;
      options.max_iterations = k + 1;
      g = gjk(A, B, options);
      const double v = g.simplex.nearest().vec().norm();
      CHECK(v <= last * (1 + 1e-12));
      CHECK(v >= plain.distance * (1 - 1e-12));
      CHECK(g.lower_bound <= plain.distance * (1 + 1e-12));
      last = v;
    }
    REQUIRE(g.converged());
    CHECK(std::abs(k - plain.iterations) <= 2);  // rounding may end it a step sooner or later
    CHECK(last == doctest::Approx(plain.distance).epsilon(1e-12));
  }
}

TEST_CASE("the probes of two balls are at their distance, and never past the contact") {
  Random r(93);
  for (int i = 0; i < cases(200); ++i) {
    const auto a = sphere(r.uniform(0.1, 0.4)), b = sphere(r.uniform(0.1, 0.4));
    Motion ma = Motion::at_rest({random_vec(r, -1, 1), random_rotation(r)}, 0, 1), mb = ma;
    mb.start.x = ma.start.x + random_direction(r) * 2;
    mb.velocity = (ma.start.x - mb.start.x) * r.uniform(0.6, 1.5) + random_vec(r, -0.2, 0.2);
    const double radii = a->def().radius + b->def().radius;
    ContactTimeTrace trace;
    const double ra = a->def().radius, rb = b->def().radius;
    const MovingCore A{*a->convex(), ma, ra, 0}, B{*b->convex(), mb, rb, 0};
    const TimeOfContact watched = advance(A, B, 0, 1, 1e-5, &trace);
    const TimeOfContact plain = advance(A, B, 0, 1, 1e-5);
    CHECK(watched.time == plain.time);
    CHECK(watched.status == plain.status);
    REQUIRE(trace.size() == size_t(plain.iterations) + (plain.hit() ? 1 : 0));
    for (size_t k = 0; k < trace.size(); ++k) {
      const ContactTimeProbe& p = trace[k];
      const double exact = (mb.pose(p.time).x - ma.pose(p.time).x).norm() - radii;
      CHECK(std::abs(p.distance - std::max(exact, 0.0)) < 1e-6);
      CHECK(p.low <= p.high);
      if (k > 0) CHECK(p.time >= trace[k - 1].time);
      if (k + 1 < trace.size()) CHECK(p.distance > 0);
    }
  }
}
