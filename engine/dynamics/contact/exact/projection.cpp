#include "engine/dynamics/contact/exact/projection.hpp"

#include <cmath>

namespace tumble {
namespace {

double sum_of_products(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  double sum = 0;
  for (Eigen::Index i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

}  // namespace

void change_least(std::span<const Row> rows, const Eigen::VectorXd& wanted,
                  std::span<DofBlock> blocks, const Articulation& joints) {
  const auto n = Eigen::Index(rows.size());
  Eigen::MatrixXd A = delassus(rows, blocks);
  joints.reduce(rows, blocks, A);
  const double stiffest = A.diagonal().maxCoeff();
  const auto times = [&](const Eigen::VectorXd& x) {
    Eigen::VectorXd y = Eigen::VectorXd::Zero(n);
    for (Eigen::Index j = 0; j < n; ++j)
      for (Eigen::Index i = 0; i < n; ++i) y[i] += A(i, j) * x[j];
    return y;
  };
  Eigen::VectorXd z = Eigen::VectorXd::Zero(n), rest = wanted, direction = wanted;
  Eigen::VectorXd moved_rest = times(rest), moved = moved_rest;
  const double goal = 1e-30 * sum_of_products(wanted, wanted);
  double work = sum_of_products(rest, moved_rest);
  for (Eigen::Index k = 0; k < 50 + 10 * n; ++k) {
    const double square = sum_of_products(rest, rest);
    // What is left is small, or such that no impulse changes it.
    if (square <= goal || !(work > 1e-14 * stiffest * square)) break;
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

}  // namespace tumble
