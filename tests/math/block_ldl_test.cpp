// Sparse factors of blocks. Reference: Eigen's dense Cholesky with pivoting, and A x itself where
// rows depend on each other.
#include "engine/math/block_ldl.hpp"

#include "engine/core/random.hpp"
#include "tests/support/dense.hpp"

#include <cmath>

#include <doctest/doctest.h>

using namespace tumble;
using namespace tumble::test;

namespace {

/// J J^T of random blocks J that share random bodies, whole and in blocks; the first block comes
/// again `copies` times.
struct BlockCase {
  std::vector<uint32_t> sizes;
  std::vector<std::pair<uint32_t, uint32_t>> coupled;
  Eigen::MatrixXd A;
  BlockLdl ldl;

  BlockCase(Random& random, uint32_t blocks, bool chain, uint32_t copies = 0) {
    const uint32_t bodies = chain ? blocks + 1 : blocks / 2 + 2;
    std::vector<std::pair<uint32_t, uint32_t>> ends;
    for (uint32_t i = 0; i < blocks; ++i) {
      sizes.push_back(1 + uint32_t(random.below(5)));
      const auto a = uint32_t(random.below(bodies));
      ends.emplace_back(chain ? i : a,
                        chain ? i + 1 : (a + 1 + uint32_t(random.below(bodies - 1))) % bodies);
    }
    for (uint32_t i = 0; i < copies; ++i) sizes[i + 1] = sizes[0], ends[i + 1] = ends[0];
    uint32_t rows = 0;
    for (const uint32_t s : sizes) rows += s;
    Eigen::MatrixXd J = Eigen::MatrixXd::Zero(rows, 6 * bodies);
    uint32_t first = 0;
    for (uint32_t i = 0; i < blocks; first += sizes[i++])
      for (uint32_t r = 0; r < sizes[i]; ++r)
        for (const uint32_t body : {ends[i].first, ends[i].second})
          for (uint32_t k = 0; k < 6; ++k) {
            const bool copied = i > 0 && i <= copies;
            J(first + r, 6 * body + k) = copied ? J(r, 6 * body + k) : random.uniform(-1, 1);
          }
    A = J * J.transpose();
    for (uint32_t i = 0; i < blocks; ++i)
      for (uint32_t k = 0; k < i; ++k)
        if (ends[i].first == ends[k].first || ends[i].first == ends[k].second ||
            ends[i].second == ends[k].first || ends[i].second == ends[k].second)
          coupled.emplace_back(i, k);
    ldl = BlockLdl(sizes, coupled);
    for (uint32_t i = 0; i < blocks; ++i) fill(i, i);
    for (const auto& [i, k] : coupled) fill(i, k);
    ldl.factor();
  }
  void fill(uint32_t i, uint32_t k) {
    for (uint32_t r = 0; r < sizes[i]; ++r)
      for (uint32_t c = 0; c < sizes[k]; ++c)
        ldl.add(i, r, k, c, A(ldl.first_row(i) + r, ldl.first_row(k) + c));
  }
};

Eigen::VectorXd random_vector(Random& random, Eigen::Index n) {
  Eigen::VectorXd x(n);
  for (Eigen::Index i = 0; i < n; ++i) x[i] = random.uniform(-1, 1);
  return x;
}

}  // namespace

TEST_CASE("sparse factors of blocks solve what dense ones solve") {
  Random random(7);
  for (int n = 0; n < 200; ++n) {
    const BlockCase c(random, 1 + uint32_t(random.below(12)), n % 2 == 0);
    Eigen::VectorXd x = random_vector(random, c.A.rows());
    const Eigen::VectorXd b = c.A * x;
    Eigen::VectorXd got = b;
    c.ldl.solve({got.data(), size_t(got.size())});
    CHECK((c.A * got - b).norm() < 1e-9 * (1 + b.norm()));
    if (c.ldl.dependent() > 0) continue;
    const Eigen::VectorXd want = solve_symmetric(c.A, b);
    CHECK((got - want).norm() < 1e-6 * (1 + want.norm()));
  }
}

TEST_CASE("rows that depend on others get nothing, and all equations hold") {
  Random random(8);
  for (int n = 0; n < 100; ++n) {
    const uint32_t copies = 1 + uint32_t(random.below(3));
    const BlockCase c(random, 8, true, copies);
    CHECK(c.ldl.dependent() >= copies * c.sizes[0]);
    const Eigen::VectorXd b = c.A * random_vector(random, c.A.rows());
    Eigen::VectorXd x = b;
    c.ldl.solve({x.data(), size_t(x.size())});
    CHECK((c.A * x - b).norm() < 1e-9 * (1 + b.norm()));
  }
}

TEST_CASE("what chains and trees cost grows with their blocks, rings hardly more") {
  // Entries of the factors, each of which is worked out and used once.
  const auto entries = [](uint32_t n, const auto& parent, bool ring) {
    std::vector<std::pair<uint32_t, uint32_t>> coupled;
    for (uint32_t i = 1; i < n; ++i) coupled.emplace_back(i, parent(i));
    if (ring) coupled.emplace_back(0, n - 1);
    return double(BlockLdl(std::vector<uint32_t>(n, 5), coupled).values().size());
  };
  const auto chain = [](uint32_t i) { return i - 1; };
  const auto tree = [](uint32_t i) { return (i - 1) / 2; };
  CHECK(entries(10000, chain, false) < 10.1 * entries(1000, chain, false));
  CHECK(entries(10000, tree, false) < 10.1 * entries(1000, tree, false));
  CHECK(entries(1000, chain, true) < 1.6 * entries(1000, chain, false));
}
