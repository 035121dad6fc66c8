// Problems given by blocks. References: the same problem with its matrix, judged by the validator
// of matrices; products A x of a matrix written out.
#include "engine/math/lcp/blocks/block_factor.hpp"
#include "engine/math/lcp/blocks/block_solvers.hpp"
#include "engine/math/lcp/blocks/block_system.hpp"
#include "engine/math/lcp/newton/cone_newton.hpp"
#include "tests/math/block_matrix.hpp"
#include "tests/math/lcp_families.hpp"

#include <doctest/doctest.h>

using namespace tumble;
using namespace tumble::lcp;
using namespace tumble::lcp_families;

namespace {

void fill_row(Random& r, BlockRow& row) {
  for (size_t s = 0; s < 2; ++s)
    for (double& x : row.entries[s]) x = row.block[s] < 0 ? 0 : r.uniform(-1, 1);
}

/// Groups and single unknowns that tie neighbours of a chain of blocks together, each pair many
/// times, so that rows are redundant. With b in the range of A there is always a solution of
/// equations.
BlockProblem chain(Random& r, int blocks, int units, bool cones) {
  BlockProblem p;
  p.blocks = blocks;
  LcpProblem& c = p.conditions;
  for (int k = 0; k < units; ++k) {
    const int from = int(r.below(uint32_t(blocks)));
    BlockRow row;
    row.block = {from - 1, from};  // the first hangs on nothing
    const bool group = cones && r.below(4) != 0;
    if (group) {
      ConeGroup& g = c.groups.emplace_back();
      g.axial = int(p.rows.size());
      g.lateral = {g.axial + 1, g.axial + 2};
      g.slope = r.uniform(0.1, 0.9);
      g.shape = r.below(5) == 0 ? ConeShape::pyramid : ConeShape::circular;
      if (r.below(6) == 0) {
        g.slope *= 0.2;  // steep sliding has no solution now and then
        g.mode = ConeMode::sliding;
        const double angle = r.uniform(0, 6);
        g.direction = {std::cos(angle), std::sin(angle)};
      }
    }
    for (int i = 0; i < (group ? 3 : 1); ++i) {
      fill_row(r, row);
      p.rows.push_back(row);
    }
  }
  const auto n = Eigen::Index(p.rows.size());
  c.lower = VecX::Constant(n, -inf);
  c.upper = VecX::Constant(n, inf);
  std::vector<char> grouped(size_t(n), 0);
  for (const ConeGroup& g : c.groups) {
    c.lower[g.axial] = 0;
    for (const int i : {g.axial, g.lateral[0], g.lateral[1]}) grouped[size_t(i)] = 1;
  }
  for (Eigen::Index i = 0; i < n; ++i) {
    if (grouped[size_t(i)] || r.below(4) == 0) continue;
    c.lower[i] = -double(r.below(2));
    if (r.below(3) == 0) c.upper[i] = 1;
  }
  VecX z(n);
  for (Eigen::Index i = 0; i < n; ++i) z[i] = r.uniform(-1, 1);
  c.b = VecX::Zero(n);
  c.b = -times(with_matrix(p).A, z);
  return p;
}

}  // namespace

TEST_CASE("blocks: the validator agrees with that of matrices") {
  Random r(3);
  for (int k = 0; k < count(200); ++k) {
    const BlockProblem p = chain(r, 1 + int(r.below(6)), 1 + int(r.below(20)), true);
    REQUIRE(check(p).ok());
    VecX z(p.size()), w, dense_w;
    for (int i = 0; i < p.size(); ++i) z[i] = r.below(3) == 0 ? 0 : r.uniform(-1, 1);
    const LcpResidual a = BlockSystem(p).validate(z, w), b = validate(with_matrix(p), z, dense_w);
    CHECK(a.worst() == doctest::Approx(b.worst()).epsilon(1e-12));
    CHECK(a.complementarity == doctest::Approx(b.complementarity).epsilon(1e-12));
    CHECK(a.unit == doctest::Approx(b.unit).epsilon(1e-12));
    CHECK((w - dense_w).cwiseAbs().maxCoeff() < 1e-12 * b.unit);
  }
}

TEST_CASE("blocks: the sparse factorisation solves A x = y") {
  Random r(4);
  for (int k = 0; k < count(200); ++k) {
    const int blocks = 1 + int(r.below(12)), n = 6 * blocks;
    MatX A = MatX::Identity(n, n);
    std::vector<std::pair<int, int>> pairs;
    BlockFactor f;
    for (int i = 0; i < blocks; ++i)
      for (int j = 0; j < i; ++j)
        if (r.below(3) == 0) pairs.push_back(r.below(2) ? std::pair(i, j) : std::pair(j, i));
    f.set_pattern(blocks, pairs);
    f.set_identity();
    for (int i = 0; i < blocks; ++i) pairs.emplace_back(i, i);
    for (const auto& [i, j] : pairs)
      for (const auto& [row, column] : {std::pair(i, j), std::pair(j, i)}) {
        BlockFactor::Block m;
        for (size_t e = 0; e < m.size(); ++e) {
          m[e] = r.uniform(-1, 1) + (i == j && e % 7 == 0 ? 20 : 0);
          A(6 * row + int(e % 6), 6 * column + int(e / 6)) += m[e];
        }
        f.add(row, column, m.data());
      }
    REQUIRE(f.factor());
    VecX x(n);
    for (int i = 0; i < n; ++i) x[i] = r.uniform(-1, 1);
    VecX y = times(A, x);
    f.solve(std::span<double>(y.data(), size_t(n)));
    CHECK((y - x).cwiseAbs().maxCoeff() < 1e-12);
  }
}

TEST_CASE("blocks: nearly all that cone_newton solves is solved, cold and from anywhere, to 1e-9") {
  Random r(5);
  int solvable = 0, solved = 0;
  for (int k = 0; k < count(400); ++k) {
    const BlockProblem p = chain(r, 1 + int(r.below(8)), 1 + int(r.below(24)), k % 4 != 0);
    const LcpProblem dense = with_matrix(p);
    const auto reference = cone_newton(dense);
    REQUIRE(reference.ok());
    VecX start(p.size());
    for (int i = 0; i < p.size(); ++i) start[i] = r.uniform(-1, 1);
    for (const VecX* z : {static_cast<const VecX*>(nullptr), static_cast<const VecX*>(&start)}) {
      const auto found = block_newton(p, {}, z);
      REQUIRE(found.ok());
      solvable += reference->report.solved();
      solved += found->report.solved();
      if (!found->report.solved()) continue;
      CHECK(validate(dense, found->z).worst() < 1e-9);
      CHECK(found->report.residual < 1e-9);
    }
  }
  CHECK(100 * solved >= 99 * solvable);
  CHECK(solvable > 0);
}

TEST_CASE("blocks: a start that is the solution is the answer") {
  Random r(6);
  for (int k = 0; k < count(50); ++k) {
    const BlockProblem p = chain(r, 4, 12, true);
    const auto first = block_newton(p, {}, nullptr);
    REQUIRE(first.ok());
    if (!first->report.solved() || first->report.residual > 1e-14) continue;
    const auto again = block_newton(p, {}, &first->z);
    REQUIRE(again.ok());
    CHECK(again->report.iterations == 0);
    CHECK((again->z - first->z).isZero(1e-14 * first->z.cwiseAbs().maxCoeff()));
  }
}

TEST_CASE("blocks: rows that do not fit are refused") {
  Random r(7);
  const BlockProblem good = chain(r, 3, 8, true);
  REQUIRE(check(good).ok());
  BlockProblem p = good;
  p.rows[0].block = {1, 1};
  CHECK(!check(p).ok());
  p = good;
  p.rows[0].block = {-1, 3};
  CHECK(!check(p).ok());
  p = good;
  p.rows.pop_back();
  CHECK(!check(p).ok());
  p = good;
  const size_t lateral = size_t(p.conditions.groups[0].lateral[0]);
  std::swap(p.rows[lateral].block[0], p.rows[lateral].block[1]);
  CHECK(!check(p).ok());
  p = good;
  p.rows[0].entries[1][2] = inf;
  CHECK(!check(p).ok());
}
