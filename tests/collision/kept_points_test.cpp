// Which points carry a manifold, from tick to tick. References: the points of the first call; the
// area that the chosen points span, against that of the hull of all candidates.
#include "engine/collision/manifold_builder.hpp"
#include "engine/collision/narrow_phase.hpp"
#include "engine/math/rotation.hpp"
#include "tests/collision/support.hpp"
#include "tests/support/ring_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <doctest/doctest.h>

using namespace tumble;
using namespace tumble::test;

namespace {

std::vector<uint64_t> features(const Manifold& m) {
  std::vector<uint64_t> out;
  for (int i = 0; i < m.count; ++i) out.push_back(m.points[size_t(i)].feature);
  std::sort(out.begin(), out.end());
  return out;
}

/// Area of the polygon of the points about the normal y, taken by angle about their mean [m2].
double spanned(std::vector<ManifoldPoint> points) {
  Vec3 mean = Vec3::Zero();
  for (const ManifoldPoint& p : points) mean += p.x_world / double(points.size());
  const auto angle = [&](const ManifoldPoint& p) {
    return std::atan2(p.x_world.z() - mean.z(), p.x_world.x() - mean.x());
  };
  std::sort(points.begin(), points.end(),
            [&](const ManifoldPoint& a, const ManifoldPoint& b) { return angle(a) < angle(b); });
  double area = 0;
  for (size_t i = 0; i < points.size(); ++i) {
    const Vec3 p = points[i].x_world - mean;
    const Vec3 q = points[(i + 1) % points.size()].x_world - mean;
    area += 0.5 * std::abs(p.z() * q.x() - p.x() * q.z());
  }
  return area;
}

std::vector<ManifoldPoint> circle(size_t n, double radius) {
  std::vector<ManifoldPoint> out;
  for (size_t i = 0; i < n; ++i) {
    const double a = 2 * std::numbers::pi * double(i) / double(n);
    out.push_back({radius * Vec3(std::cos(a), 0, std::sin(a)), 0, i});
  }
  return out;
}

}  // namespace

TEST_CASE("a ring that trembles on the ground keeps the points that carry it") {
  const auto ground = half_space();
  const auto ring = mesh(ring_mesh(0.25, 0.05, 48, 8));
  Random r(7);
  std::vector<uint64_t> kept;
  size_t changes = 0;
  for (int k = 0; k < 200; ++k) {
    const Vec3 tilt = random_vec(r, -1e-4, 1e-4);
    const Pose pose{{0, 0.05 + r.uniform(-1e-4, 0), 0},
                    Quat(1, tilt.x(), 0, tilt.z()).normalized()};
    std::vector<Manifold> out;
    collide(*ground, Pose{}, *ring, pose, {0.005, nullptr, kept}, out);
    REQUIRE(out.size() == 1);
    REQUIRE(out[0].count == 4);
    const std::vector<uint64_t> now = features(out[0]);
    if (k > 0 && now != kept) ++changes;
    kept = now;
  }
  CHECK(changes == 0);
}

TEST_CASE("kept points give way to points that are clearly better") {
  const std::vector<ManifoldPoint> all = circle(64, 1);
  const double whole = spanned(all);
  for (size_t first = 0; first < 64; ++first) {
    // four neighbours: as bad a choice as there is
    const std::vector<uint64_t> kept{first, (first + 1) % 64, (first + 2) % 64, (first + 3) % 64};
    Manifold m;
    reduce_points(all, Vec3::UnitY(), kept, m);
    REQUIRE(m.count == 4);
    // a square in a circle spans 2 / pi of it
    CHECK(spanned({m.points.begin(), m.points.end()}) > 0.8 * 2 / std::numbers::pi * whole);
  }
}

TEST_CASE("a point that sinks deeper than those kept is taken in") {
  std::vector<ManifoldPoint> all = circle(64, 1);
  Manifold before;
  reduce_points(all, Vec3::UnitY(), {}, before);
  const std::vector<uint64_t> kept = features(before);
  for (size_t i = 0; i < 64; ++i) {
    all[i].gap = -0.01;
    Manifold m;
    reduce_points(all, Vec3::UnitY(), kept, m);
    const std::vector<uint64_t> now = features(m);
    CHECK(std::binary_search(now.begin(), now.end(), i));
    all[i].gap = 0;
  }
}

TEST_CASE("kept features that are gone change nothing") {
  const std::vector<ManifoldPoint> all = circle(64, 1);
  Manifold without, with;
  const std::vector<uint64_t> gone{1000, 1001, 1002, 1003};
  reduce_points(all, Vec3::UnitY(), {}, without);
  reduce_points(all, Vec3::UnitY(), gone, with);
  CHECK(features(without) == features(with));
}
