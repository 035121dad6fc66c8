// Reference: the scalar law summed over all pairs in extended precision, closed forms, and lattice
// sums.
#include "engine/dynamics/forces/pair/pair_sums.hpp"

#include "engine/core/random.hpp"
#include "tests/support/scale.hpp"

#include <algorithm>
#include <cmath>

#include <doctest/doctest.h>
#include <hwy/targets.h>

using namespace tumble;

namespace {

struct Reference {
  std::vector<Vec3> forces;
  double energy = 0, virial = 0;
};

Reference all_pairs(const PairLaw& law, const PairSums::Points& points) {
  const size_t n = points.x.size();
  std::vector<std::array<long double, 3>> f(n);
  long double energy = 0, virial = 0;
  for (size_t a = 0; a < n; ++a)
    for (size_t b = 0; b < n; ++b) {
      for (int i = -1; i <= 1; ++i)
        for (int j = -1; j <= 1; ++j)
          for (int k = -1; k <= 1; ++k) {
            const Vec3 shift(i * points.box.size[0], j * points.box.size[1],
                             k * points.box.size[2]);
            if ((i != 0 && !points.box.along(0)) || (j != 0 && !points.box.along(1)) ||
                (k != 0 && !points.box.along(2)))
              continue;
            if (a == b && i == 0 && j == 0 && k == 0) continue;
            const Vec3 d = points.x[b] + shift - points.x[a];
            const PairLaw::Value v = law.at(d.squaredNorm());
            const long double w = (long double)(points.weights[a]) * points.weights[b];
            for (size_t c = 0; c < 3; ++c) f[a][c] -= w * v.push * d[std::ptrdiff_t(c)];
            energy += w * v.energy / 2;
            virial += w * v.push * d.squaredNorm() / 2;
          }
    }
  Reference out;
  for (const auto& v : f) out.forces.push_back({double(v[0]), double(v[1]), double(v[2])});
  out.energy = double(energy), out.virial = double(virial);
  return out;
}

PairLaw some_law(Random& r, PairLaw::Kind kind, const PairTable& table, bool ends) {
  PairLaw law;
  law.kind = kind;
  law.strength = r.uniform(0.5, 2);
  law.length = r.uniform(0.15, 0.25);
  law.steepness = r.uniform(5, 10);
  law.table = table;
  if (!ends) return law;
  law.cutoff = r.uniform(0.3, 0.6);
  law.truncation = Truncation(r.below(3));
  law.smooth_from = law.cutoff * r.uniform(0.5, 0.95);
  return law;
}

/// No two nearer than a tenth.
std::vector<Vec3> spread_points(Random& r, size_t n, const Vec3& size) {
  std::vector<Vec3> x;
  while (x.size() < n) {
    const Vec3 p(r.uniform() * size[0], r.uniform() * size[1], r.uniform() * size[2]);
    bool free = true;
    for (const Vec3& q : x) free = free && (p - q).norm() > 0.1;
    if (free) x.push_back(p);
  }
  return x;
}

}  // namespace

TEST_CASE("pair potentials: sums over lists and over all are those of all pairs") {
  Random r(3);
  const PairTable table({0.1, 0.2, 0.3, 0.5, 0.7}, {3, -1, -0.5, 0.2, 0});
  for (int n = 0; n < test::scaled_count(60, 8); ++n) {
    const bool ends = n % 3 != 0;
    const PairLaw law = some_law(r, PairLaw::Kind(n % 4), table, ends);
    PairSums::Points points;
    const Vec3 size = Vec3::Constant(1.3);
    const std::vector<Vec3> x = spread_points(r, 40 + r.below(100), size);
    std::vector<double> weights(x.size());
    for (double& w : weights) w = r.uniform(-1, 2);
    points.x = x, points.weights = weights;
    if (ends && n % 2 == 0) points.box.size = size;
    const Reference expected = all_pairs(law, points);
    PairSums sums;
    REQUIRE(sums.sum(law, points, nullptr));
    double scale = 0;
    for (const Vec3& f : expected.forces) scale = std::max(scale, f.norm());
    Vec3 total = Vec3::Zero();
    for (size_t i = 0; i < x.size(); ++i) {
      CHECK((sums.forces()[i] - expected.forces[i]).norm() < 1e-12 * scale);
      total += sums.forces()[i];
    }
    CHECK(total.norm() < 1e-12 * scale * double(x.size()));
    CHECK(sums.energy() == doctest::Approx(expected.energy).epsilon(1e-11));
    CHECK(sums.virial() == doctest::Approx(expected.virial).epsilon(1e-11));
  }
}

TEST_CASE(
    "pair potentials: sums over lists that were kept are those of lists made now, to the bit") {
  Random r(29);
  const PairTable table({0.1, 0.2, 0.3, 0.5, 0.7}, {3, -1, -0.5, 0.2, 0});
  for (int n = 0; n < test::scaled_count(24, 6); ++n) {
    const PairLaw law = some_law(r, PairLaw::Kind(n % 4), table, true);
    const Vec3 size = Vec3::Constant(n % 3 == 0 ? 1.01 * law.cutoff : 1.3);
    std::vector<Vec3> x = spread_points(r, n % 3 == 0 ? 12 : 120, size), v(x.size());
    for (Vec3& p : v) p = 2e-3 * Vec3(r.uniform(-1, 1), r.uniform(-1, 1), r.uniform(-1, 1));
    std::vector<double> weights(x.size());
    for (double& w : weights) w = r.uniform(-1, 2);
    PairSums::Points points{x, weights, {}};
    if (n % 2 == 0) points.box.size = size;
    PairSums kept;
    const size_t steps = 40;
    for (size_t step = 0; step < steps; ++step) {
      // Some are put back into the box, as a world does after its ticks.
      for (size_t i = 0; i < x.size(); ++i) {
        x[i] += v[i];
        if (i % 2 == 0) x[i] = points.box.wrapped(x[i]);
      }
      if (step == 30) std::swap(x.front(), x.back());  // one dies, another is born
      points.x = x;
      REQUIRE(kept.sum(law, points, nullptr));
      PairSums anew;
      REQUIRE(anew.sum(law, points, nullptr));
      REQUIRE(std::ranges::equal(kept.forces(), anew.forces()));
      REQUIRE(kept.energy() == anew.energy());
      REQUIRE(kept.virial() == anew.virial());
      if (step % 13 != 12) continue;
      const Reference expected = all_pairs(law, points);
      double scale = 0;
      for (const Vec3& f : expected.forces) scale = std::max(scale, f.norm());
      for (size_t i = 0; i < x.size(); ++i)
        CHECK((kept.forces()[i] - expected.forces[i]).norm() < 1e-11 * scale);
    }
    if (n % 3 != 0) CHECK(kept.lists_made() < steps);  // of 80 sums; a narrow box leaves no skin
  }
}

TEST_CASE("pair potentials: without a cut-off, a point at the origin is like any other") {
  // Memory is filled up to whole batches: what fills it must not count.
  const std::vector<Vec3> x{Vec3::Zero(), Vec3(0.3, 0, 0), Vec3(0, 0.3, 0)};
  const std::vector<double> ones(3, 1.0);
  const PairLaw law{.strength = 1, .length = 0.2};
  PairSums sums;
  REQUIRE(sums.sum(law, {x, ones, {}}, nullptr));
  const Reference expected = all_pairs(law, {x, ones, {}});
  CHECK((sums.forces()[0] - expected.forces[0]).norm() < 1e-13);
  CHECK(sums.energy() == doctest::Approx(expected.energy).epsilon(1e-13));
}

TEST_CASE("pair potentials: the force is the slope of the energy, also where it ends") {
  Random r(9);
  const PairTable table({0.1, 0.2, 0.3, 0.5, 0.7}, {3, -1, -0.5, 0.2, 0});
  for (int n = 0; n < 400; ++n) {
    const PairLaw law = some_law(r, PairLaw::Kind(n % 4), table, n % 8 < 6);
    const double d = r.uniform(0.12, 0.62), h = 1e-5;
    if (std::abs(d - law.cutoff) < 2 * h) continue;
    const auto energy = [&law](double at) { return law.at(at * at).energy; };
    const double slope = (energy(d + h) - energy(d - h)) / (2 * h);
    CHECK(-law.at(d * d).push * d ==
          doctest::Approx(slope).epsilon(1e-5).scale(std::abs(energy(d)) + 1));
    if (law.ends() && law.truncation != Truncation::truncated)
      CHECK(std::abs(energy(law.cutoff * (1 - 1e-12))) < 1e-9);
  }
}

TEST_CASE("pair potentials: closed forms of single pairs") {
  PairLaw lj{.strength = 2, .length = 0.3};
  const double minimum = 0.3 * std::pow(2, 1.0 / 6);
  CHECK(lj.at(minimum * minimum).energy == doctest::Approx(-2).epsilon(1e-14));
  CHECK(std::abs(lj.at(minimum * minimum).push) < 1e-11);
  CHECK(std::abs(lj.at(0.09).energy) < 1e-14);
  PairLaw coulomb{.kind = PairLaw::Kind::inverse_distance, .strength = 8.9875517923e9, .length = 0};
  // Two charges of a microcoulomb, a metre apart: 8.99 mN.
  CHECK(1e-12 * coulomb.at(1).push == doctest::Approx(8.9875517923e-3).epsilon(1e-14));
  PairLaw morse{.kind = PairLaw::Kind::morse, .strength = 3, .length = 0.2, .steepness = 7};
  CHECK(morse.at(0.04).energy == doctest::Approx(-3).epsilon(1e-14));
  CHECK(std::abs(morse.at(0.04).push) < 1e-12);
  const double h = 1e-4, curvature = (morse.at(std::pow(0.2 + h, 2)).energy + 3) * 2 / (h * h);
  CHECK(curvature == doctest::Approx(2 * 3 * 49).epsilon(2e-3));
}

TEST_CASE("pair potentials: Lennard-Jones crystals have the energies of their lattice sums") {
  // Sums over face-centred cubic and hexagonal close packed lattices of spacing d between nearest
  // neighbours: U/N = 2 (A12 (s/d)^12 - A6 (s/d)^6), A12 = 12.13188, A6 = 14.45392 (fcc), 12.13229,
  // 14.45489 (hcp); Kittel, Introduction to Solid State Physics, ch. 3; their minimum at fcc is
  // -8.61. With a cut-off of `rc` spacings the tail beyond is an integral of known size.
  const int cells = 8;
  const double a = std::sqrt(2.0);  // edge of the cubic cell for d = 1
  std::vector<Vec3> x;
  for (int i = 0; i < cells; ++i)
    for (int j = 0; j < cells; ++j)
      for (int k = 0; k < cells; ++k)
        for (const Vec3& b : {Vec3(0, 0, 0), Vec3(.5, .5, 0), Vec3(.5, 0, .5), Vec3(0, .5, .5)})
          x.push_back(a * (Vec3(i, j, k) + b));
  const std::vector<double> ones(x.size(), 1.0);
  PairSums::Points points{x, ones, {}};
  points.box.size = Vec3::Constant(a * cells);
  const double s = 1 / 1.09;
  PairLaw law{.strength = 1, .length = s, .cutoff = 5.5};
  PairSums sums;
  REQUIRE(sums.sum(law, points, nullptr));
  const double n = double(x.size()), density = std::sqrt(2.0), rc = law.cutoff;
  constexpr double pi = 3.14159265358979323846;
  const double tail =
      2 * pi * density * 4 *
      (std::pow(s, 12) / (9 * std::pow(rc, 9)) - std::pow(s, 6) / (3 * std::pow(rc, 3)));
  const double lattice = 2 * (12.13188 * std::pow(s, 12) - 14.45392 * std::pow(s, 6));
  CHECK(sums.energy() / n + tail == doctest::Approx(lattice).epsilon(2e-4));
  CHECK(lattice == doctest::Approx(-8.61).epsilon(1e-3));
  double greatest = 0;
  for (const Vec3& f : sums.forces()) greatest = std::max(greatest, f.norm());
  CHECK(greatest < 1e-12);
}

TEST_CASE("pair potentials: the same bits for every instruction set and number of threads" *
          doctest::test_suite("long")) {
  Random r(17);
  const PairTable table({0.1, 0.2, 0.3, 0.5, 0.7}, {3, -1, -0.5, 0.2, 0});
  const std::vector<Vec3> x = spread_points(r, 600, Vec3::Constant(1.5));
  std::vector<double> weights(x.size());
  for (double& w : weights) w = r.uniform(-1, 2);
  for (int n = 0; n < 8; ++n) {
    const PairLaw law = some_law(r, PairLaw::Kind(n % 4), table, n < 4);
    std::vector<Vec3> first;
    double energy = 0;
    for (const int64_t target : hwy::SupportedAndGeneratedTargets()) {
      hwy::SetSupportedTargetsForTest(target);
      for (const int threads : {1, 2, 4}) {
        Crew crew(threads);
        PairSums sums;
        REQUIRE(sums.sum(law, {x, weights, {}}, &crew));
        if (first.empty()) {
          first.assign(sums.forces().begin(), sums.forces().end());
          energy = sums.energy();
        }
        bool same = energy == sums.energy();
        for (size_t i = 0; i < x.size(); ++i) same = same && first[i] == sums.forces()[i];
        CHECK_MESSAGE(same, hwy::TargetName(target), " with ", threads, " threads, law ", n);
      }
    }
    hwy::SetSupportedTargetsForTest(0);
  }
}
