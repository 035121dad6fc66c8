// Reference: integrals by cubature over fine grids, differences of values, and sums term by term.
#include "engine/core/random.hpp"
#include "engine/dynamics/particles/neighbours/neighbour_lists.hpp"
#include "engine/dynamics/sph/fluid_sums.hpp"
#include "engine/dynamics/sph/pressure_sums.hpp"
#include "engine/dynamics/sph/wall_integrals.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include <doctest/doctest.h>
#include <hwy/targets.h>

using namespace tumble;

namespace {

const FluidKernelKind kinds[] = {FluidKernelKind::cubic_spline, FluidKernelKind::wendland};

/// Integral over space of kernel times weight about x, by a grid of n^3 midpoints.
template <class Weight>
double cubature(const SmoothingKernel& kernel, const Vec3& x, int n, const Weight& weight) {
  const double h = 2 * kernel.reach() / n;
  double sum = 0;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      for (int k = 0; k < n; ++k) {
        const Vec3 d = Vec3::Constant(-kernel.reach()) + h * Vec3(i + 0.5, j + 0.5, k + 0.5);
        sum += kernel.value(d.norm()) * weight(Vec3(x + d));
      }
  return sum * h * h * h;
}

}  // namespace

TEST_CASE("a smoothing kernel integrates to one and its slope is its derivative") {
  for (const FluidKernelKind kind : kinds) {
    const SmoothingKernel kernel(kind, 0.3);
    const double shells = 2000;
    double sum = 0;
    for (int k = 0; k < int(shells); ++k) {
      const double r = (k + 0.5) * kernel.reach() / shells;
      sum += 4 * std::numbers::pi * r * r * kernel.value(r) * kernel.reach() / shells;
    }
    double sharpest = 0;
    for (int k = 0; k < int(shells); ++k) {
      const double r = (k + 0.5) * kernel.reach() / shells;
      sharpest = std::max(sharpest, -kernel.slope(r) / r);
    }
    CHECK(kernel.sharpest() == doctest::Approx(sharpest).epsilon(1e-3));
    CHECK(kernel.sharpest() >= sharpest);
    CHECK(sum == doctest::Approx(1).epsilon(1e-6));
    for (double r = 0.01; r < 0.3; r += 0.013) {
      const double difference = (kernel.value(r + 1e-7) - kernel.value(r - 1e-7)) / 2e-7;
      CHECK(kernel.slope(r) == doctest::Approx(difference).epsilon(1e-6).scale(10));
    }
    CHECK(kernel.value(0.3) == 0);
    CHECK(kernel.slope(0.3) == 0);
  }
}

TEST_CASE("the stiffest wave of a lattice is that among waves in all directions") {
  const double spacing = 0.1;
  for (const FluidKernelKind kind : kinds)
    for (const double reach : {0.15, 0.2, 0.3}) {
      const SmoothingKernel kernel(kind, reach);
      std::vector<Vec3> ways, slopes;
      double diagonal = 0;
      for (int n = 0; n < 343; ++n) {
        const Vec3 d = spacing * Vec3(n % 7 - 3, n / 7 % 7 - 3, n / 49 - 3);
        if (n == 171) continue;
        ways.push_back(d);
        slopes.push_back(kernel.slope(d.norm()) * d.normalized());
        diagonal += slopes.back().squaredNorm();
      }
      double stiffest = 0;
      const int waves = 14;
      for (int i = 0; i <= waves; ++i)
        for (int j = 0; j <= i; ++j)
          for (int k = 0; k <= j; ++k) {
            const Vec3 wave = std::numbers::pi / (waves * spacing) * Vec3(i, j, k);
            Vec3 push = Vec3::Zero();
            for (size_t n = 0; n < ways.size(); ++n)
              push += std::sin(wave.dot(ways[n])) * slopes[n];
            stiffest = std::max(stiffest, push.squaredNorm() / diagonal);
          }
      CHECK(stiffest_wave(kernel, spacing) == doctest::Approx(stiffest).epsilon(0.02));
    }
}

TEST_CASE("the kernel's share in a half-space is its integral") {
  for (const FluidKernelKind kind : kinds) {
    const SmoothingKernel kernel(kind, 1);
    for (const double d : {-0.7, -0.2, 0.0, 0.1, 0.45, 0.6, 0.9}) {
      const double whole =
          cubature(kernel, {0, d, 0}, 100, [](const Vec3& p) { return p[1] < 0 ? 1.0 : 0.0; });
      CHECK(kernel.half_space(d) == doctest::Approx(whole).epsilon(0.01).scale(1));
      const double slope = (kernel.half_space(d - 1e-6) - kernel.half_space(d + 1e-6)) / 2e-6;
      CHECK(kernel.plane(d) == doctest::Approx(slope).epsilon(1e-6).scale(1));
    }
  }
}

TEST_CASE("shares of boxes and balls are integrals, and gradients their differences") {
  Random r(7);
  int near_edges = 0;
  for (int n = 0; n < 60; ++n) {
    const SmoothingKernel kernel(kinds[n % 2], 0.5);
    // Thinner and thicker than the kernel.
    const Vec3 e(r.uniform(0.1, 1), r.uniform(0.1, 1), r.uniform(0.1, 1));
    const double radius = r.uniform(0.1, 1);
    const Vec3 x(r.uniform(-1.3, 1.3), r.uniform(-1.3, 1.3), r.uniform(-1.3, 1.3));
    const OwnShare box = box_share(kernel, e, x), ball = ball_share(kernel, radius, x);
    const double in_box = cubature(kernel, x, 48, [&](const Vec3& p) {
      return (p.cwiseAbs().array() < e.array()).all() ? 1.0 : 0.0;
    });
    const double in_ball =
        cubature(kernel, x, 48, [&](const Vec3& p) { return p.norm() < radius ? 1.0 : 0.0; });
    CHECK(std::abs(box.share - in_box) < 0.02);
    CHECK(std::abs(ball.share - in_ball) < 0.01);
    if (box.share > 0.01 && box.share < 0.99) ++near_edges;
    for (int k = 0; k < 3; ++k) {
      const Vec3 step = 1e-3 * Vec3::Unit(k);
      const double of_box =
          (box_share(kernel, e, x + step).share - box_share(kernel, e, x - step).share) / 2e-3;
      const double of_ball = (ball_share(kernel, radius, x + step).share -
                              ball_share(kernel, radius, x - step).share) /
                             2e-3;
      CHECK(std::abs(box.gradient[k] - of_box) < 0.1);
      CHECK(std::abs(ball.gradient[k] - of_ball) < 0.02);
    }
  }
  CHECK(near_edges > 10);
}

TEST_CASE("a lattice of fluid lies at rest half a spacing from a wall") {
  // What a wall gives is what the lattice beyond it would: share, and gradient of the mirror image.
  const double s = 0.05;
  for (const FluidKernelKind kind : kinds) {
    const SmoothingKernel kernel(kind, 2 * s);
    double share = 0, push = 0;
    for (int i = -3; i <= 3; ++i)
      for (int j = -3; j <= 3; ++j)
        for (int k = 1; k <= 3; ++k) {
          const double d = s * std::sqrt(double(i * i + j * j + k * k));
          share += s * s * s * kernel.value(d);
          push += s * s * s * kernel.slope(d) * s * k / d;
        }
    CHECK(mirrored_half_space(kernel, s, 0.5 * s) == doctest::Approx(share).epsilon(0.02));
    CHECK(mirrored_plane(kernel, s, 0.5 * s) == doctest::Approx(-2 * push).epsilon(0.04));
    for (double d = 0.01 * s; d < s; d += 0.07 * s) {
      const double slope =
          (mirrored_half_space(kernel, s, d - 1e-8) - mirrored_half_space(kernel, s, d + 1e-8)) /
          2e-8;
      CHECK(mirrored_plane(kernel, s, d) == doctest::Approx(slope).epsilon(1e-4).scale(1));
    }
  }
}

TEST_CASE("deep in a wall there is nothing but wall, however deep") {
  const double s = 0.05, infinity = std::numeric_limits<double>::infinity();
  for (const FluidKernelKind kind : kinds) {
    const SmoothingKernel kernel(kind, 2 * s);
    for (const double depth : {2 * s, 1.0, 1e20, 1e300, infinity}) {
      CAPTURE(depth);
      CHECK(mirrored_half_space(kernel, s, -depth) == doctest::Approx(1).epsilon(0.02));
      CHECK(std::abs(mirrored_plane(kernel, s, -depth)) < 0.1 / s);
    }
  }
}

TEST_CASE("sums over neighbours are those term by term, for every instruction set") {
  Random r(11);
  std::vector<Vec3> x(300);
  for (Vec3& p : x) p = {r.uniform(), r.uniform(), r.uniform()};
  for (const FluidKernelKind kind : kinds) {
    const SmoothingKernel kernel(kind, 0.25);
    NeighbourLists lists;
    REQUIRE(lists.update(x, {.reach = 0.25, .skin = 0.05, .box = {}, .by_group = true}, nullptr));
    const size_t places = lists.places();
    std::vector<double> volume(places), density(places, 1), p(places), q(places);
    std::vector<SingleVector> volumes(places);
    FluidVectors points, u;
    points.resize(places), u.resize(places);
    // Sums over pairs are of four numbers of the other; what is linear in its place among them.
    FluidVectors push, open, differ;
    push.resize(places), open.resize(places), differ.resize(places);
    for (size_t k = 0; k < places; ++k) {
      if (k < x.size()) {
        volume[k] = r.uniform(0.5, 1), p[k] = r.uniform(), q[k] = r.uniform();
        density[k] = r.uniform(0.5, 2);
      }
      points.set(k, {lists.x()[k], lists.y()[k], lists.z()[k]}, volume[k]);
      volumes[k] = {float(volume[k]), float(volume[k] / density[k]), 0, 0};
      if (k < x.size()) u.set(k, {r.uniform(-1, 1), r.uniform(-1, 1), r.uniform(-1, 1)});
      const Vec3 px = volume[k] * p[k] * points[k], vu = volume[k] * u[k];
      push.set(k, px, volume[k] * p[k]);
      open.set(k, vu, vu.dot(points[k]));
      differ.set(k, vu, volume[k]);
    }
    struct Found {
      std::vector<FluidPairSums> sums;
      std::vector<FluidVector> pushed, opened, plain, slowed, smoothed;
      std::vector<double> numbers() const {
        std::vector<double> all;
        for (const FluidPairSums& s : sums) {
          all.insert(all.end(), {double(s.pairs), s.share, s.gx, s.gy, s.gz, s.slopes, s.squares});
          for (int k = 0; k < 9; ++k)
            all.push_back(s.moment(k / 3, k % 3)), all.push_back(s.square_matrix(k / 3, k % 3));
        }
        for (const auto* of : {&pushed, &opened, &plain, &slowed, &smoothed})
          for (const FluidVector& v : *of) all.insert(all.end(), {v.x, v.y, v.z, v.w});
        return all;
      }
    };
    const auto find = [&] {
      Found to;
      FluidPairs pairs;
      pairs.make_room(lists, kernel, true);
      const size_t groups = pairs.groups(), middle = groups / 3;
      REQUIRE(middle > 0);
      const auto by_parts = [&](auto& sums, const auto& f) {
        sums.resize(x.size());
        f(0, middle, sums.data());
        f(middle, groups, sums.data() + pairs.group(middle).first);
      };
      by_parts(to.sums, [&](size_t first, size_t end, FluidPairSums* sums) {
        find_pairs(kernel, FluidMoments::found, {points.data(), volumes.data()}, pairs, first, end,
                   sums);
      });
      const auto sum = [&](FluidFactor factor, const FluidVectors& y, const double* of,
                           std::vector<FluidVector>& sums) {
        by_parts(sums, [&](size_t first, size_t end, FluidVector* part) {
          sum_pairs(pairs, factor, first, end, y.data(), of, part);
        });
      };
      sum(FluidFactor::slope, push, nullptr, to.pushed);
      sum(FluidFactor::slope, open, nullptr, to.opened);
      sum(FluidFactor::slope, differ, nullptr, to.plain);
      sum(FluidFactor::slope, differ, q.data(), to.slowed);
      sum(FluidFactor::weight, differ, q.data(), to.smoothed);
      return to;
    };
    const Found found = find();
    for (const int64_t target : hwy::SupportedAndGeneratedTargets()) {
      hwy::SetSupportedTargetsForTest(target);
      CHECK(find().numbers() == found.numbers());
    }
    hwy::SetSupportedTargetsForTest(0);
    const auto at = [&](size_t k) { return points[k]; };
    const auto speed = [&](size_t k) { return u[k]; };
    for (size_t i = 0; i < x.size(); ++i) {
      double share = volume[i] * kernel.value(0), squares = 0, rate = 0, slopes = 0;
      double moved = 0;  // sum of the sizes of the rate's terms
      size_t pairs = 0;
      Mat3 moment = Mat3::Zero(), square_matrix = Mat3::Zero();
      Vec3 gradient = Vec3::Zero(), pressed = Vec3::Zero(), viscous = Vec3::Zero(),
           smooth = Vec3::Zero();
      for (size_t j = 0; j < x.size(); ++j) {
        const Vec3 d = at(i) - at(j);
        const double distance = d.norm();
        if (j == i || distance >= kernel.reach()) continue;
        const double f = kernel.slope(distance) / distance, v = volume[j];
        const Vec3 du = speed(i) - speed(j);
        ++pairs;
        slopes += v * f;
        share += v * kernel.value(distance);
        gradient += v * f * d;
        squares += v / density[j] * (f * d).squaredNorm();
        moment -= v * f * d * d.transpose();
        square_matrix += v / density[j] * f * f * d * d.transpose();
        pressed += v * f * (p[i] + p[j]) * d;
        rate += v * f * du.dot(d);
        moved += v * std::abs(f) * du.norm() * distance;
        const double mean = 2 / (1 / q[i] + 1 / q[j]);
        viscous += v * f * mean / q[i] * du;
        smooth -= v * kernel.value(distance) * mean / q[i] * du;
      }
      const auto close = [](const Vec3& a, const Vec3& b, double most) {
        return (a - b).norm() <= most * (1 + b.norm());
      };
      const FluidPairSums& s = found.sums[i];
      const Vec3 g(s.gx, s.gy, s.gz);
      const FluidVector &pushed = found.pushed[i], &opened = found.opened[i];
      const Vec3 a = p[i] * g + pushed.w * at(i) - pushed.vector();
      const double b = speed(i).dot(g) - at(i).dot(opened.vector()) + opened.w;
      const auto apart = [&](const FluidVector& v) { return Vec3(v.w * speed(i) - v.vector()); };
      CHECK(s.pairs == pairs);
      CHECK(s.share == doctest::Approx(share).epsilon(1e-6));
      CHECK(s.squares == doctest::Approx(squares).epsilon(1e-6));
      CHECK(s.slopes == doctest::Approx(slopes).epsilon(1e-6));
      CHECK((s.moment - moment).norm() <= 1e-6 * moment.norm());
      CHECK((s.square_matrix - square_matrix).norm() <= 1e-6 * square_matrix.norm());
      // One factor for all: a pair's is the same for both, and then what they exchange is.
      CHECK(found.plain[i].w == doctest::Approx(s.slopes).epsilon(1e-12));
      CHECK(close(g, gradient, 3e-6));
      CHECK(close(a, pressed, 3e-6));
      CHECK(std::abs(b - rate) <= 1e-6 * moved);
      CHECK(close(apart(found.slowed[i]), viscous, 3e-6));
      CHECK(close(-apart(found.smoothed[i]), smooth, 3e-6));
    }
  }
}

namespace {

/// A cloud of particles far from the origin, and all that sums over its pairs are of.
struct PressureCloud {
  SmoothingKernel kernel;
  NeighbourLists lists;
  FluidPairs pairs;
  std::vector<FluidVector> points;
  std::vector<Mat3> correction;
  std::vector<float> weights;
  std::vector<FlowRow> flows;
  std::vector<PushRow> pushes;
  std::vector<StressRow> stresses;
  std::vector<SymmetricRow<float>> corrections;
  std::vector<SymmetricRow<double>> exact_stresses;

  PressureCloud(FluidKernelKind kind, size_t n) : kernel(kind, 0.25) {
    Random r(5);
    std::vector<Vec3> x(n);
    for (Vec3& p : x) p = Vec3(r.uniform(200, 201), r.uniform(-70, -69), r.uniform(0, 1));
    REQUIRE(lists.update(x, {.reach = kernel.reach(), .skin = 0, .box = {}, .by_group = true},
                         nullptr));
    const auto draw = [&] { return float(r.uniform(-1, 1)); };
    std::vector<SingleVector> volumes;
    for (size_t p = 0; p < lists.places(); ++p) {
      const bool real = p < n;
      const Vec3 at(lists.x()[p], lists.y()[p], lists.z()[p]);
      points.push_back({at[0], at[1], at[2], real ? r.uniform(0.5, 1) : 0.0});
      volumes.push_back({float(points[p].w), 0, 0, 0});
      weights.push_back(real ? float(r.uniform(0, 1)) : 0);
      const double xx = r.uniform(-1, 1), xy = r.uniform(-1, 1), xz = r.uniform(-1, 1),
                   yy = r.uniform(-1, 1), yz = r.uniform(-1, 1), zz = r.uniform(-1, 1);
      correction.push_back(Mat3{xx, xy, xz, xy, yy, yz, xz, yz, zz});
      const FluidPlace place = FluidPlace::of(at / kernel.reach());
      flows.push_back(
          {place, {0, 0}, real ? SingleVector{draw(), draw(), draw(), 0} : SingleVector{}});
      pushes.push_back({place, weights[p], 0});
      corrections.push_back(SymmetricRow<float>::of(correction[p]));
      stresses.push_back({place});
      stresses[p].set(corrections[p].times(weights[p]));
      exact_stresses.push_back(SymmetricRow<double>::of(correction[p]).times(double(weights[p])));
    }
    pairs.make_room(lists, kernel, false);
    std::vector<FluidPairSums> sums(n);
    find_pairs(kernel, FluidMoments::left_out, {points.data(), volumes.data()}, pairs, 0,
               pairs.groups(), sums.data());
  }
  static Vec3 vector(const SingleVector& v) { return {double(v.x), double(v.y), double(v.z)}; }
  /// f(other, slope in slope units, way from it in reaches) for what is in reach of p.
  template <class F>
  void each_in_reach(size_t p, const F& f) const {
    for (size_t q = 0; q < lists.size(); ++q) {
      const Vec3 d = points[p].vector() - points[q].vector();
      const double r = d.norm(), reach = kernel.reach();
      if (q == p || r >= reach) continue;
      f(q, kernel.slope(r) / r / pairs.slope_unit(), Vec3(d / reach));
    }
  }
};

/// What sums over pairs make of a cloud.
struct PressureResults {
  std::vector<float> plain_opened, opened;
  std::vector<SingleVector> plain_pushed, pushed;
  std::vector<FluidVector> exact;

  explicit PressureResults(const PressureCloud& cloud) {
    const size_t groups = cloud.pairs.groups(), middle = groups / 3;
    const auto by_parts = [&](auto& sums, const auto& f) {
      sums.resize(cloud.lists.size());
      f(0, middle, sums.data());
      f(middle, groups, sums.data() + cloud.pairs.group(middle).first);
    };
    for (const bool corrected : {false, true})
      by_parts(corrected ? opened : plain_opened, [&](size_t first, size_t end, float* sums) {
        open_groups(cloud.pairs, first, end, cloud.flows.data(),
                    corrected ? cloud.corrections.data() : nullptr, sums);
      });
    by_parts(plain_pushed, [&](size_t first, size_t end, SingleVector* sums) {
      push_groups(cloud.pairs, first, end, cloud.pushes.data(), sums);
    });
    by_parts(pushed, [&](size_t first, size_t end, SingleVector* sums) {
      push_groups(cloud.pairs, first, end, cloud.stresses.data(), sums);
    });
    by_parts(exact, [&](size_t first, size_t end, FluidVector* sums) {
      push_exactly(cloud.pairs, first, end, cloud.points.data(), cloud.exact_stresses.data(), sums);
    });
  }
  std::vector<double> numbers() const {
    std::vector<double> all(plain_opened.begin(), plain_opened.end());
    all.insert(all.end(), opened.begin(), opened.end());
    for (const auto* of : {&plain_pushed, &pushed})
      for (const SingleVector& v : *of)
        all.insert(all.end(), {double(v.x), double(v.y), double(v.z)});
    for (const FluidVector& v : exact) all.insert(all.end(), {v.x, v.y, v.z});
    return all;
  }
};

}  // namespace

TEST_CASE(
    "sums of the iterations for pressures are those pair by pair, for every instruction set") {
  for (const FluidKernelKind kind : kinds) {
    const PressureCloud cloud(kind, 1500);
    const PressureResults found(cloud);
    for (const int64_t target : hwy::SupportedAndGeneratedTargets()) {
      hwy::SetSupportedTargetsForTest(target);
      CHECK(PressureResults(cloud).numbers() == found.numbers());
    }
    hwy::SetSupportedTargetsForTest(0);
    // Slopes err by half a unit, ways by a unit; and all by single precision.
    const double half = 0.5 * cloud.pairs.rounded_unit(), unit = 1.0 / (1 << FluidPlace::bits),
                 fine = 1e-6;
    const double exact_unit = cloud.pairs.slope_unit() * cloud.kernel.reach();
    for (size_t p = 0; p < cloud.lists.size(); p += 7) {
      double plain_opened = 0, opened = 0, opened_error = 0, pushed_error = 0, exact_error = 0;
      Vec3 plain_pushed = Vec3::Zero(), pushed = Vec3::Zero();
      cloud.each_in_reach(p, [&](size_t q, double f, const Vec3& d) {
        const Vec3 flow = PressureCloud::vector(cloud.flows[q].flow);
        const double weight = double(cloud.weights[q]);
        plain_opened += f * flow.dot(d);
        opened += f * flow.dot(cloud.correction[p] * d);
        plain_pushed += f * weight * d;
        pushed += f * weight * (cloud.correction[q] * d);
        // No number of a correction is above 1, and no vector that it makes three times as long.
        const double error = half * d.norm() + std::abs(f) * (4 * unit + fine * d.norm());
        opened_error += 3 * error * flow.norm();
        pushed_error += 3 * error * weight;
        exact_error += 3 * fine * std::abs(f) * weight * d.norm();
      });
      CHECK(std::abs(double(found.plain_opened[p]) - plain_opened) < opened_error);
      CHECK(std::abs(double(found.opened[p]) - opened) < opened_error);
      CHECK((PressureCloud::vector(found.plain_pushed[p]) - plain_pushed).norm() < pushed_error);
      CHECK((PressureCloud::vector(found.pushed[p]) - pushed).norm() < pushed_error);
      CHECK((found.exact[p].vector() / exact_unit - pushed).norm() < exact_error);
    }
  }
}

TEST_CASE("differences of places within reach are right however far from the origin") {
  Random r(3);
  const double unit = 1.0 / (1 << FluidPlace::bits);
  for (int n = 0; n < 1000; ++n) {
    const double far = std::pow(10, r.uniform(0, 9));
    const Vec3 a = far * Vec3(r.uniform(-1, 1), r.uniform(-1, 1), r.uniform(-1, 1));
    const Vec3 b = a + Vec3(r.uniform(-1, 1), r.uniform(-1, 1), r.uniform(-1, 1));
    const auto numbers = [](const FluidPlace& p) {
      return std::array{uint32_t(p.xy), uint32_t(p.xy) >> 16, uint32_t(p.z) >> 16};
    };
    const auto from = numbers(FluidPlace::of(a)), to = numbers(FluidPlace::of(b));
    for (size_t k = 0; k < 3; ++k) {
      const auto way = int16_t(uint16_t(to[k] - from[k]));
      CHECK(std::abs(way * unit - (b[int(k)] - a[int(k)])) <= 1.01 * unit);
    }
    CHECK((FluidPlace::of(a).z & UINT16_MAX) == 0);
  }
}
