// References: closed forms (overlap of boxes, beams and a ball with a slab, whose vector area is
// the area of the cut and whose depth along the normal is known), and finite differences of the
// overlap's volume, which for a convex polyhedron and a box is found by a grid of columns
// (120 columns along each axis, about 1 % of the gradient).
#include "engine/collision/mesh_pairs/overlap_regions.hpp"

#include "engine/collision/mesh_pairs/near_triangles.hpp"
#include "engine/collision/narrow_phase.hpp"
#include "engine/geometry/make_mesh.hpp"
#include "tests/collision/support.hpp"

#include <algorithm>

using namespace tumble;
using namespace tumble::test;

namespace {

struct Found {
  OverlapContours contours;
  OverlapRegions regions;
  std::vector<FeatureContact> contacts;
};

Found find(const MeshSurface& a, const Pose& pa, const MeshSurface& b, const Pose& pb) {
  Found f;
  const PlacedSurface A{a, pa.q.toRotationMatrix(), pa.x}, B{b, pb.q.toRotationMatrix(), pb.x};
  std::vector<TriangleIds> pairs;
  near_triangles(A, B, 0, 100000, nullptr, pairs);
  find_contours(A, B, pairs, f.contours);
  if (!f.contours.crossing()) return f;
  find_regions(A, B, f.contours, f.regions);
  for (uint32_t i = 0; i < f.regions.regions.size(); ++i)
    region_contacts(A, B, f.regions, i, f.contacts);
  return f;
}

MeshSurface surface(const TriangleMesh& m) {
  return build_mesh_surface(std::make_shared<const TriangleMesh>(m));
}

Pose at(const Vec3& x, const Quat& q = Quat::Identity()) {
  return {x, q};
}

/// Volume of a ball (centre c, radius r) inside the half-space y <= 0 [m3].
double cap_volume(double height, double r) {
  const double h = std::clamp(r - height, 0.0, 2 * r);
  return det::pi * h * h * (3 * r - h) / 3;
}

}  // namespace

TEST_CASE(
    "beams across each other: way out and depth from a tenth to nine tenths of the thickness") {
  const MeshSurface beam = surface(make_mesh::box({1, 0.1, 0.1}));
  Random r(51);
  for (int i = 1; i <= 9; ++i) {
    const double depth = 0.02 * i;
    const Pose frame = at(random_vec(r, -1, 1), random_rotation(r));
    const Pose pb = at({0.013, 0.2 - depth, 0.021}, axis_angle(Vec3::UnitY(), 1.3));
    const Found f = find(beam, frame, beam, frame * pb);
    REQUIRE(f.regions.regions.size() == 1);
    CHECK(f.contours.sound);
    CHECK(f.regions.sound);
    const OverlapRegion& region = f.regions.regions[0];
    CHECK((region.normal - frame.direction(Vec3::UnitY())).norm() < 1e-9);
    CHECK(region.area.norm() == doctest::Approx(0.04 / det::sin(1.3)).epsilon(1e-9));
    CHECK(region.depth == doctest::Approx(depth).epsilon(1e-9));
    CHECK(f.contacts.size() == 4);
  }
}

TEST_CASE("a box in a slab and a ball in a slab: area of the cut, depth, one region") {
  const MeshSurface slab = surface(make_mesh::box({2, 0.5, 2}));
  const MeshSurface brick = surface(make_mesh::box({0.3, 0.2, 0.25}));
  const MeshSurface ball = surface(make_mesh::icosphere(0.4, 4));
  for (const double depth : {0.001, 0.05, 0.2, 0.35}) {
    const Quat turn = axis_angle(Vec3::UnitY(), 0.7);
    Found f = find(slab, at({0, -0.5, 0}), brick, at({0.1, 0.2 - depth, 0.07}, turn));
    REQUIRE(f.regions.regions.size() == 1);
    CHECK(f.regions.regions[0].depth == doctest::Approx(depth).epsilon(1e-9));
    CHECK(f.regions.regions[0].area.y() == doctest::Approx(0.3).epsilon(1e-9));
    f = find(slab, at({0, -0.5, 0}), ball, at({0.1, 0.4 - depth, 0.07}, turn));
    REQUIRE(f.regions.regions.size() == 1);
    const OverlapRegion& region = f.regions.regions[0];
    CHECK(region.normal.y() > 1 - 1e-9);
    CHECK(region.depth == doctest::Approx(depth).epsilon(0.01));
    // the rate at which the cap's volume grows
    const double rate =
        (cap_volume(0.4 - depth - 1e-5, 0.4) - cap_volume(0.4 - depth + 1e-5, 0.4)) / 2e-5;
    if (depth > 0.01) CHECK(region.area.norm() == doctest::Approx(rate).epsilon(0.02));
  }
}

TEST_CASE("the vector area is the gradient of the overlap's volume") {
  // Two boxes turned at random: the volume of their overlap by a grid of points.
  Random r(52);
  int done = 0;
  for (int i = 0; i < std::max(3, cases(12)); ++i) {
    const Vec3 ha(0.5, 0.4, 0.3), hb(0.3, 0.45, 0.35);
    const MeshSurface a = surface(make_mesh::box(ha)), b = surface(make_mesh::box(hb));
    const Pose pa = at(Vec3::Zero(), random_rotation(r));
    const Pose pb = at(0.5 * random_direction(r), random_rotation(r));
    const Found f = find(a, pa, b, pb);
    if (f.regions.regions.size() != 1) continue;
    ++done;
    // In A's frame: how much of B's box, shifted, is inside A.
    const auto volume = [&](const Vec3& shift) {
      constexpr int n = 120;
      const Pose to_b = pb.inverse() * at(pa.x + shift, pa.q);
      int64_t inside = 0;
      for (int x = 0; x < n; ++x)
        for (int y = 0; y < n; ++y)
          for (int z = 0; z < n; ++z) {
            const Vec3 p((2 * x + 1.0) / n - 1, (2 * y + 1.0) / n - 1, (2 * z + 1.0) / n - 1);
            const Vec3 q = to_b.point(p.cwiseProduct(ha)).cwiseAbs();
            inside += (q.array() <= hb.array()).all();
          }
      return double(inside) * 8 * ha.prod() / (double(n) * n * n);
    };
    const double e = 0.02;
    Vec3 gradient;
    for (int k = 0; k < 3; ++k)
      gradient[k] = (volume(e * Vec3::Unit(k)) - volume(-e * Vec3::Unit(k))) / (2 * e);
    const Vec3 area = f.regions.regions[0].area;
    CHECK((area - gradient).norm() < 0.05 * gradient.norm() + 1e-3);
  }
  CHECK(done >= 2);
}

TEST_CASE("tori deep in each other: the contacts lead apart without a jump of the normal") {
  const auto torus = mesh(make_mesh::torus(0.5, 0.2, 24, 12));
  // Side by side in one plane, outer rims up to nine tenths of a tube's thickness deep.
  Vec3 before = Vec3::UnitX();
  for (int i = 1; i <= 36; ++i) {
    const double depth = 0.01 * i;
    std::vector<Manifold> out;
    collide(*torus, at({0, 0, 0}), *torus, at({1.4 - depth, 0.017, 0.003}), 0.01, out);
    double deepest = 0;
    Vec3 normal = Vec3::Zero();
    for (const Manifold& m : out)
      for (int k = 0; k < m.count; ++k)
        if (-m.points[size_t(k)].gap > deepest)
          deepest = -m.points[size_t(k)].gap, normal = m.normal;
    CAPTURE(depth);
    REQUIRE(deepest > 0);
    CHECK(normal.x() > 0.9);
    CHECK(normal.dot(before) > 0.9);
    CHECK(deepest < depth + 0.01);
    CHECK(deepest > 0.8 * depth - 0.01);
    before = normal;
  }
}

TEST_CASE(
    "what sticks through has no normal, what is inside no contour, what is apart no contact") {
  const MeshSurface plate = surface(make_mesh::box({0.5, 0.01, 0.5})),
                    rod = surface(make_mesh::box({0.02, 0.5, 0.02})),
                    ball = surface(make_mesh::icosphere(0.1, 2)),
                    block = surface(make_mesh::box({0.5, 0.5, 0.5}));
  const Found through = find(plate, at(Vec3::Zero()), rod, at({0.1, 0.03, 0.05}));
  REQUIRE(through.regions.regions.size() == 1);
  CHECK(through.regions.regions[0].normal.isZero(0));
  CHECK(through.contacts.empty());
  CHECK(!find(block, at(Vec3::Zero()), ball, at({0.1, 0.03, 0.05})).contours.crossing());
  CHECK(!find(block, at(Vec3::Zero()), ball, at({0.7, 0.03, 0.05})).contours.crossing());
  // Coincident faces and edges: no contour need close, and nothing may break.
  for (const double y : {0.0, 0.999, 1.0, 1.001}) {
    std::vector<Manifold> out;
    const auto box_mesh = mesh(make_mesh::box({0.5, 0.5, 0.5}));
    collide(*box_mesh, at(Vec3::Zero()), *box_mesh, at({0, y, 0}), 0.01, out);
    for (const Manifold& m : out) CHECK(m.normal.allFinite());
    if (y > 0.9) {
      REQUIRE(!out.empty());
      CHECK(out[0].normal.y() > 0.999);
    }
  }
}
