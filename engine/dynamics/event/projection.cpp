#include "engine/dynamics/event/projection.hpp"

#include "engine/core/stop.hpp"
#include "engine/core/work_meter.hpp"
#include "engine/dynamics/event/tolerances.hpp"
#include "engine/dynamics/rows/block_rows.hpp"
#include "engine/dynamics/rows/delassus.hpp"
#include "engine/math/lcp/blocks/block_least.hpp"

#include <cmath>

namespace tumble {
namespace {

double sum_of_products(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  double sum = 0;
  for (Eigen::Index i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

/// Conjugate residuals (Stiefel 1955) on the Delassus matrix, started from zero, which gives the
/// impulses of least norm.
void change_through_joints(std::span<const Row> rows, const Eigen::VectorXd& wanted,
                           std::span<DofBlock> blocks, const Articulation& joints) {
  const auto n = Eigen::Index(rows.size());
  Eigen::MatrixXd A = delassus(rows, blocks);
  joints.reduce(rows, A);
  const double stiffest = A.diagonal().maxCoeff();
  const auto times = [&](const Eigen::VectorXd& x) {
    charge_work(size_t(n), size_t(n) + 20);
    Eigen::VectorXd y = Eigen::VectorXd::Zero(n);
    for (Eigen::Index j = 0; j < n; ++j)
      for (Eigen::Index i = 0; i < n; ++i) y[i] += A(i, j) * x[j];
    return y;
  };
  Eigen::VectorXd z = Eigen::VectorXd::Zero(n), rest = wanted, direction = wanted;
  Eigen::VectorXd moved_rest = times(rest), moved = moved_rest;
  const double goal = tolerances::residual_goal2 * sum_of_products(wanted, wanted);
  double work = sum_of_products(rest, moved_rest);
  for (Eigen::Index k = 0;
       k < tolerances::residual_steps + tolerances::residual_steps_per_row * n && !stop_requested();
       ++k) {
    const double square = sum_of_products(rest, rest);
    // The residual is small, or no impulse can reduce it.
    if (square <= goal || !(work > tolerances::without_effect * stiffest * square)) break;
    const double step = work / sum_of_products(moved, moved);
    z += step * direction;
    rest -= step * moved;
    moved_rest = times(rest);
    const double next = sum_of_products(rest, moved_rest);
    direction = rest + (next / work) * direction;
    moved = moved_rest + (next / work) * moved;
    work = next;
  }
  for (Eigen::Index i = 0; i < n; ++i) apply_row(rows[size_t(i)], z[i], blocks);
}

}  // namespace

void change_least(std::span<const Row> rows, const Eigen::VectorXd& wanted,
                  std::span<DofBlock> blocks, const Articulation& joints) {
  if (!joints.empty()) return change_through_joints(rows, wanted, blocks, joints);
  const BlockRoots roots(rows, blocks);
  lcp::BlockProblem problem;
  problem.conditions.b = Eigen::VectorXd::Zero(wanted.size());
  problem.conditions.lower = problem.conditions.upper = problem.conditions.b;
  set_block_rows(rows, roots, problem);
  roots.add(lcp::least_columns(problem, wanted), blocks);
}

}  // namespace tumble
