// References: brute force over all pairs of features in extended precision (80 bits, error below
// 1e-18 of the scale), for the distance; the least width over all normals of faces and pairs of
// edges (the facets of the Minkowski difference) in the same, for the depth; closed forms for
// rounded and curved shapes; V-Clip for large polyhedra.
#include "engine/collision/gjk/epa.hpp"
#include "engine/collision/shapes/convex_hull.hpp"
#include "engine/math/rotation.hpp"
#include "tests/collision/polyhedron_draws.hpp"
#include "tests/collision/polyhedron_reference.hpp"

using namespace tumble;
using namespace tumble::test;

namespace {

/// The vertices of a polyhedron as a core, as flat data or by its support function alone.
class CloudCore final : public ConvexCore {
 public:
  explicit CloudCore(const VoronoiPolyhedron& p, bool flat)
      : vertices_(p.vertices), cloud_(vertices_) {
    double reach = 0;
    for (const Vec3& v : vertices_) reach = std::max(reach, v.norm());
    view_ = flat ? CoreView::of_vertices(cloud_.view(), reach, p.centre)
                 : CoreView::of_reach(reach, p.centre);
  }
  Vec3 support(const Vec3& d) const override {
    const Vec3* best = &vertices_[0];
    for (const Vec3& v : vertices_)
      if (d.dot(v) > d.dot(*best)) best = &v;
    return *best;
  }
  void supporting_face(const Vec3&, SupportingFace& face) const override { face.count = 0; }

 private:
  std::vector<Vec3> vertices_;
  VertexCloud cloud_;
};

PlacedCore place_near(const ConvexCore& core, const Pose& pose, const Vec3& origin) {
  return {core, pose.q, pose.x - origin};
}

struct Tally {
  int apart = 0, overlapping = 0, precise = 0, open = 0;
};

/// One pair in one pose: state, bounds, points, normal, depth; the worst shares of the scale.
void check_gjk(const VoronoiPolyhedron& a, const Pose& pa, const VoronoiPolyhedron& b,
               const Pose& pb, bool flat, Tally& tally) {
  const CloudCore core_a(a, flat), core_b(b, flat);
  const PlacedCore A = place_near(core_a, pa, pa.x), B = place_near(core_b, pb, pa.x);
  const ReferenceDistance exact = ReferencePair(a, pa, b, pb).distance();
  const double scale = pair_scale(a, pa, b, pb), tolerance = 1e-12 * scale;
  const GjkResult g = gjk(A, B);
  tally.precise += g.precise;
  CHECK(g.converged());
  CHECK((g.b - g.a).norm() == doctest::Approx(g.distance).epsilon(1e-9).scale(scale));
  CHECK(double(g.lower_bound - exact.distance) <= 0);
  CHECK(g.distance - g.lower_bound <= tolerance);
  if (g.status == GjkStatus::separated) {
    ++tally.apart;
    CHECK(double(exact.overlap) <= tolerance);
    CHECK(std::abs(double(exact.distance - Real(g.distance))) <= tolerance);
    CHECK(std::abs(g.normal.norm() - 1) < 1e-14);
    return;
  }
  REQUIRE(g.status == GjkStatus::intersecting);
  ++tally.overlapping;
  CHECK((exact.overlap >= 0 || double(exact.distance) <= tolerance));
  const EpaResult e = epa(A, B, g.simplex);
  const double depth = std::max(double(exact.overlap), 0.0);
  tally.open += !e.converged;
  CHECK(e.lower_bound <= depth + tolerance);
  CHECK(e.depth >= depth - tolerance);
  CHECK(e.normal.norm() == doctest::Approx(1));
  // by its support function alone a polyhedron is any core, to a billionth of the depth
  CHECK(e.depth <= depth + tolerance + (flat ? 0 : 1e-9 * depth));
}

}  // namespace

TEST_CASE("GJK and EPA agree with brute force: slivers, near, deep, coincident and lattice poses") {
  Random r(91);
  std::vector<VoronoiPolyhedron> shapes;
  Tally tally;
  const int n = cases(3000);
  for (int i = 0; i < n; ++i) {
    if (i % 1000 == 0) shapes = small_polyhedra(r);
    const auto& [a, b, pa, pb] = draw_pair(r, shapes, i);
    CAPTURE(i);
    check_gjk(a, pa, b, pb, i % 4 != 0, tally);
    check_gjk(b, pb, a, pa, true, tally);
  }
  MESSAGE(tally.apart << " apart, " << tally.overlapping << " overlapping, " << tally.precise
                      << " precise, " << tally.open << " open");
  if (n >= 1000) {
    CHECK(tally.apart > 0.2 * n);
    CHECK(tally.overlapping > 0.2 * n);
    CHECK(tally.precise > 0);
  }
}

TEST_CASE("plates of 0.1 mm and needles a nanometre apart, touching and overlapping by that") {
  Random r(92);
  Tally tally;
  const std::array<VoronoiPolyhedron, 5> thin{
      box_polyhedron({0.5, 0.5, 5e-5}), prism(12, {0.5, 1e-4, 0.5}),
      box_polyhedron({1, 1e-4, 1e-4}), random_polyhedron(r, 10, {1, 1e-4, 1e-4}),
      random_polyhedron(r, 10, {1, 1, 1e-4})};
  for (int i = 0; i < cases(1500); ++i) {
    const auto &a = thin[r.below(5)], &b = thin[r.below(5)];
    Pose pb{Vec3::Zero(), random_rotation(r)};
    // flat on flat, edge on edge, or anyhow; almost parallel
    const VoronoiFace& f = a.faces[r.below(uint32_t(a.faces.size()))];
    const VoronoiFace& g = b.faces[r.below(uint32_t(b.faces.size()))];
    if (i % 3) pb.q = rotation_between(g.normal, -f.normal);
    if (i % 3 == 2) pb.q = axis_angle(random_direction(r), tiny(r)) * pb.q;
    // brought to the gap along a face's normal or across two edges
    Vec3 n = f.normal;
    if (i % 2) {
      const Vec3 u = a.edges[r.below(uint32_t(a.edges.size()))].direction;
      const Vec3 v = pb.direction(b.edges[r.below(uint32_t(b.edges.size()))].direction);
      if (u.cross(v).norm() > 1e-6) n = u.cross(v).normalized();
    }
    double high = -1e300, low = 1e300;
    for (const Vec3& v : a.vertices) high = std::max(high, n.dot(v));
    for (const Vec3& v : b.vertices) low = std::min(low, n.dot(pb.direction(v)));
    constexpr std::array<double, 7> gaps{0, 1e-9, -1e-9, 1e-12, -1e-12, 1e-6, -1e-6};
    pb.x = (high - low + gaps[r.below(7)]) * n;
    const double slide = i % 5 ? 0.3 : 0;
    pb.x += n.unitOrthogonal() * r.uniform(-slide, slide);
    CAPTURE(i);
    check_gjk(a, {}, b, pb, true, tally);
    check_gjk(b, pb, a, {}, true, tally);
  }
}

TEST_CASE("GJK's distance stays under rigid motion, 10 km away, and from any start") {
  Random r(93);
  const auto shapes = small_polyhedra(r);
  for (int i = 0; i < cases(2000); ++i) {
    const VoronoiPolyhedron &a = shapes[r.below(uint32_t(shapes.size()))],
                            &b = shapes[r.below(uint32_t(shapes.size()))];
    const CloudCore core_a(a, true), core_b(b, true);
    const Pose pb = draw_pose(r, i % 2 ? PoseFamily::random : PoseFamily::near, a, b);
    const double scale = pair_scale(a, {}, b, pb);
    const GjkResult here = gjk({core_a, Quat::Identity(), Vec3::Zero()}, {core_b, pb.q, pb.x});
    const Pose moved{random_vec(r, -3, 3), random_rotation(r)}, there = moved * pb;
    const GjkResult turned = gjk({core_a, moved.q, moved.x}, {core_b, there.q, there.x});
    CHECK(std::abs(turned.distance - here.distance) <= 4e-12 * scale);
    // far away the poses count as they are given: the same bits as their difference
    const Vec3 far = 1e4 * random_direction(r);
    const Pose pf{far + pb.x, pb.q};
    const GjkResult away = gjk({core_a, Quat::Identity(), far}, {core_b, pf.q, pf.x});
    const GjkResult near =
        gjk({core_a, Quat::Identity(), Vec3::Zero()}, {core_b, pf.q, pf.x - far});
    CHECK(away.distance == near.distance);
    CHECK(away.normal == near.normal);
    // from the simplex of another pose
    GjkOptions options;
    options.start = &turned.simplex;
    const Pose other{pb.x + 0.1 * random_direction(r), pb.q};
    const GjkResult cold =
        gjk({core_a, Quat::Identity(), Vec3::Zero()}, {core_b, other.q, other.x});
    const GjkResult warm =
        gjk({core_a, Quat::Identity(), Vec3::Zero()}, {core_b, other.q, other.x}, options);
    CHECK(std::abs(warm.distance - cold.distance) <= 2e-12 * scale);
    CHECK(warm.converged());
    options.start = nullptr;
    options.initial_direction = random_direction(r);
    const GjkResult aimed =
        gjk({core_a, Quat::Identity(), Vec3::Zero()}, {core_b, other.q, other.x}, options);
    CHECK(std::abs(aimed.distance - cold.distance) <= 2e-12 * scale);
  }
}

TEST_CASE("GJK agrees with V-Clip to 1e-12 for large polyhedra, whose supports come from a table") {
  Random r(94);
  int tabled = 0;
  for (const Vec3& axes : {Vec3(1, 0.7, 1.3), Vec3(1, 1, 1e-3), Vec3(1, 1e-2, 1e-2)}) {
    const auto a = random_hull(r, 512, axes), b = random_hull(r, 160, {0.8, 1.2, 0.6});
    const auto &pa = static_cast<const ConvexHullShape&>(*a).polyhedron(),
               &pb = static_cast<const ConvexHullShape&>(*b).polyhedron();
    tabled += a->convex()->view().vertices.table != nullptr;
    const VoronoiPolyhedron va = voronoi(pa), vb = voronoi(pb);
    for (int i = 0; i < cases(400); ++i) {
      const Pose p{random_direction(r) * r.uniform(0, 3), random_rotation(r)};
      const GjkResult g =
          gjk({*a->convex(), Quat::Identity(), Vec3::Zero()}, {*b->convex(), p.q, p.x});
      const VClipResult v = v_clip({va, Pose{}}, {vb, p});
      const double scale = pair_scale(va, {}, vb, p);
      CHECK(g.converged());
      CHECK(std::abs(g.distance - v.distance) <= 2e-12 * scale + va.flatness + vb.flatness);
      CHECK(g.distance - g.lower_bound <= 1e-12 * scale);
      // the support function's own answer, by a scan of all
      const Vec3 d = random_direction(r);
      double top = -1e300;
      for (const Vec3& x : pa.vertices) top = std::max(top, d.dot(x));
      CHECK(d.dot(a->convex()->support(d)) >= top - 1e-11);
    }
  }
  CHECK(tabled > 0);
}

TEST_CASE("spheres, capsules and cylinders have the closed form") {
  Random r(95);
  for (int i = 0; i < cases(2000); ++i) {
    const Quat q = random_rotation(r);
    const Vec3 up = q * Vec3::UnitY(), side = q * Vec3::UnitX();
    const double ra = r.uniform(0.1, 1), rb = r.uniform(0.1, 1), ha = r.uniform(0.1, 2),
                 hb = r.uniform(0.1, 2);
    const double gap = i % 2 ? r.uniform(0, 2) : std::pow(10.0, -r.uniform(1, 9));
    const double scale = 2 * (ra + rb + ha + hb) + gap;
    const auto ca = cylinder(ra, ha), cb = cylinder(rb, hb);
    const auto distance = [&](const std::shared_ptr<const Shape>& a, const Quat& qa,
                              const std::shared_ptr<const Shape>& b, const Quat& qb,
                              const Vec3& x) {
      const GjkResult g = gjk({*a->convex(), qa, Vec3::Zero()}, {*b->convex(), qb, x});
      CHECK(g.converged());
      CHECK(g.lower_bound <= g.distance);
      return g.distance - a->convex()->rounding() - b->convex()->rounding();
    };
    const auto close = [&](double found, double exact) {
      CHECK(std::abs(found - exact) <= 1e-9 * scale);
    };
    // cylinders: cap over cap, side by side, and crossed with the lines' nearest points inside
    close(distance(ca, q, cb, q, up * (0.5 * (ha + hb) + gap) + side * r.uniform(0, ra)), gap);
    close(distance(ca, q, cb, q, side * (ra + rb + gap) + up * r.uniform(-0.5, 0.5) * ha), gap);
    const Vec3 across = q * Vec3::UnitZ();
    const Quat turned = axis_angle(side, r.uniform(0.3, 1.5)) * q;
    const Vec3 along = up * r.uniform(-0.2, 0.2) * ha;
    close(distance(ca, q, cb, turned, side * (ra + rb + gap) + along), gap);
    // ball above a cap, beside it, and off its rim
    const auto ball = sphere(rb);
    close(distance(ca, q, ball, q, up * (0.5 * ha + rb + gap) + across * 0.7 * ra), gap);
    close(distance(ca, q, ball, q, side * (ra + rb + gap) + up * 0.4 * ha), gap);
    const double dx = r.uniform(0.01, 1), dy = r.uniform(0.01, 1);
    close(distance(ca, q, ball, q, side * (ra + dx) + up * (0.5 * ha + dy)),
          std::sqrt(dx * dx + dy * dy) - rb);
    // capsules crossed, and a ball off a capsule's end: exact but for rounding
    const auto pa = capsule(ra, ha), pb = capsule(rb, hb);
    const double crossed = distance(pa, q, pb, turned, side * (ra + rb + gap) + along);
    CHECK(std::abs(crossed - gap) <= 1e-13 * scale);
    const double end = distance(pa, q, ball, q, up * (0.5 * ha + ra + rb + gap));
    CHECK(std::abs(end - gap) <= 1e-13 * scale);
  }
}

TEST_CASE("curved shapes meet the bounds of GJK, and seldom need double-double arithmetic") {
  Random r(97);
  const std::vector<std::shared_ptr<const Shape>> shapes = {
      cone(0.5, 1), cone(0.1, 0.2), cylinder(0.3, 0.8), ellipsoid({0.2, 0.5, 0.9}),
      box({0.2, 3, 0.2})};
  const int count = cases(4000);
  int precise = 0;
  for (int i = 0; i < count; ++i) {
    const auto &a = shapes[size_t(i) % shapes.size()], &b = shapes[size_t(i) / 5 % 4];
    const PlacedCore A{*a->convex(), random_rotation(r), Vec3::Zero()};
    PlacedCore B{*b->convex(), random_rotation(r), random_direction(r) * 6};
    // B moved along the normal until a gap of the wanted size is left
    GjkResult g = gjk(A, B);
    B.x -= g.normal * (g.distance - std::pow(10.0, -r.uniform(0.5, 4)));
    g = gjk(A, B);
    REQUIRE(g.status == GjkStatus::separated);
    precise += g.precise;
    const double between = g.normal.dot(B.support(-g.normal)) - g.normal.dot(A.support(g.normal));
    const double apart = (g.b - g.a).norm();
    CHECK(apart - between <= 1e-11);
    CHECK(std::abs(apart - g.distance) <= 1e-11);
  }
  MESSAGE(precise << " of " << count << " precise");
  CHECK(precise * 10 <= count);  // six of ten where no flat simplex was reduced in double precision
}

TEST_CASE("GJK and EPA with hostile input return") {
  const auto a = box({1, 1, 1}), c = cylinder(1, 1);
  const double inf = std::numeric_limits<double>::infinity(), nan = std::nan("");
  for (double bad : {inf, -inf, nan, 1e300, -1e300})
    for (const auto& s : {a, c, hull({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}})}) {
      const PlacedCore A{*a->convex(), Quat::Identity(), Vec3::Zero()},
          B{*s->convex(), Quat::Identity(), {bad, 0, 1}};
      const GjkResult g = gjk(A, B);
      CHECK(g.iterations <= 130);
      CHECK(epa(A, B, g.simplex).iterations <= 300);
      GjkOptions options;
      options.initial_direction = {bad, 1, 0};
      CHECK(gjk(A, {*s->convex(), Quat::Identity(), {3, 0, 0}}, options).iterations <= 130);
    }
  // numbers of vertices that there are not
  GjkResult g = gjk({*a->convex(), Quat::Identity(), Vec3::Zero()},
                    {*a->convex(), Quat::Identity(), {3, 0, 0}});
  for (DifferencePoint& p : g.simplex.points) p.vertex_a = 77, p.vertex_b = no_core_vertex;
  GjkOptions options;
  options.start = &g.simplex;
  CHECK(gjk({*a->convex(), Quat::Identity(), Vec3::Zero()},
            {*a->convex(), Quat::Identity(), {3, 0, 0}}, options)
            .distance == 1);
}
