#include "engine/dynamics/rows/delassus.hpp"

#include "engine/core/stop.hpp"
#include "engine/core/work_meter.hpp"

#include <vector>

namespace tumble {
namespace {

/// M^-1 J^T of one side.
RowSide response(const RowSide& s, std::span<const DofBlock> blocks) {
  if (s.block == no_block) return s;
  const DofBlock& block = blocks[s.block];
  return {s.block, block.inverse_mass * s.linear, block.inverse_inertia * s.angular};
}

double product(const RowSide& s, const RowSide& moved) {
  if (s.block == no_block || s.block != moved.block) return 0;
  return s.linear.dot(moved.linear) + s.angular.dot(moved.angular);
}

}  // namespace

Row response(const Row& row, std::span<const DofBlock> blocks) {
  return {response(row.a, blocks), response(row.b, blocks)};
}

double coupling(const Row& r, const Row& m) {
  return product(r.a, m.a) + product(r.a, m.b) + product(r.b, m.a) + product(r.b, m.b);
}

Eigen::MatrixXd delassus(std::span<const Row> rows, std::span<const DofBlock> blocks) {
  const auto n = Eigen::Index(rows.size());
  std::vector<Row> moved(rows.size());
  for (size_t j = 0; j < rows.size(); ++j) moved[j] = response(rows[j], blocks);
  Eigen::MatrixXd A(n, n);
  for (size_t j = 0; j < rows.size(); ++j) {
    charge_work(j + 1, 15);
    if (stop_requested()) return Eigen::MatrixXd::Zero(n, n);
    for (size_t i = 0; i <= j; ++i)
      A(Eigen::Index(i), Eigen::Index(j)) = A(Eigen::Index(j), Eigen::Index(i)) =
          coupling(rows[i], moved[j]);
  }
  return A;
}

}  // namespace tumble
