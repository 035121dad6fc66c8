#include "engine/math/lcp/interior/path_follower.hpp"

#include "engine/core/stop.hpp"
#include "engine/math/kernels.hpp"

#include <algorithm>
#include <cmath>

namespace tumble::lcp {
namespace {

constexpr int most_path_systems = 300;
constexpr int most_at_once = 12;   ///< Newton steps for one smoothing
constexpr double near_path = 0.5;  ///< |F|, of the smoothing, where the path counts as reached
constexpr double fastest = 0.05, slowest = 0.97;  ///< factors of the smoothing from step to step
constexpr double farthest = 1e6;  ///< smoothing at which the path is sought, of the greatest |b|

VecX in_units(VecX v, const std::vector<double>& d) {
  for (Eigen::Index i = 0; i < v.size(); ++i) v[i] /= d[size_t(i)];
  return v;
}

}  // namespace

PathFollower::PathFollower(PathProblem& problem, const LcpOptions& options)
    : problem_(problem),
      lower_(in_units(problem.conditions().lower, problem.units())),
      upper_(in_units(problem.conditions().upper, problem.units())),
      map_(problem.conditions().groups, problem.b(), lower_, upper_),
      values_(map_.units().size()),
      w_(problem.b()),
      f_(problem.b()),
      best_(VecX::Zero(problem.b().size())),
      goal_(std::min(1e-13, options.tolerance)),
      enough_(0.1 * options.tolerance),
      limit_(options.max_iterations > 0 ? options.max_iterations : most_path_systems) {}

double PathFollower::size() const {
  return std::sqrt(dot(f_.data(), f_.data(), int(f_.size())));
}

void PathFollower::evaluate(const VecX& z, double smoothing) {
  problem_.slack(z, w_);
  for (size_t k = 0; k < values_.size(); ++k) {
    const SmoothedMap::Unit& unit = map_.units()[k];
    values_[k] = map_.value(unit, z, w_, smoothing);
    for (size_t r = 0; r < size_t(unit.count); ++r) f_[unit.row[r]] = values_[k].f[r];
  }
}

/// To the point of the path with a smoothing.
bool PathFollower::reach(VecX& z, double smoothing) {
  evaluate(z, smoothing);
  double now = size();
  VecX dz, trial;
  for (int k = 0; k < most_at_once && systems_ < limit_ && !stop_requested(); ++k) {
    if (now <= near_path * smoothing) return true;
    ++systems_;
    if (!problem_.step(map_.units(), values_, f_, dz)) return false;
    double t = 1, next = 0;
    for (int half = 0; half < 20; ++half, t *= 0.5) {
      trial = z + t * dz;
      evaluate(trial, smoothing);
      next = size();
      if (next <= (1 - 1e-4 * t) * now) break;
    }
    if (!(next < now)) return false;
    z = trial;
    now = next;
  }
  return now <= near_path * smoothing;
}

bool PathFollower::consider(const VecX& z) {
  VecX plain = z;
  for (Eigen::Index i = 0; i < z.size(); ++i) plain[i] *= problem_.units()[size_t(i)];
  const double residual = problem_.residual(plain);
  if (residual < best_residual_) {
    best_residual_ = residual;
    best_ = plain;
  }
  return best_residual_ <= goal_;
}

void PathFollower::follow() {
  VecX z = VecX::Zero(lower_.size());
  for (Eigen::Index i = 0; i < z.size(); ++i) z[i] = std::clamp(0.0, lower_[i], upper_[i]);
  bool done = consider(z);
  const double scale = map_.scale();
  VecX there = z;
  double smoothing = scale, factor = 0.2, reached = 0;
  while (!done && systems_ < limit_ && smoothing > 1e-16 * scale && !stop_requested()) {
    const int before = systems_;
    if (reach(z, smoothing)) {
      there = z;
      reached = smoothing;
      done = consider(z);
      if (systems_ - before <= 4) factor = std::max(fastest, 0.5 * factor);
    } else if (reached == 0) {
      // The path is easy to find far from its end, where nothing but the smoothing counts.
      z = there;
      smoothing *= 10;
      if (smoothing > farthest * scale) return;
      continue;
    } else {
      // Rows that nearly depend on others end it sooner than rounding does.
      if (best_residual_ <= enough_ || reached <= 1e-12 * scale) return;
      z = there;
      factor = std::sqrt(factor);
      if (factor > slowest) return;
    }
    smoothing = reached * factor;
  }
}

LcpSolution path_solution(const LcpProblem& conditions, const PathFollower& path) {
  LcpSolution out;
  out.z = path.best();
  out.report.solver = "cone_interior";
  out.report.iterations = path.systems();
  out.report.status = LcpStatus::solved;
  for (Eigen::Index i = 0; i < out.z.size(); ++i)
    out.places.push_back(out.z[i] <= conditions.lower[i]   ? Place::lower
                         : out.z[i] >= conditions.upper[i] ? Place::upper
                                                           : Place::between);
  return out;
}

}  // namespace tumble::lcp
