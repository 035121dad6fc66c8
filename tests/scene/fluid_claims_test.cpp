// What scenes with fluids and grains claim. References: Archimedes' principle, and the run-out of
// columns of sand (Lube et al. 2004).
#include "tests/scene/shipped_scene.hpp"

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
  BuiltScene s = shipped("dam_break");
  run(s, 4);
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
