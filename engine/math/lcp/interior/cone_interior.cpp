#include "engine/math/lcp/interior/cone_interior.hpp"

#include "engine/math/kernels.hpp"
#include "engine/math/lcp/interior/path_follower.hpp"
#include "engine/math/lcp/newton/cone_newton.hpp"
#include "engine/math/lcp/scaling.hpp"
#include "engine/math/lcp/validate.hpp"
#include "engine/math/lu.hpp"

namespace tumble::lcp {
namespace {

constexpr int most_polish = 60;   ///< systems
constexpr double regular = 1e-8;  ///< added to the diagonal of A in linear systems only

class DensePath final : public PathProblem {
 public:
  explicit DensePath(const LcpProblem& problem) : problem_(problem), scaled_(problem) {}

  const LcpProblem& conditions() const override { return problem_; }
  const std::vector<double>& units() const override { return scaled_.d; }
  const VecX& b() const override { return scaled_.b; }
  void slack(const VecX& z, VecX& w) override {
    w = scaled_.b;
    for (int j = 0; j < scaled_.n; ++j)
      if (z[j] != 0) add_scaled(w.data(), z[j], scaled_.column(j), scaled_.n);
  }
  bool step(std::span<const SmoothedMap::Unit> parts, std::span<const SmoothedMap::Value> values,
            const VecX& f, VecX& dz) override;
  double residual(const VecX& z) override { return validate(problem_, z).worst(); }

 private:
  const LcpProblem& problem_;
  const ScaledProblem scaled_;
  LuFactor lu_;
};

bool DensePath::step(std::span<const SmoothedMap::Unit> parts,
                     std::span<const SmoothedMap::Value> values, const VecX& f, VecX& dz) {
  const auto n = size_t(scaled_.n);
  std::vector<double> J(n * n, 0.0);
  for (size_t k = 0; k < parts.size(); ++k) {
    const auto count = size_t(parts[k].count);
    for (size_t r = 0; r < count; ++r) {
      double* row = &J[size_t(parts[k].row[r])];
      for (size_t q = 0; q < count; ++q) {
        const auto i = size_t(parts[k].row[q]);
        const double by_w = values[k].by_w[3 * r + q];
        if (by_w != 0)
          for (size_t j = 0; j < n; ++j) row[j * n] += by_w * scaled_.A[j * n + i];
        row[i * n] += values[k].by_z[3 * r + q] + regular * by_w;
      }
    }
  }
  if (!lu_.factor(J, scaled_.n, 1e-22)) return false;
  dz = -f;
  lu_.solve(dz.data());
  return dz.allFinite();
}

}  // namespace

Result<LcpSolution> cone_interior(const LcpProblem& problem, const LcpOptions& options) {
  if (Status c = check(problem); !c) return c.error();
  DensePath dense(problem);
  PathFollower path(dense, options);
  if (problem.size() > 0) path.follow();
  LcpSolution out = path_solution(problem, path);
  // What the path's end lacks in digits; of what is no solution Newton's method makes none.
  if (problem.size() > 0 && path.best_residual() > 0.1 * options.tolerance) {
    LcpOptions few = options;
    few.max_iterations = most_polish;
    if (auto polished = cone_newton_from(problem, few, out.z)) {
      out.report.iterations += polished->report.iterations;
      if (polished->report.residual < path.best_residual()) out.z = polished->z;
    }
  }
  settle(problem, options.tolerance, out);
  if (!out.report.solved()) out.report.status = LcpStatus::max_iterations;
  return out;
}

}  // namespace tumble::lcp
