// What scenes with fluids and grains claim. References: Archimedes' principle, Pascal's law, and
// the run-out of columns of sand (Lube et al. 2004).
#include "engine/world/world.hpp"
#include "tests/scene/shipped_scene.hpp"
#include "tests/support/scale.hpp"

#include <algorithm>
#include <cmath>

#include <doctest/doctest.h>

using namespace tumble;

namespace {

const ParticleSystem& particles_named(const BuiltScene& s, const std::string& name) {
  const auto it = s.particles.find(name);
  REQUIRE(it != s.particles.end());
  return *s.world->particles(it->second);
}

}  // namespace

TEST_CASE(
    "dam_break: all water but a few drops that leap out stays in its tank, cork and wood float, "
    "the stone is below") {
  // The spacing of the scene, 0.05 m, has 2.7 times the particles: only the full tests take that
  // time.
  BuiltScene s =
      test::all_counts() ? shipped("dam_break") : shipped("dam_break", {"parameters.spacing=0.07"});
  run(s, 2.5);
  const ParticleSystem& water = particles_named(s, "water");
  size_t inside = 0;
  std::vector<double> heights;
  for (const Vec3& x : water.x) {
    inside += x.x() > 0 && x.x() < 2.6 && x.y() > 0 && x.z() > 0 && x.z() < 1;
    heights.push_back(x.y());
  }
  CHECK(double(inside) >= 0.998 * double(water.size()));
  std::ranges::sort(heights);
  const double level = heights[heights.size() * 95 / 100];
  CHECK(body(s, "cork").pose.x.y() > level - 0.1);
  CHECK(body(s, "wood").pose.x.y() > level - 0.15);
  CHECK(body(s, "stone").pose.x.y() < 0.2);
}

TEST_CASE("float: the box displaces its weight of water, however it has turned") {
  BuiltScene s = shipped("float");
  run(s, 6);
  // A water level of a tank 0.6 m by 0.6 m that holds the water and half of the box.
  const ParticleSystem& water = particles_named(s, "water");
  double volume = 0;
  for (const double m : water.mass) volume += m / 1000;
  const double level = (volume + 0.004) / 0.36;
  // Half of a cube is below the level wherever its centre is at the level.
  CHECK(std::abs(body(s, "box").pose.x.y() - level) < 0.015);
  CHECK(body(s, "box").v.norm() < 0.1);
}

TEST_CASE(
    "pressure: it grows with depth as Pascal's law says, and the ball floats by Archimedes'") {
  BuiltScene s = shipped("pressure");
  run(s, 4);
  const ParticleSystem& water = particles_named(s, "water");
  double top = 0;
  for (const Vec3& x : water.x) top = std::max(top, x.y());
  // Means over layers; the surface is half a spacing above the uppermost particles.
  for (const double depth : {0.1, 0.2, 0.3, 0.4}) {
    double sum = 0;
    int n = 0;
    for (size_t i = 0; i < water.size(); ++i)
      if (std::abs(top + 0.02 - water.x[i].y() - depth) < 0.03) {
        sum += water.pressure[i];
        ++n;
      }
    REQUIRE(n > 100);
    CHECK(sum / n == doctest::Approx(1000 * 9.81 * depth).epsilon(0.12));
  }
  // Of a ball with 0.4 of the water's density 0.433 of the diameter is in it.
  CHECK(place(s, "ball").y() == doctest::Approx(top + 0.02 + 0.07 - 0.433 * 0.14).epsilon(0.03));
}

TEST_CASE("paddle: the taller column pushes it first, and the water stays in its tank") {
  BuiltScene s = shipped("paddle");
  double most = 0;
  for (int k = 0; k < 30; ++k) {
    run(s, 0.05);
    const Quat& q = body(s, "paddle").pose.q;
    most = std::max(most, 2 * std::atan2(q.z(), q.w()));  // positive: the blade is pushed to +x
  }
  CHECK(most > 0.2);
  CHECK(most < 1.5);
  const ParticleSystem& water = particles_named(s, "water");
  size_t inside = 0;
  for (const Vec3& x : water.x)
    inside += std::abs(x.x()) < 1.2 && x.y() > 0 && std::abs(x.z()) < 0.2;
  CHECK(double(inside) >= 0.98 * double(water.size()));
}

TEST_CASE("water_wheel: the jet turns it, no faster than the water comes in") {
  BuiltScene s = shipped("water_wheel");
  run(s, 3);
  const double turning = -body(s, "wheel").omega.z();
  CHECK(turning > 1);
  const ParticleSystem& water = particles_named(s, "water");
  double fastest = 0;
  for (const Vec3& v : water.v) fastest = std::max(fastest, v.norm());
  CHECK(turning * 0.8 < fastest);
  CHECK(water.size() > 500);
}
