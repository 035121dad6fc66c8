// Reference: integrals by cubature over fine grids, differences of values, and sums term by term.
#include "engine/core/random.hpp"
#include "engine/dynamics/particles/neighbours/neighbour_lists.hpp"
#include "engine/dynamics/sph/block_sums.hpp"
#include "engine/dynamics/sph/fluid_sums.hpp"
#include "engine/dynamics/sph/wall_integrals.hpp"

#include <algorithm>
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
    double steepest = 0;
    for (int k = 0; k < int(shells); ++k)
      steepest = std::max(steepest, -kernel.slope((k + 0.5) * kernel.reach() / shells));
    CHECK(kernel.steepest() == doctest::Approx(steepest).epsilon(1e-6));
    CHECK(kernel.steepest() >= steepest);
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
    REQUIRE(lists.update(x, {.reach = 0.25, .skin = 0.05, .box = {}}, nullptr));
    const size_t places = lists.places();
    std::vector<double> volume(places), p(places), q(places);
    FluidVectors points, u;
    points.resize(places), u.resize(places);
    // Sums over pairs are of four numbers of the other; what is linear in its place among them.
    FluidVectors push, open, differ;
    push.resize(places), open.resize(places), differ.resize(places);
    for (size_t k = 0; k < places; ++k) {
      if (k < x.size()) volume[k] = r.uniform(0.5, 1), p[k] = r.uniform(), q[k] = r.uniform();
      points.set(k, {lists.x()[k], lists.y()[k], lists.z()[k]}, volume[k]);
      if (k < x.size()) u.set(k, {r.uniform(-1, 1), r.uniform(-1, 1), r.uniform(-1, 1)});
      const Vec3 px = volume[k] * p[k] * points[k], vu = volume[k] * u[k];
      push.set(k, px, volume[k] * p[k]);
      open.set(k, vu, vu.dot(points[k]));
      differ.set(k, vu, volume[k]);
    }
    const auto at = [&](size_t k) { return points[k]; };
    const auto speed = [&](size_t k) { return u[k]; };
    for (size_t i = 0; i < x.size(); i += 7) {
      double share = 0, squares = 0, rate = 0, slopes = 0;
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
        squares += v * (f * d).squaredNorm();
        moment -= v * f * d * d.transpose();
        square_matrix += v * f * f * d * d.transpose();
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
      std::vector<double> bits;
      for (const int64_t target : hwy::SupportedAndGeneratedTargets()) {
        hwy::SetSupportedTargetsForTest(target);
        FluidPairStore store;
        store.clear(kernel, lists.of(i).size());
        const FluidPairSums s =
            find_pairs(kernel, FluidMoments::found, {points.data(), places}, i, lists.of(i), store);
        const auto sum = [&](FluidFactor factor, const FluidVectors& y, const double* of) {
          FluidVector found;
          sum_pairs(store, factor, i, {&s.range, 1}, y.data(), of, &found);
          return found;
        };
        const Vec3 g(s.gx, s.gy, s.gz);
        const FluidVector pushed = sum(FluidFactor::slope, push, nullptr);
        const Vec3 a = p[i] * g + pushed.w * at(i) - pushed.vector();
        const FluidVector opened = sum(FluidFactor::slope, open, nullptr);
        const double b = speed(i).dot(g) - at(i).dot(opened.vector()) + opened.w;
        const auto apart = [&](const FluidVector& v) { return Vec3(v.w * speed(i) - v.vector()); };
        const Vec3 c = apart(sum(FluidFactor::slope, differ, q.data())),
                   d = -apart(sum(FluidFactor::weight, differ, q.data()));
        CHECK(s.pairs == pairs);
        CHECK(s.share == doctest::Approx(share).epsilon(1e-6));
        CHECK(s.squares == doctest::Approx(squares).epsilon(1e-6));
        CHECK(s.slopes == doctest::Approx(slopes).epsilon(1e-6));
        CHECK((s.moment - moment).norm() <= 1e-6 * moment.norm());
        CHECK((s.square_matrix - square_matrix).norm() <= 1e-6 * square_matrix.norm());
        // One factor for all: a pair's is the same for both, and then what they exchange is.
        CHECK(sum(FluidFactor::slope, differ, nullptr).w ==
              doctest::Approx(s.slopes).epsilon(1e-12));
        CHECK(close({s.gx, s.gy, s.gz}, gradient, 1e-6));
        CHECK(close(a, pressed, 1e-6));
        CHECK(std::abs(b - rate) <= 1e-6 * moved);
        CHECK(close(c, viscous, 1e-6));
        CHECK(close(d, smooth, 1e-6));
        const std::vector<double> now{
            s.share, s.squares, s.slopes, s.gx, s.moment(0, 1), s.square_matrix(1, 2),
            a[0],    b,         c[1],     d[2]};
        if (bits.empty()) bits = now;
        CHECK(bits == now);
      }
      hwy::SetSupportedTargetsForTest(0);
    }
  }
}

namespace {

/// A cloud of particles far from the origin, and all that sums over its blocks are of.
struct BlockCloud {
  SmoothingKernel kernel{FluidKernelKind::cubic_spline, 0.25};
  NeighbourLists lists;
  std::vector<FluidVector> points;
  std::vector<Mat3> correction;
  std::vector<SingleVector> flows, gradients;
  std::vector<float> weights;
  FluidPairStore store;
  FluidBlocks blocks;
  std::vector<uint32_t> firsts, copies;

  explicit BlockCloud(size_t n) {
    Random r(5);
    std::vector<Vec3> x(n);
    for (Vec3& p : x) p = Vec3(r.uniform(200, 203), r.uniform(-70, -69), r.uniform(0, 1));
    REQUIRE(lists.update(x, {.reach = kernel.reach(), .skin = 0, .box = {}}, nullptr));
    for (size_t k = 0; k < lists.places(); ++k)
      points.push_back({lists.x()[k], lists.y()[k], lists.z()[k], k < n ? r.uniform(0.5, 1) : 0.0});
    size_t most = 0;
    for (size_t p = 0; p < n; ++p) most += lists.of(p).size();
    store.clear(kernel, most);
    std::vector<FluidPairStore::Range> ranges;
    for (size_t p = 0; p < n; ++p)
      ranges.push_back(
          find_pairs(kernel, FluidMoments::left_out, points, p, lists.of(p), store).range);
    REQUIRE(blocks.make(store, 0, ranges, lists.places()));
    const auto draw = [&] { return float(r.uniform(-1, 1)); };
    for (size_t p = 0; p < n; ++p) {
      flows.push_back({draw(), draw(), draw(), 0});
      weights.push_back(float(r.uniform(0, 1)));
      gradients.push_back({draw(), draw(), draw(), float(r.uniform(0.5, 1))});
      const double xx = r.uniform(-1, 1), xy = r.uniform(-1, 1), xz = r.uniform(-1, 1),
                   yy = r.uniform(-1, 1), yz = r.uniform(-1, 1), zz = r.uniform(-1, 1);
      correction.push_back(Mat3{xx, xy, xz, xy, yy, yz, xz, yz, zz});
    }
    std::vector<std::vector<uint32_t>> rows_of(n);
    for (size_t b = 0; b < blocks.size(); ++b)
      for (size_t row = 0; row < blocks[b].rows.size(); ++row)
        rows_of[blocks[b].rows[row]].push_back(uint32_t(blocks[b].first_row + row));
    for (const std::vector<uint32_t>& rows : rows_of) {
      firsts.push_back(uint32_t(copies.size()));
      copies.insert(copies.end(), rows.begin(), rows.end());
    }
    firsts.push_back(uint32_t(copies.size()));
  }
  BlockPoints of(bool corrected) const {
    return {points.data(), corrected ? correction.data() : nullptr, kernel.reach(),
            kernel.steepest() * kernel.reach() / kernel.scale()};
  }
  static Vec3 vector(const SingleVector& v) { return {double(v.x), double(v.y), double(v.z)}; }
  /// f(other, slope in units of the store, way from it in reaches) for what is in reach of p.
  template <class F>
  void each_in_reach(size_t p, const F& f) const {
    for (size_t q = 0; q < flows.size(); ++q) {
      const Vec3 d = points[p].vector() - points[q].vector();
      const double r = d.norm(), reach = kernel.reach();
      if (q == p || r >= reach) continue;
      f(q, kernel.slope(r) / r * reach * reach / kernel.scale(), Vec3(d / reach));
    }
  }
};

/// What sums over blocks make of a cloud.
struct BlockResults {
  std::vector<SingleVector> sums, flows;
  std::vector<float> opened, units;
  std::vector<FluidVector> own, pushes;  ///< in double; pushes of all rows of a particle

  BlockResults(const BlockCloud& cloud, bool corrected)
      : sums(cloud.flows.size()),
        flows(cloud.flows),
        opened(sums.size()),
        units(sums.size()),
        own(sums.size()),
        pushes(sums.size()) {
    const size_t n = sums.size();
    std::vector<BlockPairs> pairs(cloud.store.used() / FluidPairStore::batch + 1);
    std::vector<float> volumes;
    for (const FluidVector& at : cloud.points) volumes.push_back(float(at.w));
    std::vector<BlockRow> rows(cloud.blocks.rows());
    std::vector<FluidVector> exact_rows(rows.size());
    const BlockCopies copies{cloud.firsts.data(), cloud.copies.data()};
    const std::vector<double> weights(cloud.weights.begin(), cloud.weights.end());
    spread_flows(copies, 0, n, flows.data(), rows.data());
    for (size_t b = 0; b < cloud.blocks.size(); ++b) {
      const FluidBlock block = cloud.blocks[b];
      const size_t all = block.ends.size(), first = block.first;
      BlockPair* own_pairs = pairs[block.first_pair / FluidPairStore::batch].all;
      BlockRow* own_rows = rows.data() + block.first_row;
      make_pairs(cloud.of(corrected), block, volumes.data(), own_pairs, units.data() + first,
                 sums.data() + first);
      std::vector<float> by_units;
      for (size_t p = first; p < first + all; ++p) by_units.push_back(units[p] * cloud.weights[p]);
      for (const auto& [from, to] : {std::pair{size_t{0}, all / 3}, {all / 3, all}}) {
        open_pairs(block, own_pairs, own_rows, from, to, opened.data() + first + from);
        press_pairs(block, own_pairs, by_units.data() + from, from, to, own_rows);
      }
      for (size_t p = first; p < first + all; ++p) opened[p] *= units[p];
      FluidVector* own_exact = exact_rows.data() + block.first_row;
      for (size_t r = 0; r < block.rows.size(); ++r)
        own_exact[r] = {0, 0, 0, cloud.points[block.rows[r]].w};
      press_exactly(cloud.of(corrected), block, weights.data(), own_exact, own.data() + first);
    }
    flow_by_pushes(copies, 0, n, cloud.gradients.data(), cloud.weights.data(), flows.data(),
                   rows.data());
    bool spread = true;
    for (size_t p = 0; p < n; ++p)
      for (size_t k = cloud.firsts[p]; k < cloud.firsts[p + 1]; ++k) {
        const FluidVector& row = exact_rows[cloud.copies[k]];
        pushes[p].x += row.x, pushes[p].y += row.y, pushes[p].z += row.z;
        const BlockRow& left = rows[cloud.copies[k]];
        spread = spread && row.w == cloud.points[p].w &&
                 BlockCloud::vector(left.flow) == BlockCloud::vector(flows[p]) &&
                 BlockCloud::vector(left.push) == Vec3::Zero();
      }
    CHECK(spread);
  }
  std::vector<double> numbers() const {
    std::vector<double> all(opened.begin(), opened.end());
    for (const auto* of : {&sums, &flows})
      for (const SingleVector& v : *of)
        all.insert(all.end(), {double(v.x), double(v.y), double(v.z)});
    for (const auto* of : {&own, &pushes})
      for (const FluidVector& v : *of) all.insert(all.end(), {v.x, v.y, v.z});
    return all;
  }
};

}  // namespace

TEST_CASE("blocks have each particle once, and each of its neighbours in a row") {
  const BlockCloud cloud(9000);
  CHECK(cloud.blocks.size() == 3);
  size_t next = 0;
  for (size_t b = 0; b < cloud.blocks.size(); ++b) {
    const FluidBlock block = cloud.blocks[b];
    CHECK(block.first == next);
    next += block.ends.size();
    std::vector<uint32_t> rows(block.rows.begin(), block.rows.end());
    std::sort(rows.begin(), rows.end());
    CHECK(std::adjacent_find(rows.begin(), rows.end()) == rows.end());
    size_t k = 0;
    for (size_t n = 0; n < block.ends.size(); ++n) {
      std::vector<uint32_t> found, expected;
      // Single precision does not tell on which side of the reach a pair is that is nearly there.
      const auto nearly = [&](size_t q) {
        const Vec3 d = cloud.points[block.first + n].vector() - cloud.points[q].vector();
        return d.norm() > (1 - 1e-6) * cloud.kernel.reach();
      };
      for (; k < block.ends[n]; ++k) {
        const uint32_t q = block.rows[block.others[k]];
        if (block.slopes[k] != 0 && !nearly(q)) found.push_back(q);
      }
      cloud.each_in_reach(block.first + n, [&](size_t q, double, const Vec3&) {
        if (!nearly(q)) expected.push_back(uint32_t(q));
      });
      std::sort(found.begin(), found.end());
      CHECK(found == expected);
    }
  }
  CHECK(next == cloud.flows.size());
}

namespace {

/// Particles with lists that are made up, each the places from its first on.
struct MadeUpLists {
  struct List {
    uint32_t first, count;
  };
  SmoothingKernel kernel{FluidKernelKind::cubic_spline, 0.25};
  FluidPairStore store;
  std::vector<FluidPairStore::Range> ranges;

  explicit MadeUpLists(const std::vector<List>& lists) {
    size_t most = 0;
    for (const List& list : lists) most += list.count;
    store.clear(kernel, most);
    for (const List& list : lists) {
      REQUIRE(list.count % FluidPairStore::batch == 0);
      ranges.push_back({store.used(), list.count});
      const FluidPairStore::End end = store.end();
      for (uint32_t k = 0; k < list.count; ++k)
        end.others[k] = list.first + k, end.slopes[k] = 1, end.weights[k] = 1;
      store.keep(list.count);
    }
  }
  bool make(FluidBlocks& blocks, const std::vector<FluidVector>& points) const {
    return blocks.make(store, 0, ranges, points.size());
  }
};

}  // namespace

TEST_CASE("a block has no more rows than its pairs can name") {
  FluidBlocks blocks;
  const uint32_t most = FluidBlocks::most_rows;
  const std::vector<FluidVector> points(2 * most);
  CHECK(MadeUpLists({{1, most}}).make(blocks, points));
  CHECK(blocks.size() == 1);
  CHECK_FALSE(MadeUpLists({{1, most + 4}}).make(blocks, points));
  // Each of two has room by itself, and both together have none.
  const uint32_t count = 40000;
  const MadeUpLists two({{2, count}, {2 + count, count}});
  REQUIRE(two.make(blocks, points));
  REQUIRE(blocks.size() == 2);
  for (uint32_t b = 0; b < 2; ++b) {
    const FluidBlock block = blocks[b];
    CHECK(block.first == b);
    REQUIRE(block.rows.size() == count);
    REQUIRE(block.ends.size() == 1);
    CHECK(block.ends[0] == count);
    bool all = true;
    for (uint32_t k = 0; k < count; ++k)
      all &= block.rows[block.others[k]] == 2 + b * count + k && block.slopes[k] == 1;
    CHECK(all);
  }
}

TEST_CASE("sums over blocks are those pair by pair, for every instruction set") {
  const BlockCloud cloud(5000);
  REQUIRE(cloud.blocks.size() == 2);
  for (const bool corrected : {false, true}) {
    CAPTURE(corrected);
    const auto matrix = [&](size_t p) {
      return corrected ? cloud.correction[p] : Mat3(Mat3::Identity());
    };
    const BlockResults found(cloud, corrected);
    for (const int64_t target : hwy::SupportedAndGeneratedTargets()) {
      hwy::SetSupportedTargetsForTest(target);
      CHECK(BlockResults(cloud, corrected).numbers() == found.numbers());
    }
    hwy::SetSupportedTargetsForTest(0);
    const size_t n = cloud.flows.size();
    // Single precision and that of slopes; the numbers of gradients err by half a unit, too.
    const double fine = 1e-6;
    const auto half_unit = [&](size_t p) { return 0.5 * std::sqrt(3.0) * double(found.units[p]); };
    Vec3 all = Vec3::Zero();
    double sizes = 0;
    for (size_t p = 0; p < n; ++p) {
      const Vec3 of_others = cloud.points[p].w * found.pushes[p].vector();
      all += of_others - found.own[p].vector();
      sizes += of_others.norm();
    }
    CHECK(all.norm() < 1e-13 * sizes);
    for (size_t p = 0; p < n; p += 41) {
      double opened = 0, terms = 0, coarse_opened = 0, coarse_sum = 0, coarse_push = 0;
      Vec3 sum = Vec3::Zero(), own = Vec3::Zero(), pushed = Vec3::Zero();
      cloud.each_in_reach(p, [&](size_t q, double f, const Vec3& d) {
        const Vec3 gradient = f * (matrix(p) * d);
        opened += BlockCloud::vector(cloud.flows[q]).dot(gradient);
        sum += cloud.points[q].w * gradient;
        own += cloud.points[q].w * double(cloud.weights[p]) * gradient;
        pushed -= f * double(cloud.weights[q]) * (matrix(q) * d);
        terms += std::abs(f) * d.norm() * 3;
        coarse_opened += half_unit(p) * BlockCloud::vector(cloud.flows[q]).norm();
        coarse_sum += half_unit(p) * cloud.points[q].w;
        coarse_push += half_unit(q) * double(cloud.weights[q]);
      });
      const SingleVector& g = cloud.gradients[p];
      const Vec3 flow = double(g.w) * (pushed - double(cloud.weights[p]) * BlockCloud::vector(g));
      CHECK(std::abs(double(found.opened[p]) - opened) < fine * terms + coarse_opened);
      CHECK((BlockCloud::vector(found.sums[p]) - sum).norm() < fine * terms + coarse_sum);
      CHECK((BlockCloud::vector(found.flows[p]) - flow).norm() < fine * terms + coarse_push);
      CHECK((found.own[p].vector() - own).norm() < fine * terms);
      CHECK((found.pushes[p].vector() - pushed).norm() < fine * terms);
    }
  }
}
