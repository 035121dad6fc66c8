// Boxes against boxes. References: the separating-axis distance by brute force over all face
// normals and edge cross products, the general way of convex pairs, closed forms of where boxes
// lie.
#include "engine/collision/convex_pairs/convex_convex.hpp"
#include "tests/collision/pair_run.hpp"

using namespace tumble;
using namespace tumble::test;

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
