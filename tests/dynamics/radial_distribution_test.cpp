// The radial distribution and the temperature of particles. References: the distances and numbers
// of neighbours in a face-centred cubic lattice (12, 6, 24, 12, 24 at the roots of 1/2, 1, 3/2, 2,
// 5/2 of the edge of its cell), random points (an ideal gas: g = 1), all pairs by two loops, and
// equal parts of energy.
#include "engine/dynamics/particles/radial_distribution.hpp"

#include "engine/core/random.hpp"
#include "engine/dynamics/particles/particle_system.hpp"
#include "engine/dynamics/particles/random_values.hpp"
#include "engine/math/det/det.hpp"
#include "engine/world/particle_measures.hpp"

#include <array>
#include <cmath>
#include <vector>

#include <doctest/doctest.h>

using namespace tumble;

namespace {

std::vector<Vec3> random_points(int count, const Vec3& low, const Vec3& size) {
  Random random(5, 6);
  std::vector<Vec3> out;
  for (int i = 0; i < count; ++i) {
    Vec3 x;
    for (int k = 0; k < 3; ++k) x[k] = low[k] + size[k] * random.uniform();
    out.push_back(x);
  }
  return out;
}

double shell_volume(double range, size_t shells, size_t k) {
  const double a = range * double(k) / double(shells), b = range * double(k + 1) / double(shells);
  return 4.0 / 3 * det::pi * (b * b * b - a * a * a);
}

}  // namespace

TEST_CASE("g(r) of a face-centred lattice: its neighbours, at their distances, and nothing else") {
  constexpr int cells = 5;
  constexpr double edge = 0.4;
  std::vector<Vec3> points;
  for (int i = 0; i < cells; ++i)
    for (int j = 0; j < cells; ++j)
      for (int k = 0; k < cells; ++k)
        for (const Vec3& at :
             {Vec3(0, 0, 0), Vec3(0.5, 0.5, 0), Vec3(0.5, 0, 0.5), Vec3(0, 0.5, 0.5)})
          points.push_back(edge * (Vec3(i, j, k) + at));
  const PeriodicBox box{Vec3::Constant(-0.1), Vec3::Constant(cells * edge)};
  constexpr double range = 0.7;
  constexpr size_t shells = 100;
  const std::vector<double> g = radial_distribution(points, box, range, shells);
  std::vector<double> expected(shells, 0.0);
  const auto n = double(points.size());
  const double density = (n - 1) / box.size.prod();
  for (const auto& [square, count] :
       {std::pair{0.5, 12}, {1.0, 6}, {1.5, 24}, {2.0, 12}, {2.5, 24}, {3.0, 8}}) {
    const double r = edge * std::sqrt(square);
    if (r < range)
      expected[size_t(r / range * shells)] +=
          count / (density * shell_volume(range, shells, size_t(r / range * shells)));
  }
  for (size_t k = 0; k < shells; ++k) CHECK(g[k] == doctest::Approx(expected[k]));
}

TEST_CASE("g(r) of random points is 1, in a box and, relative to their mean, without one") {
  const Vec3 low(-1, 2, 0), size(2, 3, 2.5);
  const std::vector<Vec3> points = random_points(6000, low, size);
  constexpr double range = 0.9;
  constexpr size_t shells = 15;
  const std::vector<double> g = radial_distribution(points, {low, size}, range, shells);
  for (size_t k = 0; k < shells; ++k) {
    const double pairs = 0.5 * 6000 * 5999 / size.prod() * shell_volume(range, shells, k);
    CHECK(std::fabs(g[k] - 1) < 5 / std::sqrt(pairs));
  }
  // Without a box those near the surface have fewer neighbours far away.
  const std::vector<double> open = radial_distribution(points, {}, range, shells);
  double sum = 0, all = 0;
  for (size_t k = 0; k < shells; ++k) {
    sum += open[k] * shell_volume(range, shells, k);
    all += shell_volume(range, shells, k);
    if (k > 4) CHECK(open[k] < open[k - 1] + 0.05);
  }
  CHECK(sum == doctest::Approx(all));
}

TEST_CASE("g(r) counts the pairs that two loops count, also in boxes of few cells and slabs") {
  for (const auto& [size, range] : {std::pair{Vec3(1, 1, 1), 0.5},
                                    {Vec3(0.7, 0, 1.3), 0.35},
                                    {Vec3(0, 0, 0), 0.31},
                                    {Vec3(1, 2, 1), 0.34}}) {
    const PeriodicBox box{Vec3(-0.2, 0.1, 0), size};
    const std::vector<Vec3> points = random_points(300, Vec3::Zero(), Vec3::Constant(1));
    std::vector<double> counts(20, 0.0);
    for (size_t i = 0; i < points.size(); ++i)
      for (size_t j = 0; j < i; ++j) {
        const double r = box.shortest(points[j] - points[i]).norm();
        if (r < range) counts[size_t(r / range * 20)] += 1;
      }
    const std::vector<double> g = radial_distribution(points, box, range, 20);
    double scale = 0, sum = 0;
    for (size_t k = 0; k < 20; ++k) {
      scale += g[k] * shell_volume(range, 20, k);
      sum += counts[k];
    }
    for (size_t k = 0; k < 20; ++k)
      CHECK(g[k] * shell_volume(range, 20, k) / scale == doctest::Approx(counts[k] / sum));
  }
  CHECK(radial_distribution({}, {}, 1, 3) == std::vector<double>(3, 0.0));
}

TEST_CASE("g(r) from some of the points is that from all, to its noise") {
  const Vec3 low(0, 0, 0), size(1, 1.2, 0.9);
  const std::vector<Vec3> points = random_points(4000, low, size);
  constexpr double range = 0.3;
  for (const PeriodicBox& box : {PeriodicBox{low, size}, PeriodicBox{}}) {
    const auto all = radial_distribution(points, box, range, 5);
    const auto some = radial_distribution(points, box, range, 5, 1e6);
    CHECK(some != all);
    for (size_t k = 1; k < 5; ++k) CHECK(some[k] == doctest::Approx(all[k]).epsilon(0.05));
    CHECK(some == radial_distribution(points, box, range, 5, 1e6));
  }
}

TEST_CASE("g(r) has an answer for ranges and places that no cell can be numbered for") {
  const std::vector<Vec3> points = {Vec3(0, 0, 0), Vec3(0.5, 0, 0), Vec3(1e300, 0, 0),
                                    Vec3(0, -1e300, 0)};
  const std::vector<double> none(4, 0.0);
  CHECK(radial_distribution(points, {}, 1e-12, 4) == none);
  CHECK(radial_distribution(points, {Vec3::Zero(), Vec3(2, 2, 2)}, 1e-300, 4) == none);
  const std::vector<double> pair = radial_distribution(points, {}, 1, 4);
  CHECK(pair[2] > 0);  // the two that are half a metre apart
  CHECK(pair[0] + pair[1] + pair[3] == 0);
}

TEST_CASE("the temperature of a system is the mean square of a component, whatever all do") {
  Random random(1, 2);
  ParticleSystemDef def;
  constexpr int count = 20000;
  constexpr double kT = 0.3;
  for (int i = 0; i < count; ++i) {
    ParticleDef p;
    p.mass = i % 2 == 0 ? 2.0 : 0.5;  // equal parts of energy for light and heavy ones
    for (int k = 0; k < 3; ++k) p.v[k] = std::sqrt(kT / p.mass) * standard_normal(random);
    p.v += Vec3(7, -3, 1);
    def.particles.push_back(p);
  }
  const double measured = measure_particles(make_particle_system(def)).temperature;
  // The sum of 3 n squares has a relative spread of the root of 2 / (3 n).
  CHECK(std::fabs(measured / kT - 1) < 4 * std::sqrt(2.0 / (3 * count)));
}
