// References: Couette's flow in closed form; the front of a collapsing column in the experiments of
// Martin and Moyce (1952); the lid-driven cavity of Ghia, Ghia and Shin (1982).
#include "tests/dynamics/fluid_tank.hpp"
#include "tests/support/dense3.hpp"
#include "tests/support/scale.hpp"

#include <algorithm>
#include <cmath>

#include <doctest/doctest.h>

using namespace tumble;
using namespace tumble::test;

TEST_CASE("between a plate that rests and one that moves, velocity grows linearly" *
          doctest::test_suite("long")) {
  FluidTank tank;
  tank.gravity = Vec3::Zero();
  tank.def.viscosity = 200;
  tank.def.wall_friction = 1;
  tank.def.xsph = 0;
  const double width = 0.5, speed = 0.2;
  tank.bodies.resize(2);
  tank.bodies[1].velocity = {speed, 0, 0};
  tank.bodies[1].centre = {0, width + 0.2, 0};
  tank.add_wall({0, -0.2, 0}, {30, 0.2, 3});
  tank.add_wall({0, width + 0.2, 0}, {30, 0.2, 3}, 1);
  tank.fill({-0.6, 0, -0.3}, {0.6, width, 0.3}, 0.05);
  for (int k = 0; k < 60; ++k) REQUIRE(tank.step());
  // A straight line through what is in the middle, far from the free sides.
  Vec3 mean = Vec3::Zero();
  for (const Vec3& x : tank.x) mean += x / double(tank.x.size());
  double n = 0, y = 0, yy = 0, u = 0, yu = 0;
  for (size_t i = 0; i < tank.x.size(); ++i) {
    const Vec3& x = tank.x[i];
    if (std::abs(x[0] - mean[0]) > 0.3 || std::abs(x[2]) > 0.15) continue;
    const double height = x[1] / width, share = tank.v[i][0] / speed;
    CHECK(share == doctest::Approx(height).epsilon(0.04).scale(1));
    n += 1, y += height, yy += height * height, u += share, yu += height * share;
  }
  REQUIRE(n > 100);
  const double slope = (n * yu - y * u) / (n * yy - y * y);
  CHECK(slope == doctest::Approx(1).epsilon(0.02));
  CHECK(u / n + slope * (0.5 - y / n) == doctest::Approx(0.5).epsilon(0.02));
}

namespace {

struct FrontReading {
  double time, place;  ///< t sqrt(2 g / a), and the front over a
};

/// The front of a column of width a and height 2 a that collapses along x: readings at every tick.
/// The front is where all but two in a thousand of the particles end, half a spacing further on:
/// drops that fly ahead are none.
std::vector<FrontReading> collapsing_column(double until) {
  const double a = 0.25, spacing = a / 20;
  FluidTank tank;
  tank.h = 1.0 / 240;
  const double depth = 8 * spacing;
  tank.add_walls({8 * a, 3 * a, depth});
  tank.fill(Vec3::Zero(), {a, 2 * a, depth}, spacing);
  std::vector<FrontReading> out{{0, 1}};
  for (int k = 1; out.back().time < until; ++k) {
    REQUIRE(tank.step());
    CHECK(tank.last.density_error < 0.001);
    std::vector<double> along;
    for (const Vec3& x : tank.x) along.push_back(x[0]);
    std::ranges::sort(along);
    const double front = along[along.size() - along.size() / 500] + 0.5 * spacing;
    out.push_back({k * tank.h * std::sqrt(2 * 9.81 / a), front / a});
  }
  return out;
}

double front_at(const std::vector<FrontReading>& readings, double time) {
  const auto after = std::ranges::lower_bound(readings, time, {}, &FrontReading::time);
  if (after == readings.begin()) return after->place;
  const auto before = after - 1;
  const double t = (time - before->time) / (after->time - before->time);
  return before->place + t * (after->place - before->place);
}

/// Largest deviation from the experiment, over the experiment, if the clock of it began `late`.
double worst_deviation(const std::vector<FrontReading>& found,
                       std::span<const FrontReading> experiment, double late) {
  double worst = 0;
  for (const FrontReading& r : experiment)
    worst = std::max(worst, std::abs(front_at(found, r.time - late) / r.place - 1));
  return worst;
}

}  // namespace

TEST_CASE("the front of a column that collapses is that of Martin and Moyce") {
  // Columns twice as high as wide, of two sizes. The membrane that held the water took some
  // milliseconds to go, and the experiment's clock began before: one delay for each column is
  // found, no longer than a quarter of the unit of time (9 and 13 ms).
  const std::vector<FrontReading> narrow{{0.849, 1.245}, {1.212, 1.443}, {1.602, 1.884},
                                         {2.283, 2.689}, {2.950, 3.728}, {3.598, 4.528}};
  const std::vector<FrontReading> wide{
      {0.832, 1.217}, {1.219, 1.474}, {1.997, 2.292}, {2.547, 2.995}, {3.345, 4.134}};
  const std::vector<FrontReading> found = collapsing_column(test::only_to_run() ? 0.2 : 3.7);
  if (test::only_to_run()) return;
  for (const auto* experiment : {&narrow, &wide}) {
    double best = 1;
    for (double late = 0; late < 0.25; late += 0.01)
      best = std::min(best, worst_deviation(found, *experiment, late));
    CHECK(best < 0.05);
  }
}

namespace {

/// Velocity along the lid on the vertical centre line of a cavity of edge 1 m whose lid moves at 1
/// m/s, at these heights. Walls before and behind, a few layers apart, let fluid slide.
std::vector<double> cavity(double reynolds, int across, double seconds,
                           std::span<const double> heights) {
  const double spacing = 1.0 / across, depth = 3 * spacing;
  FluidTank tank;
  tank.gravity = Vec3::Zero();
  tank.h = 0.01;
  tank.def.viscosity = tank.def.density / reynolds;
  tank.def.wall_friction = 1;
  tank.def.xsph = 0;
  tank.bodies.resize(2);
  tank.bodies[1].velocity = {1, 0, 0};
  tank.add_wall({0.5, -0.2, 0}, {0.9, 0.2, 1});
  for (const double side : {-0.2, 1.2}) tank.add_wall({side, 0.5, 0}, {0.2, 0.5, 1});
  tank.add_wall({0.5, 1.2, 0}, {1000, 0.2, 1}, 1);
  for (const double side : {-0.2, depth + 0.2}) {
    tank.add_wall({0.5, 0.5, side}, {0.5, 0.5, 0.2});
    tank.walls.back().friction = 0;
  }
  tank.fill(Vec3::Zero(), {1, 1, depth}, spacing);
  for (double t = 0; t < seconds; t += tank.h) {
    REQUIRE(tank.step());
    tank.bodies[1].centre = Vec3::Zero();
  }
  // A line through what is about a height: near the lid the profile is steep.
  std::vector<double> out;
  for (const double y : heights) {
    Mat3 squares = Mat3::Zero();
    Vec3 right = Vec3::Zero();
    for (size_t i = 0; i < tank.x.size(); ++i) {
      const Vec3 d = (tank.x[i] - Vec3(0.5, y, 0)) / (2 * spacing);
      const double near = std::max(0.0, 1 - Vec3(d[0], d[1], 0).norm());
      const Vec3 base(1, d[0], d[1]);
      squares += near * base * base.transpose();
      right += near * tank.v[i][0] * base;
    }
    out.push_back(solve(squares, right)[0]);
  }
  return out;
}

}  // namespace

TEST_CASE("the driven cavity has Ghia's profile") {
  const std::vector<double> heights{.0547, .1016, .1719, .2813, .4531, .5,
                                    .6172, .7344, .8516, .9531, .9766};
  const std::vector<double> slow{-.03717, -.06434, -.10150, -.15662, -.21090, -.20581,
                                 -.13641, .00332,  .23151,  .68717,  .84123};
  struct Run {
    int across;      ///< particles along an edge
    double seconds;  ///< until it is steady
    double error;    ///< largest, in lid speeds: it falls with the spacing
  };
  const Run full{75, 14, 0.035}, gate{28, 8, 0.2}, only_started{12, 0.2, 1};
  const Run run = test::all_counts() ? full : test::only_to_run() ? only_started : gate;
  const std::vector<double> found = cavity(100, run.across, run.seconds, heights);
  for (size_t k = 0; k < heights.size(); ++k)
    CHECK(found[k] == doctest::Approx(slow[k]).epsilon(run.error).scale(1));
}
