// Yes or no of every pair of primitives. Reference: exact integers (Boost.Multiprecision), hulls by
// linear programming, distances over all simplices of corners; no resolution error. Random cases
// have coordinates of 24 to 40 bits, whose products round in doubles; degenerate ones lie on small
// lattices, where touching, coplanar, coincident and flat shapes are frequent; every fifth of them
// is moved off the lattice by one unit in 2^40, which leaves slivers and all but touching pairs.
#include "engine/geometry/predicates/filtered.hpp"
#include "engine/geometry/primitive_tests/primitive_tests.hpp"
#include "tests/geometry/exact_reference.hpp"
#include "tests/support/scale.hpp"

#include <doctest/doctest.h>

using namespace tumble;
using exact::Points;
using exact::Small;

namespace {

constexpr int random_cases = 1000000, degenerate_cases = 100000;

/// All cases of a family when TUMBLE_TEST_SCALE is set to 1 (the full tests), else a fiftieth of
/// the degenerate and an eightieth of the random ones, and a tenth of that under sanitizers: the
/// reference is slow.
int cases(bool degenerate) {
  const int all = degenerate ? degenerate_cases : random_cases, part = degenerate ? 50 : 80;
  return test::all_counts() ? draws::count(all) : all / (test::only_to_run() ? 10 * part : part);
}

/// Draws points of one family of cases.
struct Maker {
  Random random;
  int64_t half = 1;
  double scale = 1;
  Small origin{};
  int64_t grain = 1;  ///< lattice constant; when above 1, the second shape is also jittered by 1

  explicit Maker(uint64_t seed) : random(seed) {}

  /// Case i of the random or of the degenerate family.
  void start(int i, bool degenerate) {
    static constexpr std::array<int64_t, 4> lattices{1, 2, 3, 6};
    const auto k = size_t(i) % 4;
    half = degenerate ? lattices[k] : int64_t{1} << std::array<int, 4>{24, 30, 36, 40}[k];
    scale = degenerate ? (i % 3 ? 1.0 : 0x1p-30) : 1.0 / double(half);
    origin = {0, 0, 0};
    if (degenerate && i % 5 == 0) origin = {1048577, -77, 4097};
    grain = degenerate && i % 5 == 1 ? int64_t{1} << 40 : 1;
    if (grain > 1) scale = 0x1p-40;
  }
  int64_t coordinate(int64_t size) {
    return int64_t(random.uniform() * double(2 * size + 1)) - size;
  }
  Small vector(int64_t size) {
    const int64_t x = coordinate(size), y = coordinate(size), z = coordinate(size);
    return {grain * x, grain * y, grain * z};
  }
  Small point() { return exact::plus(origin, vector(half)); }
  Points points(int n) {
    Points out;
    for (int k = 0; k < n; ++k) out.push_back(point());
    return out;
  }
  /// Lattice boxes have any axes, often dependent or zero; the others nearly perpendicular ones of
  /// lengths up to half * extent.
  exact::Box box(bool degenerate, double extent) {
    exact::Box out;
    out.centre = point();
    if (degenerate) {
      for (Small& arm : out.arms) arm = vector(std::max<int64_t>(1, half / 2));
      if (random.below(3) == 0)
        out.arms = {Small{grain, 0, 0}, Small{0, 2 * grain, 0}, Small{0, 0, grain}};
      if (random.below(8) == 0) out.arms[random.below(3)] = {0, 0, 0};
      return out;
    }
    const Mat3 axes = draws::rotation(random).toRotationMatrix();
    for (int k = 0; k < 3; ++k) {
      const double length = random.uniform(0.2, 1) * extent * double(half);
      for (int c = 0; c < 3; ++c) {
        out.arms[size_t(k)][size_t(c)] = int64_t(length * axes(c, k));
      }
    }
    return out;
  }
  /// In every second lattice case a shift (jittered where the lattice is coarse) of b that puts a
  /// corner on a corner or the middle of two corners of a; otherwise none.
  Small snap(const Points& a, const Points& b, bool degenerate) {
    if (!degenerate || random.below(2)) return jitter();
    const auto any = [&](const Points& p) { return p[random.below(uint32_t(p.size()))]; };
    const Small p = any(a), q = any(a), from = any(b);
    Small target = p;
    const bool even = (p[0] + q[0]) % 2 == 0 && (p[1] + q[1]) % 2 == 0 && (p[2] + q[2]) % 2 == 0;
    for (size_t k = 0; k < 3 && even; ++k) target[k] = (p[k] + q[k]) / 2;
    return exact::plus(exact::plus(target, from, -1), jitter());
  }
  Small jitter() {
    if (grain == 1) return {0, 0, 0};
    const int64_t x = coordinate(1), y = coordinate(1), z = coordinate(1);
    return {x, y, z};
  }
  Points snapped(const Points& a, Points b, bool degenerate) {
    const Small shift = snap(a, b, degenerate);
    for (Small& p : b) p = exact::plus(exact::plus(p, shift), jitter());
    return b;
  }
  std::vector<Vec3> doubles(const Points& p) const {
    std::vector<Vec3> out;
    for (const Small& s : p) out.push_back(exact::to_double(s, scale));
    return out;
  }
  Triangle3 triangle(const Points& p) const {
    return {exact::to_double(p[0], scale), exact::to_double(p[1], scale),
            exact::to_double(p[2], scale)};
  }
  Segment segment(const Points& p) const {
    return {exact::to_double(p[0], scale), exact::to_double(p[1], scale)};
  }
};

/// Whether two hulls that meet only touch, at least from the first one's middle.
bool touches(Points a, const Points& b) {
  constexpr int64_t fine = 1 << 12;  // the products stay within 63 bits
  Small sum{};
  for (const Small& p : a) sum = exact::plus(sum, p);
  const auto n = int64_t(a.size());
  Points large;
  for (Small& p : a) {
    for (size_t k = 0; k < 3; ++k) p[k] = n * (fine - 1) * p[k] + sum[k];
  }
  for (Small p : b) {
    for (size_t k = 0; k < 3; ++k) p[k] *= n * fine;
    large.push_back(p);
  }
  return !exact::hulls_meet(a, large);
}

/// Counts of a family, for the assertion that it is representative.
struct Tally {
  int n = 0, hits = 0, touching = 0;
  uint64_t fallbacks = exact_fallbacks();

  void add(bool hit, const Points& a, const Points& b) {
    ++n;
    hits += hit;
    if (hit && n % 8 == 0) touching += 8 * touches(a, b);
  }
  void check(bool degenerate) const {
    MESSAGE(n, " cases, ", hits, " meet, about ", touching, " touch, ",
            exact_fallbacks() - fallbacks, " exact evaluations");
    if (n < 1000) return;
    if (!degenerate) {
      CHECK(hits > n * 3 / 10);
      CHECK(hits < n * 7 / 10);
    } else {
      CHECK(hits > n / 20);
      CHECK(touching > n / 50);
      CHECK(exact_fallbacks() > fallbacks);
    }
  }
};

template <class Case>
void run(uint64_t seed, const Case& one) {
  for (const bool degenerate : {false, true}) {
    Maker maker(seed + degenerate);
    Tally tally;
    const int n = cases(degenerate);
    for (int i = 0; i < n; ++i) {
      maker.start(i, degenerate);
      one(maker, tally, degenerate);
    }
    tally.check(degenerate);
  }
}

}  // namespace

TEST_CASE("exact: box against box") {
  run(100, [](Maker& m, Tally& tally, bool degenerate) {
    const exact::Box a = m.box(degenerate, 0.8);
    exact::Box b = m.box(degenerate, 0.8);
    b.centre = exact::plus(b.centre, m.snap(a.corners(), b.corners(), degenerate));
    const bool meet = exact::hulls_meet(a.corners(), b.corners());
    tally.add(meet, a.corners(), b.corners());
    REQUIRE(boxes_intersect(a.in_doubles(m.scale), b.in_doubles(m.scale)) == meet);
    REQUIRE(boxes_intersect(b.in_doubles(m.scale), a.in_doubles(m.scale)) == meet);
  });
}

TEST_CASE("exact: box against triangle") {
  run(110, [](Maker& m, Tally& tally, bool degenerate) {
    const exact::Box a = m.box(degenerate, 1.0);
    const Points b = m.snapped(a.corners(), m.points(3), degenerate);
    const bool meet = exact::hulls_meet(a.corners(), b);
    tally.add(meet, a.corners(), b);
    REQUIRE(box_triangle_intersect(a.in_doubles(m.scale), m.triangle(b)) == meet);
  });
}

TEST_CASE("exact: segment against box, point in box") {
  run(120, [](Maker& m, Tally& tally, bool degenerate) {
    const exact::Box a = m.box(degenerate, 1.3);
    const Points b = m.snapped(a.corners(), m.points(2), degenerate);
    const bool meet = exact::hulls_meet(a.corners(), b);
    tally.add(meet, a.corners(), b);
    REQUIRE(segment_box_intersect(m.segment(b), a.in_doubles(m.scale)) == meet);
    REQUIRE(point_in_box(m.segment(b).a, a.in_doubles(m.scale)) ==
            exact::hulls_meet({b[0]}, a.corners()));
  });
}

TEST_CASE("exact: aligned box against triangle and segment") {
  run(130, [](Maker& m, Tally& tally, bool) {
    const Points ends = m.points(2), t = m.points(3);
    Points corners;
    for (int c = 0; c < 8; ++c) {
      corners.push_back({ends[c & 1][0], ends[c >> 1 & 1][1], ends[c >> 2 & 1][2]});
    }
    Aabb box;
    for (const Vec3& p : m.doubles(ends)) box.include(p);
    const bool meet = exact::hulls_meet(corners, t);
    tally.add(meet, corners, t);
    REQUIRE(box_triangle_intersect(box, m.triangle(t)) == meet);
    const Segment s = m.segment(t);
    REQUIRE(segment_box_intersect(s.a, s.b, box) == exact::hulls_meet(corners, {t[0], t[1]}));
  });
}

TEST_CASE("exact: triangle against triangle") {
  run(140, [](Maker& m, Tally& tally, bool degenerate) {
    Points a = m.points(3), b = m.snapped(a, m.points(3), degenerate);
    // Random triangles in a cube meet too rarely: these have a corner near the other's plane.
    if (!degenerate && tally.n % 2) {
      const double s = m.random.uniform(), t = m.random.uniform(0, 1 - s);
      for (size_t k = 0; k < 3; ++k) {
        b[0][k] = a[0][k] + int64_t(s * double(a[1][k] - a[0][k]) + t * double(a[2][k] - a[0][k]));
      }
    }
    const bool meet = exact::hulls_meet(a, b);
    tally.add(meet, a, b);
    const Triangle3 p = m.triangle(a), q = m.triangle(b);
    REQUIRE(triangles_intersect(p, q) == meet);
    REQUIRE(triangles_intersect(q, p) == meet);
    REQUIRE(triangles_intersect({p[1], p[0], p[2]}, {q[2], q[0], q[1]}) == meet);
  });
}

TEST_CASE("exact: segment against triangle, point in triangle") {
  int inside = 0;
  run(150, [&](Maker& m, Tally& tally, bool degenerate) {
    Points b = m.points(3), a = m.snapped(b, m.points(2), degenerate);
    if (!degenerate && tally.n % 5 < 3) {  // towards a point of the triangle
      const double s = m.random.uniform(), t = m.random.uniform(0, 1 - s);
      for (size_t k = 0; k < 3; ++k) {
        const double hit =
            s * double(b[1][k] - b[0][k]) + t * double(b[2][k] - b[0][k]) + double(b[0][k]);
        a[1][k] = int64_t(double(a[0][k]) + m.random.uniform(1, 1.0001) * (hit - double(a[0][k])));
      }
    }
    const bool meet = exact::hulls_meet(a, b);
    tally.add(meet, a, b);
    const Segment s = m.segment(a);
    REQUIRE(segment_triangle_intersect(s.a, s.b, m.triangle(b)) == meet);
    REQUIRE(segment_triangle_intersect(s.b, s.a, m.triangle(b)) == meet);
    const bool held = exact::hulls_meet({a[0]}, b);
    inside += held;
    REQUIRE(point_in_triangle(s.a, m.triangle(b)) == held);
  });
  CHECK((cases(true) < 1000 || inside > cases(true) / 100));
}

TEST_CASE("exact: edge against edge") {
  run(160, [](Maker& m, Tally& tally, bool degenerate) {
    Points a = m.points(2), b = m.snapped(a, m.points(2), degenerate);
    if (!degenerate && tally.n % 2) {  // crossing at a lattice point, or one unit beside it
      const Small d = m.vector(m.half / 8), e = m.vector(m.half / 8), x = m.vector(m.half / 4);
      a = {exact::plus(x, d, -3), exact::plus(x, d, 2)};
      b = {exact::plus(x, e, -1), exact::plus(x, e, 3)};
      if (tally.n % 20 == 1) ++b[0][m.random.below(3)];
    }
    const bool meet = exact::hulls_meet(a, b);
    tally.add(meet, a, b);
    const Segment s = m.segment(a), t = m.segment(b);
    REQUIRE(segments_intersect(s.a, s.b, t.a, t.b) == meet);
    REQUIRE(segments_intersect(t.b, t.a, s.a, s.b) == meet);
  });
}

namespace {

/// Spheres: touching is known from the reference, so it is counted apart.
template <class MakeHull, class Answer>
void run_spheres(uint64_t seed, double radius, const MakeHull& make, const Answer& answer) {
  for (const bool degenerate : {false, true}) {
    Maker m(seed + degenerate);
    int hits = 0, touching = 0;
    const int n = cases(degenerate);
    for (int i = 0; i < n; ++i) {
      m.start(i, degenerate);
      if (degenerate) m.half *= 2;
      auto hull = make(m, degenerate);
      Small centre = m.point();
      int64_t r = degenerate ? m.grain * m.random.below(uint32_t(2 * m.half))
                             : int64_t(radius * m.random.uniform() * double(m.half));
      if (degenerate && i % 2) {  // at a whole distance from a corner, a middle or a corner's side
        static const std::array<std::array<int64_t, 4>, 5> whole{
            {{1, 2, 2, 3}, {2, 3, 6, 7}, {3, 0, 4, 5}, {0, 0, 2, 2}, {4, 4, 7, 9}}};
        const auto& w = whole[m.random.below(5)];
        centre = exact::plus(centre, m.snap(hull.points, {centre}, true));
        for (size_t k = 0; k < 3; ++k) centre[k] += m.grain * (m.random.below(2) ? w[k] : -w[k]);
        r = m.grain * w[3];
      }
      const int sign = exact::distance_sign(centre, r, hull.points);
      hits += sign <= 0;
      touching += sign == 0;
      const Sphere sphere{exact::to_double(centre, m.scale), m.scale * double(r)};
      REQUIRE(answer(m, sphere, hull) == (sign <= 0));
    }
    MESSAGE(n, " cases, ", hits, " meet, ", touching, " touch");
    if (n < 1000) continue;
    CHECK(hits > n * 3 / 10);
    CHECK(hits < n * (degenerate ? 8 : 7) / 10);
    if (degenerate) CHECK(touching > n / 50);
  }
}

struct Hull {
  Points points;
  exact::Box box;
};

}  // namespace

TEST_CASE("exact: sphere against box") {
  run_spheres(
      200, 1.2,
      [](Maker& m, bool degenerate) {
        const exact::Box box = m.box(degenerate, 0.6);
        return Hull{box.corners(), box};
      },
      [](Maker& m, const Sphere& s, const Hull& h) {
        return sphere_box_intersect(s, h.box.in_doubles(m.scale));
      });
}

TEST_CASE("exact: sphere against triangle") {
  run_spheres(
      210, 1.2,
      [](Maker& m, bool) {
        return Hull{m.points(3), {}};
      },
      [](Maker& m, const Sphere& s, const Hull& h) {
        return sphere_triangle_intersect(s.centre, s.radius, m.triangle(h.points));
      });
}

TEST_CASE("exact: segment against sphere") {
  run_spheres(
      220, 1.4,
      [](Maker& m, bool) {
        return Hull{m.points(2), {}};
      },
      [](Maker& m, const Sphere& s, const Hull& h) {
        return segment_sphere_intersect(m.segment(h.points), s);
      });
}

TEST_CASE("exact: sphere against sphere") {
  run_spheres(
      230, 2.0,
      [](Maker& m, bool) {
        return Hull{m.points(1), {}};
      },
      [](Maker& m, const Sphere& s, const Hull& h) {
        const double part = s.radius / m.scale < 3 ? s.radius : m.scale;
        const Sphere other{exact::to_double(h.points[0], m.scale), part};
        return spheres_intersect({s.centre, s.radius - part}, other) &&
               spheres_intersect(other, {s.centre, s.radius - part});
      });
}

TEST_CASE("exact: the ends of the promised range of magnitudes") {
  // Powers of two change no sign: every answer must be that at scale 1.
  Maker m(300);
  for (int i = 0; i < draws::count(3000); ++i) {
    m.start(i, true);
    m.origin = {0, 0, 0};
    m.scale = 1;
    const exact::Box a = m.box(true, 0), b = m.box(true, 0);
    const Points p = m.points(3), q = m.points(3);
    const double r = 1 + m.random.below(4);
    const bool boxes = boxes_intersect(a.in_doubles(1), b.in_doubles(1)),
               box_triangle = box_triangle_intersect(a.in_doubles(1), m.triangle(p)),
               triangles = triangles_intersect(m.triangle(p), m.triangle(q)),
               ball_box = sphere_box_intersect({exact::to_double(p[0], 1), r}, a.in_doubles(1)),
               ball_triangle =
                   sphere_triangle_intersect(exact::to_double(q[0], 1), r, m.triangle(p));
    for (const double scale : {0x1p-195, 0x1p190}) {
      m.scale = scale;
      REQUIRE(boxes_intersect(a.in_doubles(scale), b.in_doubles(scale)) == boxes);
      REQUIRE(box_triangle_intersect(a.in_doubles(scale), m.triangle(p)) == box_triangle);
    }
    for (const double scale : {0x1p-265, 0x1p260}) {
      m.scale = scale;
      REQUIRE(triangles_intersect(m.triangle(p), m.triangle(q)) == triangles);
    }
    for (const double scale : {0x1p-112, 0x1p108}) {
      m.scale = scale;
      const Sphere ball{exact::to_double(p[0], scale), scale * r};
      REQUIRE(sphere_box_intersect(ball, a.in_doubles(scale)) == ball_box);
      REQUIRE(sphere_triangle_intersect(exact::to_double(q[0], scale), scale * r, m.triangle(p)) ==
              ball_triangle);
    }
  }
}
