// Fluids that are solved together. References: hydrostatic pressure of two layers, flow between
// plates through two layers of other viscosity, conserved momentum, and one fluid that is called
// two.
#include "tests/dynamics/fluid_tank.hpp"
#include "tests/support/scale.hpp"

#include <cmath>

#include <doctest/doctest.h>

using namespace tumble;

namespace {

FluidDef oil(double density) {
  FluidDef def;
  def.density = density;
  return def;
}

/// Mean height of each of two fluids.
std::array<double, 2> heights(const FluidTank& tank) {
  std::array<double, 2> sum{}, n{};
  for (size_t i = 0; i < tank.x.size(); ++i)
    sum[tank.fluid[i]] += tank.x[i][1], n[tank.fluid[i]] += 1;
  return {sum[0] / n[0], sum[1] / n[1]};
}

}  // namespace

TEST_CASE("under a lighter fluid pressure grows by the weight of both") {
  FluidTank tank;
  tank.def.viscosity = 1;
  tank.others = {oil(600)};
  tank.others[0].viscosity = 1;
  const double wide = 0.4, s = 0.05, level = 0.6, between = 0.3;
  tank.add_walls({wide, 1, wide});
  tank.fill(Vec3::Zero(), {wide, level, wide}, s);
  tank.change_if(1, [&](const Vec3& x) { return x[1] > between; });
  double weight = 0;
  for (const double m : tank.mass) weight += 9.81 * m;
  double pushed = 0;
  std::array<double, 2> at{0.15, 0.45}, sum{}, n{};
  const int ticks = test::only_to_run() ? 4 : 180;
  for (int k = 0; k < ticks; ++k) {
    REQUIRE(tank.step());
    if (k < ticks / 2) continue;
    pushed -= tank.solver.pushes()[0].impulse[1] / (ticks / 2 * tank.h);
    for (size_t i = 0; i < tank.x.size(); ++i)
      for (const size_t layer : {0u, 1u})
        if (std::abs(tank.x[i][1] - at[layer]) < s) {
          const double y = tank.x[i][1];
          const double off = 9.81 * (y > between ? 600 * (level - y)
                                                 : 600 * (level - between) + 1000 * (between - y));
          sum[layer] += tank.pressure[i] - off, n[layer] += 1;
        }
  }
  if (test::only_to_run()) return;
  CHECK(pushed == doctest::Approx(weight).epsilon(0.005));
  const double whole = 9.81 * (600 * (level - between) + 1000 * between);
  // One fluid in this tank of eight spacings is off by 4.7 % of the pressure at its foot.
  for (const size_t layer : {0u, 1u}) CHECK(std::abs(sum[layer] / n[layer]) < 0.05 * whole);
  const std::array<double, 2> mean = heights(tank);
  CHECK(mean[0] == doctest::Approx(0.5 * between).epsilon(0.05));
  CHECK(mean[1] == doctest::Approx(0.5 * (level + between)).epsilon(0.05));
}

TEST_CASE("what is lighter comes to lie above, whatever side it begins on") {
  FluidTank tank;
  tank.others = {oil(600)};
  const double wide = 0.6, s = 0.05;
  tank.add_walls({wide, 1, 0.2});
  tank.fill(Vec3::Zero(), {wide, 0.4, 0.2}, s);
  tank.change_if(1, [&](const Vec3& x) { return x[0] > 0.5 * wide; });
  for (int k = 0; k < (test::only_to_run() ? 4 : 180); ++k) REQUIRE(tank.step());
  if (test::only_to_run()) return;
  const std::array<double, 2> mean = heights(tank);
  // Wholly parted they are half of the depth from each other.
  CHECK(mean[1] - mean[0] > 0.15);
}

TEST_CASE("fluids of other density, viscosity and tension keep the momentum of all") {
  FluidTank tank;
  tank.gravity = Vec3::Zero();
  tank.def.viscosity = 0.5, tank.def.surface_tension = 1;
  tank.others = {oil(300), oil(2000)};
  tank.others[0].viscosity = 20, tank.others[0].xsph = 0.2;
  tank.others[1].surface_tension = 3;
  tank.bodies.push_back({});
  tank.fill({-0.3, -0.2, -0.2}, {0.3, 0.2, 0.2}, 0.05);
  tank.change_if(1, [](const Vec3& x) { return x[0] < -0.1; });
  tank.change_if(2, [](const Vec3& x) { return x[0] > 0.1; });
  for (size_t i = 0; i < tank.x.size(); ++i)
    tank.v[i] = {tank.x[i][0] > 0 ? -1.0 : 1.0, 0.3 * tank.x[i][2], 0};
  const Vec3 before = tank.momentum();
  for (int k = 0; k < 20; ++k) {
    const double energy = tank.kinetic_energy();
    REQUIRE(tank.step());
    const FluidReport& r = tank.last;
    CHECK(tank.kinetic_energy() - energy ==
          doctest::Approx(r.pressure_work + r.viscous_work + r.tension_work + r.outer_work)
              .epsilon(1e-6)
              .scale(1e-3));
  }
  CHECK((tank.momentum() - before).norm() < 1e-9 * before.norm());
}

TEST_CASE("through two layers between plates velocity breaks as their viscosities say" *
          doctest::test_suite("long")) {
  // A plate at rest below, one that moves above: the shear stress is the same in both layers.
  FluidTank tank;
  tank.gravity = Vec3::Zero();
  tank.def.viscosity = 400, tank.def.wall_friction = 1, tank.def.xsph = 0;
  tank.others = {tank.def};
  tank.others[0].viscosity = 100;
  const double width = 0.4, speed = 0.2, s = 0.05;
  tank.bodies.resize(2);
  tank.bodies[1].velocity = {speed, 0, 0};
  tank.bodies[1].centre = {0, width + 0.2, 0};
  tank.add_wall({0, -0.2, 0}, {30, 0.2, 3});
  tank.add_wall({0, width + 0.2, 0}, {30, 0.2, 3}, 1);
  tank.fill({-0.5, 0, -0.25}, {0.5, width, 0.25}, s);
  tank.change_if(1, [&](const Vec3& x) { return x[1] > 0.5 * width; });
  for (int k = 0; k < 60; ++k) REQUIRE(tank.step());
  Vec3 mean = Vec3::Zero();
  for (const Vec3& x : tank.x) mean += x / double(tank.x.size());
  // One part of the difference over the lower layer, four over the upper one.
  const auto closed = [&](double y) {
    const double half = 0.5 * width;
    return speed * (y < half ? 0.2 * y / half : 0.2 + 0.8 * (y - half) / half);
  };
  int n = 0;
  for (size_t i = 0; i < tank.x.size(); ++i) {
    const Vec3& x = tank.x[i];
    if (std::abs(x[0] - mean[0]) > 0.25 || std::abs(x[2]) > 0.12) continue;
    CHECK(tank.v[i][0] == doctest::Approx(closed(x[1])).epsilon(0.05).scale(speed));
    ++n;
  }
  CHECK(n > 50);
}

TEST_CASE("one fluid that is called two is one fluid, for any number of threads") {
  std::vector<Vec3> one;
  for (const int threads : {1, 2, 4}) {
    Crew crew(threads);
    FluidTank tank;
    tank.crew = &crew;
    tank.def.wall_friction = 0.5;
    // So small that an iteration more, should rounding decide on one, moves particles by nothing.
    tank.def.density_error = 5e-5;
    tank.add_walls({0.6, 1, 0.3});
    tank.fill(Vec3::Zero(), {0.3, 0.5, 0.3}, 0.05);
    if (threads > 1) {
      tank.others = {tank.def};
      tank.change_if(1, [](const Vec3& x) { return x[1] > 0.2; });
    }
    for (int k = 0; k < 5; ++k) REQUIRE(tank.step());
    if (one.empty()) one = tank.x;
    // What a particle's own pressure opens is summed in another order.
    for (size_t i = 0; i < one.size(); ++i) CHECK((one[i] - tank.x[i]).norm() < 1e-6);
    if (threads == 2) one = tank.x;
    if (threads == 4) CHECK(one == tank.x);
  }
}
