// Reference: weights, Archimedes' principle, conservation laws, Laplace's law, and closed forms of
// viscous flow.
#include "tests/dynamics/fluid_tank.hpp"
#include "tests/support/scale.hpp"

#include <cmath>
#include <numbers>

#include <doctest/doctest.h>

using namespace tumble;

TEST_CASE("a column of fluid rests on the bottom with its weight, and comes to rest") {
  for (const FluidSolverKind solver : {FluidSolverKind::dfsph, FluidSolverKind::wcsph}) {
    CAPTURE(int(solver));
    FluidTank tank;
    tank.def.solver = solver;
    tank.def.viscosity = 1;
    tank.add_walls({0.4, 1, 0.4});
    tank.fill(Vec3::Zero(), {0.4, 0.4, 0.4}, 0.05);
    double pushed = 0;
    const int ticks = test::only_to_run() ? 4 : 240;
    for (int k = 0; k < ticks; ++k) {
      REQUIRE(tank.step());
      if (k >= ticks / 2) pushed -= tank.solver.pushes()[0].impulse[1];
    }
    if (test::only_to_run()) continue;
    const double mean = pushed / (ticks / 2 * tank.h);
    CHECK(mean == doctest::Approx(tank.weight()).epsilon(0.005));
    CHECK(tank.kinetic_energy() < 1e-3 * tank.weight() * 0.2);
    for (const Vec3& x : tank.x) {
      CHECK(x.minCoeff() > 0);
      CHECK(std::max(x[0], x[2]) < 0.4);
    }
  }
}

TEST_CASE("pressures of kernels of any width converge, and bear the weight") {
  for (const FluidKernelKind kernel : {FluidKernelKind::cubic_spline, FluidKernelKind::wendland})
    for (const double smoothing : {2.0, 3.0, 4.0}) {
      CAPTURE(int(kernel));
      CAPTURE(smoothing);
      FluidTank tank;
      tank.def.kernel = kernel;
      tank.def.smoothing = smoothing;
      tank.def.viscosity = 1;
      tank.add_walls({0.4, 1, 0.4});
      tank.fill(Vec3::Zero(), {0.4, 0.4, 0.4}, 0.05);
      double pushed = 0;
      const int ticks = test::only_to_run() ? 4 : 90;
      for (int k = 0; k < ticks; ++k) {
        REQUIRE(tank.step());
        CHECK(tank.last.density_error <= tank.def.density_error);
        if (k >= ticks / 2) pushed -= tank.solver.pushes()[0].impulse[1];
      }
      if (test::only_to_run()) continue;
      CHECK(pushed / (ticks / 2 * tank.h) == doctest::Approx(tank.weight()).epsilon(0.02));
    }
}

TEST_CASE("what floats does so at its Archimedes depth") {
  // Half as dense as the fluid, and half as wide again as high: a cube would lie on an edge. Four
  // and eight spacings high.
  for (const double spacing : {0.05, 0.025}) {
    if (spacing < 0.05 && !test::all_counts() && !test::only_to_run()) continue;
    CAPTURE(spacing);
    FluidTank tank;
    tank.def.viscosity = 1;
    const Vec3 e{0.15, 0.1, 0.15};
    const double width = 2 * e[0] + 10 * spacing, depth = spacing < 0.05 ? 0.3 : 0.45;
    tank.add_walls({width, 1, width});
    tank.fill(Vec3::Zero(), {width, depth, width}, spacing);
    const uint32_t raft = tank.add_box({width / 2, depth, width / 2}, e, 500);
    tank.carve(0.25 * spacing);
    double pushed = 0, under = 0;
    const int ticks = test::only_to_run() ? 4 : spacing < 0.05 ? 160 : 300, counted = ticks / 2;
    for (int k = 0; k < ticks; ++k) {
      REQUIRE(tank.step());
      if (k < ticks - counted) continue;
      const double bottom = tank.bodies[raft].centre[1] - e[1];
      pushed += tank.solver.pushes()[raft].impulse[1] / counted;
      under += tank.submerged(bottom, 4 * e[0] * e[2], width * width) / (2 * e[1]) / counted;
    }
    if (test::only_to_run()) continue;
    CHECK(pushed / tank.h == doctest::Approx(500 * 8 * e.prod() * 9.81).epsilon(0.02));
    CHECK(under == doctest::Approx(0.5).epsilon(0.01));
  }
}

TEST_CASE("fluid in the cavity of a mesh that moves stays there") {
  // A cube with a cubic cavity of half its side, about the origin.
  auto mesh = std::make_shared<TriangleMesh>();
  for (const double half : {0.4, 0.2})
    for (unsigned k = 0; k < 8; ++k)
      mesh->vertices.emplace_back(k & 4 ? half : -half, k & 2 ? half : -half, k & 1 ? half : -half);
  mesh->triangles = {{0, 1, 3}, {0, 3, 2}, {4, 6, 7}, {4, 7, 5}, {0, 4, 5}, {0, 5, 1},
                     {2, 3, 7}, {2, 7, 6}, {0, 2, 6}, {0, 6, 4}, {1, 5, 7}, {1, 7, 3}};
  for (size_t k = 0; k < 12; ++k) {
    const Triangle t = mesh->triangles[k];
    mesh->triangles.push_back({t[0] + 8, t[2] + 8, t[1] + 8});
  }
  FluidTank tank;
  ShapeDef hollow;
  hollow.type = ShapeType::triangle_mesh;
  hollow.mesh = mesh;
  const uint32_t body = tank.add_body(hollow, Vec3::Zero(), 3000);
  tank.bodies[body].acceleration = Vec3::Zero();
  tank.bodies[body].velocity = {0.5, 0, 0};
  tank.bodies[body].angular_velocity = {0, 3, 0};
  const double s = 0.04;
  tank.fill(Vec3::Constant(-0.16), Vec3::Constant(0.16), s);
  const int ticks = test::only_to_run() ? 4 : 60;
  for (int k = 0; k < ticks; ++k) {
    REQUIRE(tank.step());
    const FluidWall& wall = tank.walls[0];
    for (const Vec3& x : tank.x) CHECK(wall.pose.inverse_point(x).cwiseAbs().maxCoeff() < 0.2 + s);
  }
}

namespace {

ShapeDef submerged_shape(ShapeType type) {
  ShapeDef def;
  def.type = type;
  def.radius = 0.1;
  def.height = 0.2;
  def.half_extents = Vec3::Constant(0.1);
  return def;
}

/// A body 4 spacings wide in the middle of a tank; it stands still where it has no density.
FluidTank tank_with_body(ShapeType type, double density) {
  FluidTank tank;
  tank.add_walls({0.6, 1, 0.6});
  tank.fill(Vec3::Zero(), {0.6, 0.5, 0.6}, 0.05);
  tank.add_body(submerged_shape(type), {0.3, 0.25, 0.3}, density);
  tank.carve(0.0125);
  return tank;
}

}  // namespace

TEST_CASE("fluid at rest pushes a body that stands in it as Archimedes says") {
  struct Case {
    ShapeType type;
    double bound;  // a cylinder's edges are planes to what is beside them
  };
  for (const Case c :
       {Case{ShapeType::box, 0.04}, {ShapeType::cylinder, 0.1}, {ShapeType::sphere, 0.045}}) {
    CAPTURE(int(c.type));
    FluidTank tank = tank_with_body(c.type, 0);
    tank.def.viscosity = 0.1;
    double pushed = 0;
    const int ticks = test::only_to_run() ? 4 : 180;
    for (int k = 0; k < ticks; ++k) {
      REQUIRE(tank.step());
      if (k >= ticks / 3) pushed += tank.solver.pushes()[1].impulse[1];
    }
    if (test::only_to_run()) continue;
    const double weight = 1000 * 9.81 * tank.walls.back().shape->mass_properties().value().mass;
    CHECK(pushed / (2 * ticks / 3 * tank.h) == doctest::Approx(weight).epsilon(c.bound));
  }
}

TEST_CASE("a wall that falls with the fluid bears none of it") {
  // Pressures are none, and so is what walls do to particles by them.
  FluidTank tank;
  tank.fill(Vec3::Zero(), {0.4, 0.3, 0.4}, 0.05);
  const uint32_t plate = tank.add_box({0.2, -0.1, 0.2}, {0.3, 0.1, 0.3}, 2000);
  for (int k = 0; k < 20; ++k) REQUIRE(tank.step());
  CHECK(std::abs(tank.bodies[plate].velocity[1] + 20 * tank.h * 9.81) < 1e-3);
}

TEST_CASE("boxes of .98 and 1.02 of the fluid's density rise and sink" *
          doctest::test_suite("long")) {
  for (const double spacing : {0.05, 0.025})
    for (const double density : {980.0, 1020.0}) {
      CAPTURE(spacing);
      CAPTURE(density);
      FluidTank tank;
      tank.def.viscosity = 0.1;
      const double width = 0.2 + 8 * spacing, depth = spacing < 0.05 ? 0.45 : 0.6;
      const double start = spacing < 0.05 ? 0.225 : 0.25;
      tank.add_walls({width, 1, width});
      tank.fill(Vec3::Zero(), {width, depth, width}, spacing);
      const uint32_t box =
          tank.add_box({width / 2, start, width / 2}, Vec3::Constant(0.1), density);
      tank.carve(0.25 * spacing);
      const int ticks = test::only_to_run() ? 4 : spacing < 0.05 ? 80 : 120;
      for (int k = 0; k < ticks; ++k) REQUIRE(tank.step());
      if (test::only_to_run()) continue;
      const double way = tank.bodies[box].centre[1] - start;
      CHECK((density < 1000 ? way : -way) > 0.3 * spacing);
    }
}

TEST_CASE("what is lighter than the fluid rises in it and what is heavier sinks") {
  for (const ShapeType type : {ShapeType::box, ShapeType::cylinder, ShapeType::sphere})
    for (const double density : {800.0, 1200.0}) {
      CAPTURE(int(type));
      CAPTURE(density);
      FluidTank tank = tank_with_body(type, density);
      const int ticks = test::only_to_run() ? 4 : 60;
      for (int k = 0; k < ticks; ++k) REQUIRE(tank.step());
      if (test::only_to_run()) continue;
      // A tenth of the way that the fluid's weight and as much fluid going along would give: it is
      // seen to flow about the body, whose volume is right to a few percent.
      const double way = tank.bodies[1].centre[1] - 0.25;
      const double free_way = 0.5 * 9.81 * (1000 - density) / (1000 + density);
      CHECK(way / free_way > 0.08);
    }
}

TEST_CASE("fluid and a free body keep their momentum and angular momentum without gravity") {
  FluidTank tank;
  tank.gravity = Vec3::Zero();
  tank.def.viscosity = 0.5;
  tank.def.wall_friction = 1;
  tank.def.surface_tension = 1;
  tank.def.adhesion = 0.5;
  tank.bodies.push_back({});
  tank.fill({-0.3, -0.2, -0.2}, {0, 0.2, 0.2}, 0.05);
  for (Vec3& v : tank.v) v = {1, 0, 0};
  const uint32_t box = tank.add_box({0.16, 0.05, 0}, {0.15, 0.1, 0.1}, 300);
  const Vec3 p = tank.momentum(), l = tank.angular_momentum();
  for (int k = 0; k < 30; ++k) REQUIRE(tank.step());
  CHECK(tank.bodies[box].velocity[0] > 0.1);
  CHECK((tank.momentum() - p).norm() < 1e-9 * p.norm());
  // Viscous forces, the shift and the tick's end turn a little.
  CHECK((tank.angular_momentum() - l).norm() < 0.02 * p.norm() * 0.3);
}

namespace {

/// Fills a tank without weight or viscosity with particles of random velocities, whose pressures
/// are to be found with little error.
void stir(FluidTank& tank) {
  tank.gravity = Vec3::Zero();
  tank.def.viscosity = 0;
  tank.def.xsph = 0;
  tank.def.density_error = 1e-6;
  tank.def.most_iterations = 2000;
  tank.add_walls({0.4, 0.4, 0.4});
  tank.fill(Vec3::Zero(), {0.4, 0.4, 0.4}, 0.05);
  Random r(3);
  for (Vec3& v : tank.v) v = {r.uniform(-1, 1), r.uniform(-1, 1), r.uniform(-1, 1)};
}

}  // namespace

TEST_CASE("pressure takes energy and gives none" * doctest::test_suite("long")) {
  FluidTank tank;
  stir(tank);
  double before = tank.kinetic_energy();
  for (int k = 0; k < 30; ++k) {
    REQUIRE(tank.step());
    const double now = tank.kinetic_energy();
    CHECK(now <= before * (1 + 1e-3));
    CHECK(tank.last.pressure_work == doctest::Approx(now - before).epsilon(1e-9).scale(before));
    before = now;
  }
}

// Of this fluid projected gradients with Nesterov's acceleration took 33 iterations a sub-step.
TEST_CASE("pressures of a stirred fluid are found in few iterations, however small the error") {
  FluidTank tank;
  stir(tank);
  int iterations = 0, sub_steps = 0;
  const int ticks = test::only_to_run() ? 2 : 30;
  for (int k = 0; k < ticks; ++k) {
    REQUIRE(tank.step());
    CHECK(tank.last.density_error <= tank.def.density_error);
    iterations += tank.last.pressure_iterations + tank.last.shift_iterations;
    sub_steps += tank.last.sub_steps;
  }
  if (!test::only_to_run()) CHECK(iterations < 27 * sub_steps);
}

TEST_CASE("the same bits for any number of threads") {
  std::vector<Vec3> first;
  for (const int threads : {1, 2, 4}) {
    Crew crew(threads);
    FluidTank tank;
    tank.crew = &crew;
    tank.def.surface_tension = 0.5;
    tank.def.wall_friction = 0.5;
    tank.add_walls({0.6, 1, 0.3});
    tank.fill(Vec3::Zero(), {0.3, 0.5, 0.3}, 0.03);
    tank.add_box({0.45, 0.1, 0.15}, {0.05, 0.05, 0.05}, 300);
    for (int k = 0; k < 5; ++k) REQUIRE(tank.step());
    if (first.empty()) first = tank.x;
    CHECK(first == tank.x);
  }
}

TEST_CASE("a long drop draws together and keeps its momentum and energy books" *
          doctest::test_suite("long")) {
  FluidTank tank;
  tank.gravity = Vec3::Zero();
  tank.def.surface_tension = 0.072;
  tank.h = 1.0 / 600;
  const double s = 0.001, radius = 0.006;
  tank.bodies.push_back({});
  tank.fill_if(Vec3::Constant(-2 * radius), Vec3::Constant(2 * radius), s, [&](const Vec3& x) {
    const double longer = 1.3, thinner = 1 / std::sqrt(longer);
    return Vec3(x[0] / longer, x[1] / thinner, x[2] / thinner).norm() < radius;
  });
  const auto longness = [&] {
    Vec3 moment = Vec3::Zero();
    for (const Vec3& x : tank.x) moment += x.cwiseProduct(x);
    return moment[0] / (0.5 * (moment[1] + moment[2]));
  };
  const double before = longness();
  for (int k = 0; k < 100; ++k) {
    const double energy = tank.kinetic_energy();
    REQUIRE(tank.step());
    const FluidReport& r = tank.last;
    CHECK(tank.kinetic_energy() - energy ==
          doctest::Approx(r.pressure_work + r.viscous_work + r.tension_work + r.outer_work)
              .epsilon(1e-6)
              .scale(1e-6));
  }
  CHECK(longness() < 1 + 0.7 * (before - 1));
  double all = 0;
  for (size_t i = 0; i < tank.x.size(); ++i) all += tank.mass[i] * tank.v[i].norm();
  CHECK(tank.momentum().norm() < 1e-9 * all);
  for (const Vec3& x : tank.x) CHECK(x.norm() < 1.5 * radius);
}

TEST_CASE("flow between plates has the closed profile" * doctest::test_suite("long")) {
  // Driven by an acceleration along the plates; plates are wide, and flow is looked at in the
  // middle.
  FluidTank tank;
  tank.gravity = {0.1, 0, 0};
  tank.def.viscosity = 200;
  tank.def.wall_friction = 1;
  tank.def.xsph = 0;
  const double width = 0.5, s = 0.05;
  tank.bodies.push_back({});
  tank.add_wall({0, -0.2, 0}, {30, 0.2, 3});
  tank.add_wall({0, width + 0.2, 0}, {30, 0.2, 3});
  tank.fill({-0.6, 0, -0.3}, {0.6, width, 0.3}, s);
  for (int k = 0; k < 60; ++k) REQUIRE(tank.step());
  double middle = 0, n = 0, worst = 0;
  Vec3 mean = Vec3::Zero();
  for (const Vec3& x : tank.x) mean += x / double(tank.x.size());
  const double top = 1000 * 0.1 * width * width / (8 * 200);
  for (size_t i = 0; i < tank.x.size(); ++i) {
    if (std::abs(tank.x[i][0] - mean[0]) > 0.3 || std::abs(tank.x[i][2]) > 0.15) continue;
    const double y = tank.x[i][1] / width, want = 4 * top * y * (1 - y);
    worst = std::max(worst, std::abs(tank.v[i][0] - want));
    if (std::abs(y - 0.5) < 0.1) middle += tank.v[i][0] / want, n += 1;
  }
  REQUIRE(n > 0);
  CHECK(middle / n == doctest::Approx(1).epsilon(0.02));
  CHECK(worst < 0.05 * top);
}

TEST_CASE("bad fluids are refused") {
  FluidDef def;
  CHECK(validate(def));
  def.smoothing = 0;
  CHECK_FALSE(validate(def));
  def = {};
  def.density = -1;
  CHECK_FALSE(validate(def));
  def = {};
  def.viscosity = std::nan("");
  CHECK_FALSE(validate(def));
}
