// Continuous tests: hand-made queries with closed-form times at many scales, separations against
// sampled distances, triangles against the exact static test at sampled times, balls against the
// quadratic in extended precision.
#include "engine/geometry/constructions/closest_points.hpp"
#include "engine/geometry/continuous_tests/sphere_sphere.hpp"
#include "engine/geometry/continuous_tests/triangle_triangle.hpp"
#include "engine/geometry/primitive_tests/triangle_pairs.hpp"
#include "tests/geometry/continuous_families.hpp"

#include <limits>
#include <vector>

#include <doctest/doctest.h>

using namespace tumble;
using namespace tumble::continuous;

namespace {

constexpr double never = -1;

struct Made {
  const char* name;
  double time;
  Query q;
};

MovingPoint moving(double x, double y, double z, double u, double v, double w) {
  return {{x, y, z}, {u, v, w}};
}
MovingPoint still(double x, double y, double z) {
  return moving(x, y, z, x, y, z);
}

std::vector<Made> hand_made() {
  std::vector<Made> out;
  const auto add = [&](const char* name, double time, bool edges, std::array<MovingPoint, 4> p) {
    Query q;
    q.edges = edges;
    q.p = p;
    out.push_back({name, time, q});
  };
  const MovingPoint a = still(0, 0, 0), b = still(4, 0, 0), c = still(0, 4, 0);
  const auto face = [&](const char* name, double time, MovingPoint p) {
    add(name, time, false, {p, a, b, c});
  };
  face("through the inside from above", 0.5, moving(1, 1, 2, 1, 1, -2));
  face("through the inside from below", 0.5, moving(1, 1, -2, 1, 1, 2));
  face("arrives at the end", 1, moving(1, 1, 2, 1, 1, 0));
  face("leaves at once", 0, moving(1, 1, 0, 1, 1, 3));
  face("rests on the face", 0, still(1, 1, 0));
  face("slides on the face", 0, moving(1, 1, 0, 2, 1, 0));
  face("through a side", 0.5, moving(2, 0, 2, 2, 0, -2));
  face("through the long side", 0.25, moving(2, 2, 1, 2, 2, -3));
  face("through a corner", 0.5, moving(0, 0, 1, 0, 0, -1));
  face("passes outside", never, moving(5, 5, 1, 5, 5, -1));
  face("in the plane, into a side", 0.5, moving(-2, 1, 0, 2, 1, 0));
  face("in the plane, into a corner", 0.5, moving(-2, -2, 0, 2, 2, 0));
  face("in the plane, past", never, moving(-2, -1, 0, 6, -1, 0));
  face("in the plane, grazing a corner", 0.5, moving(4, -4, 0, 4, 4, 0));
  face("in the plane, stops at a side", 1, moving(-4, 1, 0, 0, 1, 0));
  face("in the plane, along a side", 0.5, moving(-4, 0, 0, 4, 0, 0));
  face("stays above", never, moving(1, 1, 1, 2, 1, 1));
  face("moves with a corner", 0, still(4, 0, 0));
  face("leaves a corner", 0, moving(4, 0, 0, 5, 5, 5));
  face("arrives at a corner", 1, moving(5, 5, 5, 4, 0, 0));
  add("all move together", never, false,
      {moving(1, 1, 1, 3, 4, 5), moving(0, 0, 0, 2, 3, 4), moving(4, 0, 0, 6, 3, 4),
       moving(0, 4, 0, 2, 7, 4)});
  add("the face shrinks to a point", 1, false,
      {moving(1, 1, 1, 1, 1, 0), moving(0, 0, 0, 1, 1, 0), moving(4, 0, 0, 1, 1, 0),
       moving(0, 4, 0, 1, 1, 0)});
  add("the face is a point", 0.25, false, {moving(-1, 0, 0, 3, 0, 0), a, a, a});
  add("the face is a point, passed", never, false, {moving(-1, 1, 0, 3, 1, 0), a, a, a});
  add("the face is a segment", 0.5, false, {moving(1, 0, 2, 1, 0, -2), a, b, still(2, 0, 0)});
  add("the face is a segment, passed", never, false,
      {moving(1, 1, 2, 1, 1, -2), a, b, still(2, 0, 0)});
  add("all on a line", 0.5, false, {moving(-2, 0, 0, 2, 0, 0), a, b, still(2, 0, 0)});
  add("at rest in a slanted face", 0, false,
      {still(1, 1, 2), still(0, 0, 0), still(4, 0, 4), still(0, 4, 4)});
  add("at rest beside a slanted face", never, false,
      {still(1, 1, 3), still(0, 0, 0), still(4, 0, 4), still(0, 4, 4)});
  // The plane z = s x, s from -1 to 1, above a point that runs along x: the gap is (2t - 1)^2.
  const MovingPoint left = moving(-4, -4, 4, -4, -4, -4), right = moving(4, -4, -4, 4, -4, 4);
  add("grazes a turning face", 0.5, false,
      {moving(-1, 0, 0, 1, 0, 0), left, right, still(0, 8, 0)});
  add("misses a turning face", never, false,
      {moving(-1, 0, -1, 1, 0, -1), left, right, still(0, 8, 0)});
  add("dips through a turning face", 0.25, false,
      {moving(-1, 0, 0.25, 1, 0, 0.25), left, right, still(0, 8, 0)});
  add("outside at the first root, inside at the second", 0.75, false,
      {moving(-1, -7.5, 0.25, 1, -7.5, 0.25), still(0, -8, 0), moving(8, -8, -8, 8, -8, 8),
       moving(8, 8, -8, 8, 8, 8)});

  const MovingPoint e = still(-2, 0, 0), f = still(2, 0, 0);
  const auto edge = [&](const char* name, double time, MovingPoint p, MovingPoint q) {
    add(name, time, true, {e, f, p, q});
  };
  edge("edges cross", 0.5, moving(0, -2, 2, 0, -2, -2), moving(0, 2, 2, 0, 2, -2));
  edge("ends touch", 0.5, moving(2, 0, 2, 2, 0, -2), moving(2, 4, 2, 2, 4, -2));
  edge("beyond the end", never, moving(3, -2, 2, 3, -2, -2), moving(3, 2, 2, 3, 2, -2));
  edge("parallel", 0.5, moving(-1, 0, 2, -1, 0, -2), moving(1, 0, 2, 1, 0, -2));
  edge("parallel, beyond the end", never, moving(3, 0, 2, 3, 0, -2), moving(5, 0, 2, 5, 0, -2));
  edge("on one line", 2.0 / 3, moving(6, 0, 0, 0, 0, 0), moving(8, 0, 0, 2, 0, 0));
  edge("on one line, overlapping", 0, moving(1, 0, 0, 2, 0, 0), moving(5, 0, 0, 6, 0, 0));
  edge("parallel, side by side", never, moving(-6, 1, 0, 6, 1, 0), moving(-4, 1, 0, 8, 1, 0));
  edge("the other is a point", 0.5, moving(0, 0, 2, 0, 0, -2), moving(0, 0, 2, 0, 0, -2));
  edge("in a plane, end on", 0.5, moving(0, 4, 0, 0, 0, 0), moving(0, 2, 0, 0, -2, 0));
  edge("in a plane, onto the end", 0.5, moving(3, -1, 0, 1, -1, 0), moving(3, 1, 0, 1, 1, 0));
  edge("in a plane, past", never, moving(3, -9, 0, 3, 7, 0), moving(3, -7, 0, 3, 9, 0));
  edge("cross at the start and leave", 0, moving(0, -2, 0, 0, -2, 9), moving(0, 2, 0, 0, 2, 9));
  edge("cross at the end", 1, moving(0, -2, 2, 0, -2, 0), moving(0, 2, 2, 0, 2, 0));
  edge("at rest, crossing", 0, still(0, -2, 0), still(0, 2, 0));
  edge("at rest, apart", never, still(0, -2, 1), still(0, 2, 1));
  edge("identical", 0, e, f);
  edge("share an end and open", 0, f, moving(2, 2, 0, 5, 2, 3));
  edge("very fast", 0.5, moving(0, -1, 1024, 0, -1, -1024), moving(0, 1, 1024, 0, 1, -1024));
  add("both are points", 0.25, true, {a, a, moving(-1, 0, 0, 3, 0, 0), moving(-1, 0, 0, 3, 0, 0)});
  add("both are points, passing", never, true,
      {a, a, moving(-1, 1, 0, 3, 1, 0), moving(-1, 1, 0, 3, 1, 0)});
  const MovingPoint down = moving(-4, 0, 4, -4, 0, -4), up = moving(4, 0, -4, 4, 0, 4);
  add("grazes a turning edge", 0.5, true,
      {down, up, moving(-1, -2, 0, 1, -2, 0), moving(-1, 2, 0, 1, 2, 0)});
  add("misses a turning edge", never, true,
      {down, up, moving(-1, -2, -1, 1, -2, -1), moving(-1, 2, -1, 1, 2, -1)});
  add("dips through a turning edge", 0.25, true,
      {down, up, moving(-1, -2, 0.25, 1, -2, 0.25), moving(-1, 2, 0.25, 1, 2, 0.25)});
  add("an edge that turns inside out is a point when met", 0.5, true,
      {moving(-2, 0, 0, 2, 0, 0), moving(2, 0, 0, -2, 0, 0), moving(0, -2, 2, 0, -2, -2),
       moving(0, 2, 2, 0, 2, -2)});
  return out;
}

}  // namespace

TEST_CASE("continuous: hand-made queries at all scales, far away, turned and mirrored") {
  const std::vector<Made> all = hand_made();
  CHECK(all.size() >= 50);
  for (const Made& m : all) {
    CAPTURE(m.name);
    // Powers of two and whole shifts keep the query exactly what it is.
    for (const int power : {-1065, -900, -300, -40, -20, -1, 0, 1, 20, 40, 300, 900, 1010}) {
      for (const double away : {0.0, 1024.0, 1048576.0 * 1024}) {
        if (away > 0 && std::abs(power) > 900) continue;
        for (int turn = 0; turn < 6; ++turn) {
          Query q = m.q;
          for (MovingPoint& p : q.p) {
            for (Vec3* v : {&p.start, &p.end}) {
              Vec3 w = *v + away * Vec3(1, -2, 3);
              if (power == -1065) w *= 4;  // quarters must stay whole units of 2^-1074
              const double scale = std::ldexp(1.0, power / 2);
              w = scale * w * std::ldexp(1.0, power - power / 2);
              *v = turn % 3 == 0   ? w
                   : turn % 3 == 1 ? Vec3(w.y(), w.z(), w.x())
                                   : Vec3(-w.z(), w.y(), w.x());
            }
          }
          if (turn >= 3) {
            if (q.edges) {
              std::swap(q.p[0], q.p[2]);
              std::swap(q.p[1], q.p[3]);
            } else {
              std::swap(q.p[1], q.p[3]);
            }
          }
          CAPTURE(power);
          CAPTURE(away);
          CAPTURE(turn);
          const auto answer = q.answer();
          REQUIRE(answer.has_value() == (m.time >= 0));
          if (!answer) continue;
          REQUIRE(answer->t_lo <= m.time);
          REQUIRE(answer->t_lo >= m.time - 1e-6);
          REQUIRE(answer->t_hi >= m.time);
          REQUIRE(answer->t_hi >= answer->t_lo);
        }
      }
    }
  }
}

TEST_CASE("continuous: where and which way") {
  const MovingTriangle face{still(0, 0, 0), still(4, 0, 0), still(0, 4, 0)};
  auto c = vertex_face_contact(moving(1, 2, 2, 1, 2, -2), face).value();
  REQUIRE(c.has_value());
  CHECK(c->certain);
  CHECK((c->parameters - Vec2(0.25, 0.5)).norm() < 1e-12);
  CHECK((c->normal - Vec3(0, 0, -1)).norm() < 1e-12);
  c = vertex_face_contact(moving(1, 2, -2, 1, 2, 2), face, 0.5).value();
  REQUIRE(c.has_value());
  CHECK(c->certain);
  CHECK(c->t_lo == doctest::Approx(0.375).epsilon(1e-9));
  CHECK((c->normal - Vec3(0, 0, 1)).norm() < 1e-9);
  const MovingEdge a{still(-2, 0, 0), still(2, 0, 0)};
  c = edge_edge_contact(a, {moving(1, -1, 2, 1, -1, -2), moving(1, 3, 2, 1, 3, -2)}).value();
  REQUIRE(c.has_value());
  CHECK((c->parameters - Vec2(0.75, 0.25)).norm() < 1e-12);
  CHECK((c->normal - Vec3(0, 0, 1)).norm() < 1e-12);
}

TEST_CASE("continuous: what is not a number or negative is refused") {
  const double nan = std::numeric_limits<double>::quiet_NaN(),
               infinite = std::numeric_limits<double>::infinity();
  Random r(3);
  for (const double bad : {nan, infinite, -infinite}) {
    for (size_t i = 0; i < 4; ++i) {
      for (int k = 0; k < 3; ++k) {
        Query q = near_query(r, false);
        (i % 2 ? q.p[i].end : q.p[i].start)[k] = bad;
        CHECK(!vertex_face_contact(q.p[0], q.face()));
        CHECK(!edge_edge_contact(q.first(), q.second()));
        CHECK(!moving_triangles_contact(q.face(), {q.p[0], q.p[1], q.p[2]}));
        CHECK(!moving_spheres_contact({q.p[i], 1}, {{}, 1}));
      }
    }
    const Query q = near_query(r, false);
    CHECK(!vertex_face_contact(q.p[0], q.face(), -1));
    CHECK(!vertex_face_contact(q.p[0], q.face(), nan));
    CHECK(!moving_spheres_contact({q.p[0], bad}, {q.p[1], 1}));
  }
  CHECK(!moving_spheres_contact({{}, -1}, {{}, 1}));
}

TEST_CASE("continuous: a separation is kept") {
  int contacts = 0, certain = 0;
  const int n = draws::count(4000);
  Random r(91);
  for (int i = 0; i < n; ++i) {
    Query q = i % 4 == 0 ? hostile_query(r, int(r.below(hostile_families)), i % 2 != 0)
                         : random_query(r, i % 2 != 0);
    const double size = size_of(q), d = size * std::pow(10.0, r.uniform(-6, -0.7));
    const auto distance = [&](double t) {
      const Vec3 p[4] = {q.p[0].at(t), q.p[1].at(t), q.p[2].at(t), q.p[3].at(t)};
      return std::sqrt(q.edges ? closest_segment_segment(p[0], p[1], p[2], p[3]).squared_distance
                               : closest_on_triangle(p[0], p[1], p[2], p[3]).squared_distance);
    };
    const auto c = q.answer(d);
    contacts += c.has_value();
    const double until = c ? c->t_lo : 1;
    for (int k = 0; until > 0 && k <= 64; ++k) {
      REQUIRE(distance(until * k / 64) > d - 1e-12 * size);
    }
    if (!c) continue;
    certain += c->certain;
    if (c->certain) REQUIRE(distance(c->t_hi) < d + 1e-12 * size);
    if (c->t_lo > 0) REQUIRE(std::fabs(distance(c->t_lo) - d) < 1e-9 * size);
    REQUIRE(c->t_hi - c->t_lo < (c->certain ? 1e-6 : 1.0));
  }
  MESSAGE(n, " queries, ", contacts, " contacts, ", certain, " certain");
  if (n > 1000) {
    CHECK(contacts > n / 5);
    CHECK(contacts < n * 4 / 5);
    CHECK(certain > contacts * 0.99);
  }
}

TEST_CASE("continuous: triangles against the static test at sampled times") {
  int contacts = 0, initial = 0, confirmed = 0;
  const int n = draws::count(4000);
  Random r(95);
  for (int i = 0; i < n; ++i) {
    MovingTriangle a, b;
    const Vec3 apart = 1.5 * draws::direction(r), drift = -1.5 * r.uniform() * apart;
    for (size_t k = 0; k < 3; ++k) {
      a[k].start = draws::in_box(r, 1);
      a[k].end = a[k].start + draws::in_box(r, 0.5);
      b[k].start = apart + draws::in_box(r, 1);
      b[k].end = b[k].start + drift + draws::in_box(r, 0.5);
    }
    const auto at = [](const MovingTriangle& t, double s) {
      return Triangle3{t[0].at(s), t[1].at(s), t[2].at(s)};
    };
    const auto c = moving_triangles_contact(a, b).value();
    const double until = c ? c->t_lo - 1e-12 : 1;
    for (int k = 0; k <= 40; ++k) {
      if (until > 0)
        REQUIRE_FALSE(triangles_intersect(at(a, until * k / 40), at(b, until * k / 40)));
    }
    if (!c) continue;
    ++contacts;
    initial += c->features == MovingFeatures::overlap;
    REQUIRE(c->certain);
    REQUIRE(c->t_hi - c->t_lo < 1e-6);
    const double distance =
        std::sqrt(closest_triangle_triangle(at(a, c->t_hi), at(b, c->t_hi)).squared_distance);
    REQUIRE(distance < 1e-6);
    const double later = std::min(1.0, c->t_hi + 1e-7);
    confirmed += triangles_intersect(at(a, later), at(b, later));
    // The other way round: same time, opposite normal.
    const auto swapped = moving_triangles_contact(b, a).value();
    REQUIRE(swapped.has_value());
    REQUIRE(std::fabs(swapped->t_lo - c->t_lo) < 1e-6);
    if (c->features != MovingFeatures::overlap) {
      REQUIRE((swapped->normal + c->normal).norm() < 1e-6);
    }
  }
  MESSAGE(n, " pairs, ", contacts, " meet, ", initial, " from the start, ", confirmed,
          " confirmed");
  if (n > 1000) {
    CHECK(contacts > n / 5);
    CHECK(contacts < n * 4 / 5);
    CHECK(confirmed > contacts * 0.99);
  }
}

TEST_CASE("continuous: triangles, degenerate pairs") {
  const MovingTriangle floor{still(0, 0, 0), still(4, 0, 0), still(0, 4, 0)};
  const auto shifted = [&](Vec3 from, Vec3 to) {
    MovingTriangle t = floor;
    for (MovingPoint& p : t) p.start += from, p.end += to;
    return t;
  };
  const auto time = [&](Vec3 from, Vec3 to, double separation = 0) {
    const auto c = moving_triangles_contact(floor, shifted(from, to), separation).value();
    return c ? c->t_lo : never;
  };
  CHECK(time({0, 0, 2}, {0, 0, -2}) == doctest::Approx(0.5).epsilon(1e-6));  // face on face
  CHECK(time({0, 0, 0}, {0, 0, 0}) == 0);                                    // identical
  CHECK(time({8, 0, 0}, {0, 0, 0}) == doctest::Approx(0.5).epsilon(1e-6));   // in one plane
  CHECK(time({8, 0, 1}, {0, 0, 1}) == never);
  CHECK(time({4, 0, 0}, {9, 0, 0}) == 0);  // corner on corner, leaving
  CHECK(time({9, 9, 9}, {4, 0, 0}) == doctest::Approx(1).epsilon(1e-6));
  CHECK(time({0, 0, 2}, {0, 0, 1}, 1.5) == doctest::Approx(0.5).epsilon(1e-6));
  CHECK(time({0, 0, 2}, {0, 0, 1}, 0.5) == never);
  // Crossed at the start, no two features touching.
  const MovingTriangle wall{still(1, 1, -1), still(1, 1, 3), still(9, 9, 1)};
  const auto c = moving_triangles_contact(floor, wall).value();
  REQUIRE(c.has_value());
  CHECK(c->features == MovingFeatures::overlap);
  CHECK(c->t_hi == 0);
  for (const double scale : {0x1p-1060, 0x1p-400, 0x1p400, 0x1p1010}) {  // beyond the exact range
    MovingTriangle a = floor, b = wall, d = shifted({0, 0, 1}, {0, 0, 2});
    for (MovingTriangle* t : {&a, &b, &d}) {
      for (MovingPoint& p : *t) p.start *= scale, p.end *= scale;
    }
    const auto crossed = moving_triangles_contact(a, b).value();
    REQUIRE(crossed.has_value());
    CHECK(crossed->t_lo == 0);
    CHECK_FALSE(moving_triangles_contact(a, d).value().has_value());
  }
}

TEST_CASE("continuous: balls against the quadratic in extended precision") {
  int contacts = 0;
  const int n = draws::count(50000);
  Random r(97);
  for (int i = 0; i < n; ++i) {
    MovingSphere a, b;
    const double scale = std::pow(10.0, double(int(r.below(25)) - 12));
    for (MovingSphere* s : {&a, &b}) {
      s->centre = {scale * draws::in_box(r, 1), scale * draws::in_box(r, 1)};
      s->radius = scale * r.uniform(0, 0.4);
    }
    long double qa = 0, qb = 0, qc = -powl((long double)a.radius + b.radius, 2);
    for (int k = 0; k < 3; ++k) {
      const long double x = (long double)b.centre.start[k] - a.centre.start[k];
      const long double w = (long double)b.centre.end[k] - a.centre.end[k] - x;
      qa += w * w, qb += x * w, qc += x * x;
    }
    long double t = never;
    const long double discriminant = qb * qb - qa * qc;
    if (qc <= 0) {
      t = 0;
    } else if (qb < 0 && discriminant >= 0) {
      t = qc / (-qb + sqrtl(discriminant));
    }
    if (fabsl(t - 1) < 1e-12L || fabsl(discriminant) < 1e-14L * qb * qb) continue;
    const bool meets = t >= 0 && t <= 1;
    const auto c = moving_spheres_contact(a, b).value();
    REQUIRE(c.has_value() == meets);
    if (!c) continue;
    ++contacts;
    REQUIRE(c->certain);
    REQUIRE((long double)c->t_lo <= t + 1e-17L);
    REQUIRE((long double)c->t_hi >= t - 1e-17L);
    REQUIRE(c->t_hi - c->t_lo < 1e-6);
  }
  if (n > 1000) {
    CHECK(contacts > n / 10);
    CHECK(contacts < n * 9 / 10);
  }
}

TEST_CASE("continuous: balls that graze, touch at the ends, or have no size") {
  for (const int power : {-1060, -500, -30, 0, 30, 500, 1000}) {
    const double s = std::ldexp(1.0, power);
    const auto time = [&](MovingPoint a, double ra, MovingPoint b, double rb) {
      for (MovingPoint* p : {&a, &b}) p->start *= s, p->end *= s;
      const auto c = moving_spheres_contact({a, s * ra}, {b, s * rb}).value();
      if (!c) return never;
      CHECK(c->certain);
      CHECK(c->t_hi - c->t_lo < 1e-6);
      return 0.5 * (c->t_lo + c->t_hi);
    };
    const MovingPoint origin = still(0, 0, 0);
    const auto near = [](double t) { return doctest::Approx(t).epsilon(1e-7); };
    CHECK(time(origin, 1, moving(-4, 3, 0, 4, 3, 0), 2) == near(0.5));  // grazes exactly
    CHECK(time(origin, 1, moving(-4, 4, 0, 4, 4, 0), 2) == never);
    CHECK(time(origin, 2, moving(-4, 3, 4, 4, 3, 4), 3) == near(0.5));
    CHECK(time(origin, 1, moving(9, 0, 0, 3, 0, 0), 2) == near(1));  // arrives at the end
    CHECK(time(origin, 1, moving(3, 0, 0, 9, 0, 0), 2) == 0);        // leaves at once
    CHECK(time(origin, 1, still(3, 0, 0), 2) == 0);
    CHECK(time(origin, 1, still(4, 0, 0), 2) == never);
    CHECK(time(origin, 0, moving(-1, 0, 0, 3, 0, 0), 0) == near(0.25));
    CHECK(time(origin, 0, moving(-1, 1, 0, 3, 1, 0), 0) == never);
    CHECK(time(origin, 0, origin, 0) == 0);
  }
}
