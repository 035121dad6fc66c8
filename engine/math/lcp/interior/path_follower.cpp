#include "engine/math/lcp/interior/path_follower.hpp"

#include "engine/core/stop.hpp"
#include "engine/math/kernels.hpp"
#include "engine/math/lcp/interior/smoothed_map.hpp"
#include "engine/math/lcp/newton/semismooth_newton.hpp"
#include "engine/math/lcp/tolerances.hpp"

#include <algorithm>
#include <cmath>

namespace tumble::lcp {
namespace {

constexpr NewtonLimits end_limits{60, 60, 2600};

class PathFollower {
 public:
  PathFollower(ConeSystem& system, const LcpOptions& options, double weight)
      : system_(system),
        weight_(weight),
        values_(system.parts().size()),
        w_(system.size()),
        f_(system.size()),
        best_(system.size()),
        goal_(std::min(tolerances::best_residual, options.tolerance)),
        enough_(0.1 * options.tolerance),
        limit_(options.max_iterations > 0 ? options.max_iterations
                                          : tolerances::most_path_systems) {
    for (const double b : system.b()) scale_ = std::max(scale_, std::fabs(b));
    if (scale_ == 0) scale_ = 1;
  }

  void follow();
  const BestPoint& best() const { return best_; }

 private:
  double evaluate(const VecX& z, double smoothing);
  bool reach(VecX& z, double smoothing);
  bool consider(const VecX& z);

  ConeSystem& system_;
  double weight_;
  std::vector<UnitValue> values_;
  VecX w_, f_;
  BestPoint best_;
  double scale_ = 0;  ///< the greatest |b|
  double goal_, enough_;
  int limit_;
};

/// |F|
double PathFollower::evaluate(const VecX& z, double smoothing) {
  system_.slack(z, w_);
  for (size_t k = 0; k < values_.size(); ++k) {
    const ConeUnit& unit = system_.parts()[k];
    values_[k] = smoothed_value(unit, unit.of(z), unit.of(w_), smoothing, scale_);
    for (size_t r = 0; r < size_t(unit.count); ++r) f_[unit.row[r]] = values_[k].f[r];
  }
  return std::sqrt(dot(f_.data(), f_.data(), system_.size()));
}

/// Goes to the point of the path with this smoothing.
bool PathFollower::reach(VecX& z, double smoothing) {
  double now = evaluate(z, smoothing);
  VecX dz, trial;
  for (int k = 0; k < tolerances::most_path_steps && system_.systems < limit_ && !stop_requested();
       ++k) {
    if (now <= tolerances::near_path * smoothing) return true;
    if (!system_.step(values_, f_, weight_, dz)) return false;
    double t = 1, next = 0;
    for (int half = 0; half < 20; ++half, t *= 0.5) {
      trial = z + t * dz;
      next = evaluate(trial, smoothing);
      if (next <= (1 - tolerances::path_descent * t) * now) break;
    }
    if (!(next < now)) return false;
    z = trial;
    now = next;
  }
  return now <= tolerances::near_path * smoothing;
}

bool PathFollower::consider(const VecX& z) {
  best_.consider(system_, z);
  return best_.residual <= goal_;
}

void PathFollower::follow() {
  VecX z = system_.rest();
  bool done = consider(z);
  VecX there = z;
  double smoothing = scale_, factor = 0.2, reached = 0;
  while (!done && system_.systems < limit_ && smoothing > tolerances::path_end * scale_ &&
         !stop_requested()) {
    const int before = system_.systems;
    if (reach(z, smoothing)) {
      there = z;
      reached = smoothing;
      done = consider(z);
      if (system_.systems - before <= 4) factor = std::max(tolerances::fastest_path, 0.5 * factor);
    } else if (reached == 0) {
      // The path is easy to find at large smoothing, which then dominates all other terms.
      z = there;
      smoothing *= 10;
      if (smoothing > tolerances::farthest_path * scale_) return;
      continue;
    } else {
      // Rows that nearly depend on others end the path before rounding does.
      if (best_.residual <= enough_ || reached <= tolerances::nearly_path_end * scale_) return;
      z = there;
      factor = std::sqrt(factor);
      if (factor > tolerances::slowest_path) return;
    }
    smoothing = reached * factor;
  }
}

}  // namespace

LcpSolution solve_along_path(ConeSystem& system, const LcpOptions& options, double weight,
                             double polish_above) {
  LcpSolution out;
  PathFollower path(system, options, weight);
  if (system.size() > 0) path.follow();
  out.z = path.best().z;
  // Newton's method cannot turn a result far from a solution into one.
  if (system.size() > 0 && path.best().residual > polish_above) {
    LcpOptions few = options;
    few.max_iterations = end_limits.systems;
    SemismoothNewton newton(system, end_limits, few);
    const VecX z = system.in_scaled_units(out.z);
    if (!newton.attempt(z)) newton.attempt_after_sweeps(z);
    if (newton.best().residual < path.best().residual) out.z = newton.best().z;
  }
  out.report.solver = "cone_interior";
  out.report.iterations = system.systems;
  grade_iterated(system, options, out);
  return out;
}

}  // namespace tumble::lcp
