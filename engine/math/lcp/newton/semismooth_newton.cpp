#include "engine/math/lcp/newton/semismooth_newton.hpp"

#include "engine/core/stop.hpp"
#include "engine/math/kernels.hpp"
#include "engine/math/lcp/newton/natural_map.hpp"
#include "engine/math/lcp/tolerances.hpp"

#include <algorithm>
#include <limits>

namespace tumble::lcp {
SemismoothNewton::SemismoothNewton(ConeSystem& system, const NewtonLimits& limits,
                                   const LcpOptions& options)
    : system_(system),
      limits_(limits),
      goal_(std::min(tolerances::best_residual, options.tolerance)),
      limit_(options.max_iterations > 0 ? options.max_iterations : limits.systems),
      first_system_(system.systems),
      w_(system.size()),
      f_(system.size()),
      best_(system.size()),
      values_(system.parts().size()) {}

/// Computes F and w at z; returns half the square of F.
double SemismoothNewton::evaluate(const VecX& z) {
  system_.slack(z, w_);
  for (const ConeUnit& unit : system_.parts()) {
    const Triple f = natural_value(unit, unit.of(z), unit.of(w_));
    for (size_t r = 0; r < size_t(unit.count); ++r) f_[unit.row[r]] = f[r];
  }
  return 0.5 * dot(f_.data(), f_.data(), system_.size());
}

/// The Newton step at the point of the last evaluate(); `inside`: as if all undecided groups were
/// inside their cones.
bool SemismoothNewton::step(const VecX& z, bool inside, double weight, VecX& dz) {
  VecX f = f_;
  for (size_t k = 0; k < values_.size(); ++k) {
    const ConeUnit& unit = system_.parts()[k];
    if (inside && unit.group && unit.group->mode == ConeMode::undecided) {
      values_[k] = {{}, {}, {1, 0, 0, 0, 1, 0, 0, 0, 1}};
      for (const int i : unit.row) f[i] = w_[i];
    } else {
      set_natural_slope(unit, unit.of(z), unit.of(w_), values_[k]);
    }
  }
  return system_.step(values_, f, weight, dz);
}

/// Moves z by a part of dz that reduces the merit; returns the share of it that is left, 1 if there
/// is no such part.
double SemismoothNewton::search_line(VecX& z, const VecX& dz, double& merit) {
  const double before = merit;
  double t = 1;
  VecX trial;
  for (int half = 0; half < tolerances::most_newton_halvings; ++half, t *= 0.5) {
    trial = z + t * dz;
    const double now = evaluate(trial);
    if (!(now <= (1 - tolerances::newton_descent * t) * before)) continue;
    z.swap(trial);
    merit = now;
    return now / before;
  }
  return 1;
}

bool SemismoothNewton::consider(const VecX& z) {
  best_.consider(system_, z);
  return best_.residual <= goal_;
}

bool SemismoothNewton::attempt(VecX z, double weight) {
  VecX dz(z.size());
  double merit = evaluate(z);
  bool done = consider(z);
  for (int k = 0, idle = 0; !done && k < limits_.steps && may_go_on() && !stop_requested(); ++k) {
    if (!step(z, false, weight, dz)) break;
    const double left = search_line(z, dz, merit);
    idle = left > 0.5 ? idle + 1 : 0;
    done = consider(z) || left == 1 || idle == tolerances::most_idle_steps;
  }
  return best_.residual <= tolerances::good_enough * goal_;
}

bool SemismoothNewton::attempt_inside() {
  VecX z = VecX::Zero(system_.size()), dz = z;
  evaluate(z);
  return attempt(step(z, true, usual_weight, dz) ? dz : z);
}

bool SemismoothNewton::attempt_after_sweeps(VecX z) {
  for (int sweeps = 10; sweeps <= limits_.sweeps && may_go_on(); sweeps *= 4) {
    system_.start_sweeps(z);
    double moved = 1;
    for (int k = 0; k < sweeps && moved > 0; ++k) {
      moved = system_.sweep(z);
      if (!(moved < tolerances::diverged_sweep) || stop_requested()) return false;
    }
    if (consider(z) || attempt(z)) return true;
    for (const double weight : tolerances::other_weights)
      if (attempt(z, weight)) return true;
  }
  return false;
}

LcpSolution SemismoothNewton::answer(const LcpOptions& options) const {
  LcpSolution out;
  out.z = best_.z;
  out.report.solver = "cone_newton";
  out.report.iterations = systems();
  grade_iterated(system_, options, out);
  return out;
}

Status check_start(const LcpProblem& conditions, const VecX& start) {
  if (start.size() == conditions.size() && start.allFinite()) return {};
  return Error{ErrorCode::invalid_argument,
               "the start is not finite, or not of the problem's size",
               "lcp",
               {}};
}

}  // namespace tumble::lcp
