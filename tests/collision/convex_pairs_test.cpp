// References: closed forms for balls and capsules; for polyhedra the separating-axis distance by
// brute force over all face normals and edge cross products; for every pair the contact's own
// definition (points between the two surfaces, symmetry under exchange).
#include "engine/collision/convex_pairs/capsule_box.hpp"
#include "engine/collision/convex_pairs/convex_convex.hpp"
#include "engine/collision/gjk/gjk.hpp"
#include "engine/collision/narrow_phase.hpp"
#include "engine/collision/shapes/box.hpp"
#include "engine/collision/shapes/convex_hull.hpp"
#include "engine/collision/shapes/convex_shape.hpp"
#include "engine/collision/shapes/polyhedral.hpp"
#include "engine/geometry/constructions/closest_points.hpp"
#include "engine/geometry/make_mesh.hpp"
#include "tests/collision/support.hpp"

#include <limits>

using namespace tumble;
using namespace tumble::test;

namespace {

std::vector<Manifold> run(const Shape& a, const Pose& pa, const Shape& b, const Pose& pb,
                          double margin) {
  std::vector<Manifold> out;
  collide(a, pa, b, pb, margin, out);
  return out;
}

/// Least gap of all points; infinite without contact.
double least_gap(const std::vector<Manifold>& list) {
  double gap = std::numeric_limits<double>::infinity();
  for (const Manifold& m : list)
    for (int i = 0; i < m.count; ++i) gap = std::min(gap, m.points[size_t(i)].gap);
  return gap;
}

/// How far shape s at pose p reaches along unit n.
double reach(const ConvexShape& s, const Pose& p, const Vec3& n) {
  const Vec3 d = p.inverse_direction(n);
  return n.dot(p.x) + d.dot(s.support(d)) + s.rounding();
}

}  // namespace

TEST_CASE("two balls meet as the distance of their centres says") {
  Random r(1);
  int touching = 0;
  const int n = cases(2000);
  for (int i = 0; i < n; ++i) {
    const double ra = r.uniform(0.1, 1), rb = r.uniform(0.1, 1);
    const Pose pa{random_vec(r, -1, 1), random_rotation(r)};
    const Pose pb{random_vec(r, -1, 1), random_rotation(r)};
    const auto list = run(*sphere(ra), pa, *sphere(rb), pb, 0.05);
    const double gap = (pb.x - pa.x).norm() - ra - rb;
    REQUIRE(list.empty() == (gap > 0.05));
    if (list.empty()) continue;
    ++touching;
    CHECK(list[0].points[0].gap == doctest::Approx(gap));
    CHECK((list[0].normal - (pb.x - pa.x).normalized()).norm() < 1e-9);
  }
  if (n >= 100) CHECK((touching > 0.2 * n && touching < 0.8 * n));
}

TEST_CASE("a segment is nearest to a box where samples say, and no way along it leads nearer") {
  // Oblique, along faces and edges, through the box, and of no length.
  Random r(31);
  const int n = cases(4000);
  for (int i = 0; i < n; ++i) {
    CAPTURE(i);
    const Vec3 h = random_vec(r, 0.05, 1);
    Vec3 p0 = random_vec(r, -2, 2), p1 = random_vec(r, -2, 2);
    if (i % 4 == 1) p1[i % 3] = p0[i % 3];
    if (i % 4 == 2) p1 = p0 + r.uniform(-2, 2) * Vec3::Unit(i % 3);
    if (i % 16 == 3) p1 = p0;
    const SegmentBoxDistance found = nearest_segment_box(p0, p1, h);
    const auto away = [&](double t) -> Vec3 {
      const Vec3 p = p0 + t * (p1 - p0);
      return p - p.cwiseMax(-h).cwiseMin(h);
    };
    REQUIRE((found.t >= 0 && found.t <= 1));
    CHECK((found.between - away(found.t)).norm() < 1e-14);
    double least = 1e9;
    for (int k = 0; k <= 400; ++k) least = std::min(least, away(k / 400.0).norm());
    CHECK(found.between.norm() <= least + 1e-14);
    CHECK(found.between.norm() >= least - (p1 - p0).norm() / 800);
    const double slope = (p1 - p0).dot(found.between);
    if (found.t > 0) CHECK(slope <= 1e-13);
    if (found.t < 1) CHECK(slope >= -1e-13);
  }
}

TEST_CASE("capsules meet boxes as any two convex shapes do") {
  Random r(32);
  int touching = 0;
  const int n = cases(4000);
  for (int i = 0; i < n; ++i) {
    CAPTURE(i);
    const auto a = capsule(r.uniform(0.05, 0.4), r.uniform(0.1, 1.5));
    const auto b = box(random_vec(r, 0.1, 1));
    const Pose pb{random_vec(r, -1, 1), random_rotation(r)};
    Pose pa{random_vec(r, -1.6, 1.6), random_rotation(r)};
    if (i % 5 == 0) pa.q = pb.q;  // along an edge
    const double margin = 0.1;
    for (const bool swapped : {false, true}) {
      const Shape &first = swapped ? *b : *a, &second = swapped ? *a : *b;
      const Pose &at_first = swapped ? pb : pa, &at_second = swapped ? pa : pb;
      const auto found = run(first, at_first, second, at_second, margin);
      std::vector<Manifold> reference;
      collide_convex_convex(ShapePair(first, at_first, second, at_second, {margin}), reference);
      REQUIRE(found.empty() == reference.empty());
      if (found.empty()) continue;
      ++touching;
      CHECK(std::abs(least_gap(found) - least_gap(reference)) < 1e-9);
      CHECK((found[0].normal - reference[0].normal).norm() < 1e-6);
    }
  }
  if (n >= 100) CHECK((touching > n / 5 && touching < 2 * n - n / 5));
}

TEST_CASE("boxes that edges part meet as any two convex shapes do") {
  Random r(33);
  int by_edges = 0;
  const int n = cases(20000);
  for (int i = 0; i < n; ++i) {
    CAPTURE(i);
    const double thin = i % 4 == 1 ? 0.02 : 1;  // needles and plates too
    const auto a = box({0.5, thin * 0.4, i % 8 == 1 ? thin * 0.3 : 0.3});
    const auto b = box({r.uniform(0.2, 1), thin * r.uniform(0.2, 1), r.uniform(0.2, 1)});
    const Pose pa{random_vec(r, -1, 1), random_rotation(r)};
    Pose pb{pa.x + r.uniform(0.1, 1.4) * random_direction(r), random_rotation(r)};
    const double turn = std::pow(10, r.uniform(-6, -1));
    if (i % 3 == 0) pb.q = (pa.q * axis_angle(random_direction(r), turn)).normalized();
    std::vector<Manifold> reference;
    const double margin = 0.1;
    collide_convex_convex(ShapePair(*a, pa, *b, pb, {margin}), reference);
    if (reference.empty() || least_gap(reference) <= 1e-6) continue;
    const Vec3 normal = reference[0].normal;
    const Mat3 RA = pa.q.toRotationMatrix(), RB = pb.q.toRotationMatrix();
    const auto along = [&](const Vec3& axis) { return std::abs(axis.dot(normal)) > 1 - 1e-12; };
    bool edges = false;
    for (int k = 0; k < 9; ++k) {
      const Vec3 c = RA.col(k / 3).cross(RB.col(k % 3));
      edges = edges || (c.norm() > 1e-5 && along(c.normalized()));
    }
    // Faces that part the boxes about as far as the edges are taken for them.
    const Vec3 &ha = a->def().half_extents, &hb = b->def().half_extents, d = pb.x - pa.x;
    const Mat3 C = (RA.transpose() * RB).cwiseAbs();
    const Vec3 of_a = (RA.transpose() * d).cwiseAbs() - ha - C * hb;
    const Vec3 of_b = (RB.transpose() * d).cwiseAbs() - hb - C.transpose() * ha;
    const double face = std::max(of_a.maxCoeff(), of_b.maxCoeff());
    const double clear = 0.06 * std::abs(face) + 1e-3;
    if (!edges || least_gap(reference) < face + clear) continue;
    ++by_edges;
    const auto found = run(*a, pa, *b, pb, margin);
    REQUIRE(!found.empty());
    CHECK(std::abs(least_gap(found) - least_gap(reference)) < 1e-9);
    CHECK((found[0].normal - normal).norm() < 1e-6);
  }
  if (n >= 1000) CHECK(by_edges > n / 200);
}

TEST_CASE("boxes agree with brute-force separating axes") {
  Random r(2);
  int deep = 0;
  const int n = cases(3000);
  for (int i = 0; i < n; ++i) {
    const Vec3 ha = random_vec(r, 0.2, 1), hb = random_vec(r, 0.2, 1);
    const auto a = box(ha), b = box(hb);
    const Pose pa{random_vec(r, -0.8, 0.8), random_rotation(r)};
    const Pose pb{random_vec(r, -0.8, 0.8), random_rotation(r)};
    const Mat3 RA = pa.q.toRotationMatrix(), RB = pb.q.toRotationMatrix();
    double depth = std::numeric_limits<double>::infinity();
    const auto axis = [&](Vec3 u) {
      if (u.norm() < 1e-6) return;
      u.normalize();
      for (double s : {-1.0, 1.0}) {
        const Vec3 w = s * u;
        depth = std::min(depth, reach(*a->convex(), pa, w) + reach(*b->convex(), pb, -w));
      }
    };
    for (int k = 0; k < 3; ++k) axis(RA.col(k)), axis(RB.col(k));
    for (int k = 0; k < 9; ++k) axis(RA.col(k / 3).cross(RB.col(k % 3)));
    const auto list = run(*a, pa, *b, pb, 0.0);
    REQUIRE(list.empty() == (depth < 0));
    if (list.empty()) continue;
    ++deep;
    const Manifold& m = list[0];
    // the normal is a real separating direction, at most a little longer than the shortest
    const double along = reach(*a->convex(), pa, m.normal) + reach(*b->convex(), pb, -m.normal);
    CHECK(along <= depth * 1.06 + 1e-3 + 0.05 * (ha.minCoeff() + hb.minCoeff()));
    CHECK(-least_gap(list) <= along + 1e-9);
    CHECK(-least_gap(list) >= 0.5 * along);
  }
  if (n >= 100) CHECK((deep > 0.2 * n && deep < 0.9 * n));
}

TEST_CASE("exchanged boxes meet as deep, up to what counts as a tie") {
  // Turned against each other by 1e-5 rad to 1 rad: on the whole face, on a side, on a corner.
  Random r(77);
  int touching = 0, chosen_otherwise = 0;
  const int n = cases(20000);
  for (int i = 0; i < n; ++i) {
    CAPTURE(i);
    const Vec3 ha = random_vec(r, 0.2, 1.2), hb = random_vec(r, 0.2, 1.2);
    const auto a = box(ha), b = box(hb);
    const Pose pa{random_vec(r, 0, 1), random_rotation(r)};
    const double turn = std::pow(10, -r.uniform(0, 5));
    const Quat tilt = axis_angle(random_vec(r, -1, 1).normalized(), turn);
    const Vec3 away = r.uniform(0.2, 2.2) * random_vec(r, -1, 1).normalized();
    const Pose pb{pa.x + away, (pa.q * tilt).normalized()};
    const auto ab = run(*a, pa, *b, pb, 0.02), ba = run(*b, pb, *a, pa, 0.02);
    REQUIRE(ab.empty() == ba.empty());
    if (ab.empty()) continue;
    ++touching;
    // Of faces that part the boxes alike the first box's is taken: another normal, but as deep.
    const Vec3 m = ab[0].normal, w = -ba[0].normal;
    const auto depth = [&](const Vec3& u) {
      return reach(*a->convex(), pa, u) + reach(*b->convex(), pb, -u);
    };
    CHECK(std::abs(depth(m) - depth(w)) <= 2e-6 * (ha.minCoeff() + hb.minCoeff()));
    if ((m - w).norm() > 1e-9) continue;
    // The deepest point is found up to a share of the extent, then the farthest that is as deep.
    const double extent = 2 * std::min(a->bounding_radius(), b->bounding_radius());
    const double apart = std::abs(least_gap(ab) - least_gap(ba));
    CHECK(apart <= 2e-4 * extent);
    chosen_otherwise += apart > 1e-5;
  }
  if (n >= 10000) {
    CHECK((touching > n / 4 && touching < n - n / 10));
    CHECK((chosen_otherwise > 0 && chosen_otherwise < touching / 100));
  }
}

TEST_CASE("whether edges part boxes does not depend on their size") {
  Random r(23);
  int by_edges = 0, apart = 0;
  const int n = cases(3000);
  for (int i = 0; i < n; ++i) {
    const Vec3 ha = random_vec(r, 0.2, 1), hb = random_vec(r, 0.2, 1);
    const Pose pa{Vec3::Zero(), random_rotation(r)};
    const Pose pb{random_vec(r, -1.2, 1.2), random_rotation(r)};
    double said = 0;
    const auto found = [&](double scale) {
      std::vector<Manifold> out;
      ContactQuery query(0.01 * scale);
      query.apart = &said;
      const Vec3 sa = scale * ha, sb = scale * hb;
      collide(*box(sa), pa, *box(sb), {scale * pb.x, pb.q}, query, out);
      return out;
    };
    const auto before = found(1);
    const double distance = said;
    apart += before.empty();
    by_edges += !before.empty() && before[0].count == 1 && before[0].points[0].gap < 0;
    for (const double scale : {0x1p-17, 0x1p17}) {
      const auto now = found(scale);
      REQUIRE(now.size() == before.size());
      CHECK(said == scale * distance);
      if (now.empty()) continue;
      CHECK(now[0].count == before[0].count);
      if (least_gap(before) > 0) continue;  // of corners and edges that pass each other
      CHECK(now[0].normal == before[0].normal);
      CHECK(least_gap(now) == scale * least_gap(before));
    }
  }
  if (n >= 100) CHECK((by_edges > 0.02 * n && apart > 0.1 * n));
}

/// Two convex shapes at random poses near each other, `n` times.
void check_convex_pair(Random& r, const std::shared_ptr<const Shape>& a,
                       const std::shared_ptr<const Shape>& b, int n) {
  CAPTURE(a->words());
  CAPTURE(b->words());
  const double margin = 0.02;
  int touching = 0;
  for (int i = 0; i < n; ++i) {
    const Pose pa{random_vec(r, -2, 2), random_rotation(r)};
    const Pose pb{pa.x + random_direction(r) * r.uniform(0, 1.6), random_rotation(r)};
    const auto list = run(*a, pa, *b, pb, margin);
    const auto swapped = run(*b, pb, *a, pa, margin);
    REQUIRE(list.size() == swapped.size());
    if (list.empty()) continue;
    ++touching;
    REQUIRE(list.size() == 1);
    const Manifold &m = list[0], &s = swapped[0];
    CHECK(std::abs(m.normal.norm() - 1) < 1e-12);
    const auto curved = [](const Shape& s) {
      return s.convex()->view().kind == CoreView::Kind::general;
    };
    const bool smooth = curved(*a) || curved(*b);
    CHECK(least_gap(list) == doctest::Approx(least_gap(swapped)).epsilon(smooth ? 5e-3 : 1e-6));
    if (a->type() != b->type()) CHECK((m.normal + s.normal).norm() < 1e-6);
    REQUIRE(m.count >= 1);
    // no direction separates by less than the depth that is claimed, but for the tolerance by
    // which faces win over edges
    const double along = -(reach(*a->convex(), pa, m.normal) + reach(*b->convex(), pb, -m.normal));
    CHECK(least_gap(list) >= along - 1e-6);
    for (int k = 0; k < 30; ++k) {
      const Vec3 d = random_direction(r);
      const double other = -(reach(*a->convex(), pa, d) + reach(*b->convex(), pb, -d));
      CHECK(std::min(0.0, other) <=
            std::max(0.0, least_gap(list)) + 1e-9 + (least_gap(list) < 0 ? 0 : margin));
      if (least_gap(list) < 0) CHECK(other <= along * (along < 0 ? 0.94 : 1.0) + 1e-3);
    }
    for (int k = 0; k < m.count; ++k)
      for (int l = 0; l < k; ++l) CHECK(m.points[size_t(k)].feature != m.points[size_t(l)].feature);
  }
  if (n >= 100) CHECK((touching > 0.2 * n && touching <= n));
}

TEST_CASE("every convex pair: exchange, bounds of depth, unit normals, points between surfaces") {
  Random r(3), turned(603);
  const std::vector<std::shared_ptr<const Shape>> shapes{
      sphere(0.5),        capsule(0.3, 0.8),          box({0.3, 0.4, 0.5}),
      cylinder(0.4, 0.7), ellipsoid({0.5, 0.3, 0.2}), random_hull(r, 20, {0.5, 0.6, 0.4})};
  const int n = cases(400);
  for (const auto& a : shapes)
    for (const auto& b : shapes) check_convex_pair(r, a, b, n);
  // Whatever else is listed, with the others and with itself.
  for (const auto& a : every_solid()) {
    if (a->convex()->view().kind != CoreView::Kind::general) continue;
    for (const auto& b : every_solid()) check_convex_pair(turned, a, b, n);
    check_convex_pair(turned, a, shapes.back(), n);
  }
}

/// Whether every contact point is midway between the surfaces: no farther from either shape than
/// half its gap, by the shape's bounds in eight turned frames.
bool points_on_shapes(const std::vector<Manifold>& list, const Shape& s, const Pose& pose) {
  Random turns(11);
  for (int k = 0; k < 8; ++k) {
    const Pose frame{Vec3::Zero(), random_rotation(turns)};
    const Aabb bounds = s.bounds(frame * pose);
    for (const Manifold& m : list)
      for (int i = 0; i < m.count; ++i) {
        const ManifoldPoint& p = m.points[size_t(i)];
        const double slack = 0.51 * std::abs(p.gap) + 1e-3 * s.bounding_radius();
        if (!bounds.inflated(slack).contains(frame.point(p.x_world))) return false;
      }
  }
  return true;
}

TEST_CASE("shapes that just touch do so where they are") {
  Random r(29);
  const std::vector<std::shared_ptr<const Shape>> shapes{sphere(0.2),
                                                         capsule(0.14, 0.3),
                                                         box({0.19, 0.19, 0.19}),
                                                         cylinder(0.17, 0.36),
                                                         cylinder(0.4, 0.01),
                                                         ellipsoid({0.25, 0.15, 0.1}),
                                                         cone(0.2, 0.4),
                                                         cone(0.3, 0.05),
                                                         tapered_capsule(0.2, 0.08, 0.3),
                                                         tapered_capsule(0.05, 0.2, 0.16),
                                                         random_hull(r, 20, {0.5, 0.6, 0.4}),
                                                         random_hull(r, 4, {0.2, 0.2, 0.2})};
  const int n = cases(200);
  for (const auto& a : shapes)
    for (const auto& b : shapes)
      for (int i = 0; i < n; ++i) {
        const Pose pa{random_vec(r, -2, 2), random_rotation(r)};
        Pose pb{pa.x + 3 * random_direction(r), random_rotation(r)};
        const auto apart = run(*a, pa, *b, pb, 5);
        REQUIRE(!apart.empty());
        pb.x -= (least_gap(apart) + std::pow(10.0, r.uniform(-12, -2))) * apart[0].normal;
        const auto list = run(*a, pa, *b, pb, 0.02);
        REQUIRE(!list.empty());
        CHECK(points_on_shapes(list, *a, pa));
        CHECK(points_on_shapes(list, *b, pb));
      }
}

TEST_CASE("meshes that are found apart are at least as far apart as it is said to be") {
  // Reference: the nearest of all pairs of triangles.
  Random r(33);
  const std::vector<std::shared_ptr<const Shape>> shapes{
      box({0.3, 0.4, 0.5}), random_hull(r, 20, {0.4, 0.5, 0.3}),
      mesh(make_mesh::torus(0.5, 0.15, 8, 6)), mesh(make_mesh::torus(0.3, 0.1, 16, 8))};
  const double margin = 0.01;
  int apart = 0, more = 0;
  const auto corners = [](const MeshSurface& s, const Pose& pose, uint32_t t) {
    std::array<Vec3, 3> out;
    for (size_t k = 0; k < 3; ++k) out[k] = pose.point(s.mesh->corner(t, k));
    return out;
  };
  for (const auto& a : shapes)
    for (const auto& b : shapes) {
      if (a->type() != ShapeType::triangle_mesh && b->type() != ShapeType::triangle_mesh) continue;
      for (int i = 0; i < cases(40); ++i) {
        const Pose pa{random_vec(r, -2, 2), random_rotation(r)};
        const Pose pb{pa.x + random_direction(r) * r.uniform(0.4, 1.3), random_rotation(r)};
        std::vector<Manifold> found;
        double said = -1;
        ContactQuery query(margin);
        query.apart = &said;
        collide(*a, pa, *b, pb, query, found);
        if (!found.empty()) continue;
        const MeshSurface &sa = a->polyhedral()->surface(), &sb = b->polyhedral()->surface();
        double distance = std::numeric_limits<double>::infinity();
        for (uint32_t t = 0; t < sa.mesh->triangles.size(); ++t)
          for (uint32_t u = 0; u < sb.mesh->triangles.size(); ++u) {
            const ClosestPair near =
                closest_triangle_triangle(corners(sa, pa, t), corners(sb, pb, u));
            distance = std::min(distance, (near.on_a - near.on_b).norm());
          }
        CHECK(said <= std::max(distance, margin));
        CHECK(said >= margin);
        ++apart;
        more += said > 2 * margin;
      }
    }
  if (cases(40) < 40) return;
  CHECK(apart > 20);
  CHECK(more > 0.5 * apart);
}

TEST_CASE("two rims that cross by 26 micrometres") {
  // the nearest face of the Minkowski difference is a sliver here
  const auto a = cylinder(0x1.5c28f5c28f5c3p-3, 0x1.70a3d70a3d70ap-2), b = a;
  const Pose pa{{-0x1.6161f5f65e6cp+0, 0x1.7b0b4f11e955ep-1, -0x1.cf4c86112e18ap-1},
                Quat(0x1.8171a32cc8e9bp-1, -0x1.a467ee2d2ce35p-3, -0x1.aee1e5f963f7ep-2,
                     0x1.d9c67bc0c81a4p-2)};
  const Pose pb{
      {-0x1.3d580d413f9c5p+0, 0x1.13e9e2ee6819bp+0, -0x1.688db8a6ad07p-1},
      Quat(0x1.679ccfda6401ep-2, 0x1.a5a07658adb2bp-2, 0x1.600f316f70725p-1, 0x1.efaf13248d718p-2)};
  const auto list = run(*a, pa, *b, pb, 0.02);
  REQUIRE(!list.empty());
  CHECK(points_on_shapes(list, *a, pa));
  CHECK(points_on_shapes(list, *b, pb));
}

TEST_CASE("what is found apart is at least as far apart as it is said to be") {
  Random r(19);
  const std::vector<std::shared_ptr<const Shape>> shapes{box({0.3, 0.4, 0.5}),
                                                         box({2, 0.02, 0.4}),
                                                         random_hull(r, 8, {0.4, 0.5, 0.3}),
                                                         sphere(0.4),
                                                         capsule(0.2, 0.6),
                                                         random_hull(r, 60, {0.5, 0.3, 0.4}),
                                                         cylinder(0.3, 0.5),
                                                         ellipsoid({0.2, 0.3, 0.5}),
                                                         cone(0.3, 0.6),
                                                         tapered_capsule(0.3, 0.1, 0.4)};
  const double margin = 0.02;
  int apart = 0, more = 0;
  double share = 0;
  for (const NarrowPhaseEntry& phase : all_narrow_phases())
    for (const auto& a : shapes)
      for (const auto& b : shapes)
        for (int i = 0; i < cases(100); ++i) {
          const Pose pa{random_vec(r, -2, 2), random_rotation(r)};
          const Pose pb{pa.x + random_direction(r) * r.uniform(0.5, 3), random_rotation(r)};
          std::vector<Manifold> found;
          double said = -1;
          ContactQuery query(margin);
          query.apart = &said;
          phase.collide(*a, pa, *b, pb, query, found);
          if (!found.empty()) continue;
          const PlacedCore A(*a->convex(), pa.q, pa.x), B(*b->convex(), pb.q, pb.x);
          const double distance = gjk(A, B).distance - A.core->rounding() - B.core->rounding();
          CHECK(said <= distance);
          CHECK(said >= margin);
          const bool boxes = a->type() == ShapeType::box && b->type() == ShapeType::box;
          if (phase.name != "gjk" || !boxes) continue;
          ++apart;
          more += said > margin;
          share += said / distance;
        }
  CHECK(more > 0.99 * apart);
  CHECK(share > 0.7 * apart);
  // far along an axis the bound is the distance
  double said = 0;
  ContactQuery query(margin);
  query.apart = &said;
  std::vector<Manifold> found;
  const Pose above{{0.1, 0.6 + 0.25, 0.2}, Quat::Identity()};
  collide(*box({0.5, 0.3, 0.5}), {}, *box({0.4, 0.3, 0.4}), above, query, found);
  CHECK(said == doctest::Approx(0.25).epsilon(1e-12));
  collide(*half_space(), {}, *box({0.4, 0.3, 0.4}), above, query, found);
  CHECK(said == doctest::Approx(0.55).epsilon(1e-12));
  CHECK(found.empty());
}

TEST_CASE(
    "hulls of any size: bounds from every vertex, the face most nearly across from all planes") {
  Random r(23);
  for (const int n : {4, 6, 12, 24, 40, 80, 300})
    for (int i = 0; i < cases(20); ++i) {
      const auto shape = random_hull(r, n, {0.4, 0.5, 0.3});
      const ConvexPolyhedron& p = static_cast<const ConvexHullShape&>(*shape).polyhedron();
      const Pose pose{random_vec(r, -3, 3), random_rotation(r)};
      Aabb all;
      for (const Vec3& v : p.vertices) all.include(pose.point(v));
      const Aabb bounds = shape->bounds(pose);
      CHECK((bounds.min - all.min).norm() < 1e-14);
      CHECK((bounds.max - all.max).norm() < 1e-14);

      const Vec3 d = random_direction(r);
      double best = -1;
      for (const Plane& plane : p.planes) best = std::max(best, plane.normal.dot(d));
      SupportingFace face;
      shape->convex()->supporting_face(d, face);
      REQUIRE(face.count >= 3);
      const Vec3 normal =
          (face.points[1] - face.points[0]).cross(face.points[2] - face.points[0]).normalized();
      CHECK(normal.dot(d) == doctest::Approx(best).epsilon(1e-9));
    }
}

TEST_CASE("a box lying on a box has four points at its corners") {
  const auto a = box({1, 0.5, 1}), b = box({0.5, 0.5, 0.5});
  const auto list = run(*a, {}, *b, {{0.2, 0.99, -0.1}, Quat::Identity()}, 0.02);
  REQUIRE(list.size() == 1);
  CHECK((list[0].normal - Vec3::UnitY()).norm() < 1e-12);
  REQUIRE(list[0].count == 4);
  for (int i = 0; i < 4; ++i) CHECK(list[0].points[size_t(i)].gap == doctest::Approx(-0.01));
}

TEST_CASE("crossed bars touch at the four corners of their overlap") {
  const auto bar = box({1, 0.1, 0.1});
  const auto list =
      run(*bar, {}, *bar, {{0, 0.199, 0}, axis_angle(Vec3::UnitY(), det::pi / 2)}, 0.02);
  REQUIRE(list.size() == 1);
  REQUIRE(list[0].count == 4);
  for (int i = 0; i < 4; ++i) {
    const Vec3 x = list[0].points[size_t(i)].x_world;
    CHECK(std::abs(x.x()) == doctest::Approx(0.1));
    CHECK(std::abs(x.z()) == doctest::Approx(0.1));
  }
}

TEST_CASE(
    "crossed bars that have sunk into each other rest on their faces, a little tilted or not") {
  // Where edges cross is a little less deep than the faces are: alone it would let them turn about
  // it, and sink on.
  const auto bar = box({0.5, 0.05, 0.05});
  const Quat across = axis_angle(Vec3::UnitY(), 0.5 * std::numbers::pi);
  for (const double tilt : {0.0, 0.005, 0.01})
    for (const double depth : {0.0002, 0.004}) {
      CAPTURE(tilt);
      CAPTURE(depth);
      const Quat turned = across * axis_angle(Vec3(0.7, 0, 0.7).normalized(), tilt);
      const auto list = run(*bar, {}, *bar, {Vec3(0, 0.1 - depth, 0), turned}, 0.001);
      REQUIRE(list.size() == 1);
      CHECK(list[0].normal.y() > 0.99);
      if (tilt == 0 || depth > 0.001) CHECK(list[0].count >= 2);
    }
}

TEST_CASE("a cylinder stands on its cap and lies on its side") {
  const auto floor = half_space(), slab = box({5, 1, 5}), can = cylinder(0.5, 1);
  for (const auto& ground : {floor, slab}) {
    const Pose below{{0, ground == slab ? -1.0 : 0.0, 0}, Quat::Identity()};
    auto list = run(*ground, below, *can, {{0, 0.499, 0}, Quat::Identity()}, 0.02);
    REQUIRE(list.size() == 1);
    CHECK(list[0].count == 4);
    CHECK((list[0].normal - Vec3::UnitY()).norm() < 1e-9);
    list = run(*ground, below, *can, {{0, 0.499, 0}, axis_angle(Vec3::UnitX(), det::pi / 2)}, 0.02);
    REQUIRE(list.size() == 1);
    CHECK(list[0].count == 2);
    CHECK(least_gap(list) == doctest::Approx(-0.001));
  }
}

TEST_CASE(
    "a cone stands on its base, lies on its side, stands on its tip; a tapered capsule lies") {
  const double lean = det::asin(1 / std::sqrt(10.0));  // of the side, for height 3 radius
  const auto floor = half_space(), slab = box({5, 1, 5}), spike = cone(0.2, 0.6);
  const auto bone = tapered_capsule(0.3, 0.1, 0.5);
  for (const auto& ground : {floor, slab}) {
    const Pose below{{0, ground == slab ? -1.0 : 0.0, 0}, Quat::Identity()};
    const auto on = [&](const Shape& s, double height, double tilt) {
      return run(*ground, below, s, {{0, height, 0}, axis_angle(Vec3::UnitZ(), tilt)}, 0.02);
    };
    auto list = on(*spike, 0.299, 0);
    REQUIRE(list.size() == 1);
    CHECK(list[0].count == 4);
    CHECK(least_gap(list) == doctest::Approx(-0.001));
    // The middle of the axis is half the height from the tip, whose line lies on the ground.
    list = on(*spike, 0.3 / std::sqrt(10.0) - 0.001, det::pi / 2 + lean);
    REQUIRE(list.size() == 1);
    CHECK(list[0].count == 2);
    CHECK(list[0].points[0].gap == doctest::Approx(-0.001));
    CHECK(list[0].points[1].gap == doctest::Approx(-0.001));
    CHECK((list[0].points[0].x_world - list[0].points[1].x_world).norm() ==
          doctest::Approx(0.2 * std::sqrt(10.0)).epsilon(0.01));
    list = on(*spike, 0.299, det::pi);
    REQUIRE(list.size() == 1);
    CHECK(list[0].count == 1);
    CHECK(least_gap(list) == doctest::Approx(-0.001));
    // Both ends of the bone touch where its axis leans by (r0 - r1) / height.
    list = on(*bone, 0.2 - 0.001, det::pi / 2 + det::asin(0.4));
    REQUIRE(list.size() == 1);
    CHECK(list[0].count == 2);
    CHECK(list[0].points[0].gap == doctest::Approx(-0.001));
    CHECK(list[0].points[1].gap == doctest::Approx(-0.001));
  }
}

TEST_CASE("far from the origin contacts keep their digits") {
  const auto a = box({1, 0.5, 1}), b = box({0.5, 0.5, 0.5});
  const Vec3 far(1e5, -3e4, 2e5);
  const auto list =
      run(*a, {far, Quat::Identity()}, *b, {far + Vec3(0.2, 0.99, -0.1), Quat::Identity()}, 0.02);
  REQUIRE(list.size() == 1);
  CHECK(list[0].points[0].gap == doctest::Approx(-0.01).epsilon(1e-6));
}

TEST_CASE("poses that are not finite give no contacts") {
  const auto a = box({1, 1, 1});
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK(run(*a, {}, *a, {{nan, 0, 0}, Quat::Identity()}, 0.1).empty());
  CHECK(run(*a, {}, *sphere(1), {{0, 0, 0}, Quat(nan, 0, 0, 0)}, 0.1).empty());
}

TEST_CASE("coincident shapes have a defined contact") {
  Random r(5);
  std::vector<std::shared_ptr<const Shape>> shapes = every_solid();
  shapes.push_back(random_hull(r, 20, {0.5, 0.6, 0.4}));
  for (const auto& a : shapes)
    for (const auto& b : shapes) {
      const Pose p{{1, 2, 3}, random_rotation(r)};
      const auto list = run(*a, p, *b, p, 0.01);
      REQUIRE(list.size() == 1);
      CHECK(std::abs(list[0].normal.norm() - 1) < 1e-9);
      CHECK(list[0].points[0].x_world.allFinite());
      CHECK(least_gap(list) < -0.1);
    }
}
