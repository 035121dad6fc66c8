#include "engine/math/lcp/least/minimum_norm.hpp"

#include "engine/core/stop.hpp"
#include "engine/core/work_meter.hpp"
#include "engine/math/kernels.hpp"
#include "engine/math/lcp/least/range_basis.hpp"
#include "engine/math/lcp/least/solution_cell.hpp"
#include "engine/math/lcp/newton/semismooth_newton.hpp"
#include "engine/math/lcp/tolerances.hpp"
#include "engine/math/lcp/validate.hpp"
#include "engine/math/lu.hpp"

#include <algorithm>
#include <cmath>

namespace tumble::lcp {
namespace {

class DualNewton {
 public:
  DualNewton(MatX basis, std::vector<SolutionCell> cells, const VecX& z0)
      : q_(std::move(basis)),
        cells_(std::move(cells)),
        n_(int(q_.rows())),
        r_(int(q_.cols())),
        z0_(z0),
        jacobians_(cells_.size()) {}

  /// True when A z = A z0 holds to rounding; z() is then the answer.
  bool run(int limit);
  const VecX& z() const { return z_; }
  int iterations = 0;

 private:
  double evaluate(const std::vector<double>& y);
  bool step(std::vector<double>& dy);

  MatX q_;
  std::vector<SolutionCell> cells_;
  int n_, r_;
  VecX z0_, z_, u_;
  std::vector<SolutionCell::Matrix> jacobians_;
  std::vector<double> gradient_;
};

/// The dual function u . P(u) - |P(u)|^2 / 2 - y . Q^T z0 at u = Q y; its gradient.
double DualNewton::evaluate(const std::vector<double>& y) {
  charge_work(size_t(n_), 2 * size_t(r_) + 30);
  u_ = VecX::Zero(n_);
  for (int k = 0; k < r_; ++k)
    add_scaled(u_.data(), y[size_t(k)], q_.data() + std::ptrdiff_t(k) * n_, n_);
  z_ = VecX::Zero(n_);
  for (size_t c = 0; c < cells_.size(); ++c) {
    const SolutionCell& cell = cells_[c];
    SolutionCell::Point x{};
    for (size_t k = 0; k < size_t(cell.size); ++k) x[k] = u_[cell.unknown[k]];
    x = cell.project(x, jacobians_[c]);
    for (size_t k = 0; k < size_t(cell.size); ++k) z_[cell.unknown[k]] = x[k];
  }
  const VecX off = z_ - z0_;
  gradient_.resize(size_t(r_));
  for (int k = 0; k < r_; ++k)
    gradient_[size_t(k)] = dot(q_.data() + std::ptrdiff_t(k) * n_, off.data(), n_);
  return dot(u_.data(), off.data(), n_) - 0.5 * dot(z_.data(), z_.data(), n_);
}

bool DualNewton::step(std::vector<double>& dy) {
  // H = Q^T J Q, J block diagonal, plus a little of the identity: H may be singular.
  MatX jq = MatX::Zero(n_, r_);
  for (size_t c = 0; c < cells_.size(); ++c)
    for (size_t a = 0; a < size_t(cells_[c].size); ++a)
      for (size_t b = 0; b < size_t(cells_[c].size); ++b) {
        const double f = jacobians_[c][a][b];
        if (f == 0) continue;
        for (int k = 0; k < r_; ++k) jq(cells_[c].unknown[a], k) += f * q_(cells_[c].unknown[b], k);
      }
  std::vector<double> h(size_t(r_) * size_t(r_));
  double size = 0;
  for (const double g : gradient_) size = std::max(size, std::fabs(g));
  const double unit = std::max(z0_.cwiseAbs().maxCoeff(), tolerances::never_zero);
  for (int i = 0; i < r_; ++i) {
    charge_work(size_t(n_), size_t(r_) + 3);
    if (stop_requested()) return false;
    for (int j = 0; j < r_; ++j)
      h[size_t(j) * size_t(r_) + size_t(i)] =
          dot(q_.data() + std::ptrdiff_t(i) * n_, jq.data() + std::ptrdiff_t(j) * n_, n_);
    h[size_t(i) * size_t(r_) + size_t(i)] +=
        std::min(tolerances::most_dual_weight, tolerances::dual_weight * size / unit) +
        tolerances::least_dual_weight;
  }
  for (size_t k = 0; k < dy.size(); ++k) dy[k] = -gradient_[k];
  LuFactor lu;
  if (!lu.factor(h, r_, tolerances::lost_dual_pivot)) return false;
  lu.solve(dy.data());
  return true;
}

bool DualNewton::run(int limit) {
  if (r_ == 0) return evaluate({}), true;
  std::vector<double> y(static_cast<size_t>(r_)), dy(y.size()), trial;
  for (int k = 0; k < r_; ++k)
    y[size_t(k)] = dot(q_.data() + std::ptrdiff_t(k) * n_, z0_.data(), n_);
  const double unit = z0_.cwiseAbs().maxCoeff();
  double value = evaluate(y);
  for (;; ++iterations) {
    double size = 0, slope = 0;
    for (const double g : gradient_) size = std::max(size, std::fabs(g));
    if (size <= tolerances::least_gradient * unit) return true;
    if (iterations == limit || stop_requested() || !step(dy))
      return size <= tolerances::found_gradient * unit;
    for (size_t k = 0; k < dy.size(); ++k) slope += dy[k] * gradient_[k];
    double t = 1;
    const double noise = tolerances::dual_value_rounding * unit * unit * n_;
    for (int half = 0; half < 40; ++half, t *= 0.5) {
      trial = y;
      for (size_t k = 0; k < y.size(); ++k) trial[k] += t * dy[k];
      const double next = evaluate(trial);
      if (next <= value + tolerances::dual_descent * t * slope + noise) {
        value = next;
        break;
      }
    }
    y = trial;
  }
}

}  // namespace

Result<LcpSolution> minimum_norm(const LcpProblem& problem, const LcpSolution& solution,
                                 const LcpOptions& options) {
  if (Status c = check(problem); !c) return c.error();
  if (Status c = check_start(problem, solution.z); !c) return c.error();
  LcpSolution out = solution;
  if (!solution.report.solved() || problem.size() == 0 || solution.z.cwiseAbs().maxCoeff() == 0)
    return out;
  const VecX w = slack(problem, solution.z);
  // The rounding error of w is relative to the terms of A z + b.
  const double still = std::max(tolerances::least_w_rounding, 10 * solution.report.residual) *
                       term_unit(problem, solution.z);
  MatX basis = row_space(problem);
  if (basis.cols() == problem.size()) return out;
  DualNewton newton(std::move(basis), solution_cells(problem, solution.z, w, still), solution.z);
  const bool converged = newton.run(options.max_iterations > 0 ? options.max_iterations : 100);
  out.report.iterations += newton.iterations;
  LcpSolution better = out;
  better.z = newton.z();
  grade(problem, options.tolerance, better);
  if (converged && better.report.solved()) return better;
  out.report.status = LcpStatus::max_iterations;
  return out;
}

}  // namespace tumble::lcp
