#include "engine/math/lcp/cone_newton.hpp"

#include "engine/math/lcp/natural_map.hpp"
#include "engine/math/lcp/sweep.hpp"
#include "engine/math/lcp/validate.hpp"

#include <algorithm>
#include <cmath>

namespace tumble::lcp {
namespace {

class ConeNewton {
 public:
  ConeNewton(const LcpProblem& problem, const LcpOptions& options)
      : problem_(problem),
        scaled_(problem),
        map_(problem, scaled_),
        goal_(std::min(1e-13, options.tolerance)),
        limit_(options.max_iterations > 0 ? options.max_iterations : 1000) {}

  LcpSolution run(const LcpOptions& options, const VecX* start);

 private:
  bool inner(VecX& z);
  bool attempt(VecX z, double weight, bool about_zero);
  void consider(const VecX& z);

  const LcpProblem& problem_;
  const ScaledProblem scaled_;
  NaturalMap map_;
  double goal_;
  int limit_, iterations_ = 0;
  VecX best_;  // in the problem's units
  double best_residual_ = std::numeric_limits<double>::infinity();
};

void ConeNewton::consider(const VecX& z) {
  VecX plain = z;
  for (int i = 0; i < scaled_.n; ++i) plain[i] *= scaled_.d[size_t(i)];
  const double residual = validate(problem_, plain).worst();
  if (residual < best_residual_) {
    best_residual_ = residual;
    best_ = plain;
  }
}

/// Newton on the map as it is; true when F is as small as rounding allows.
bool ConeNewton::inner(VecX& z) {
  VecX dz, trial;
  map_.evaluate(z);
  double merit = map_.merit();
  const double size =
      1e-30 * std::max(1e-300, scaled_.b.cwiseAbs().maxCoeff() * scaled_.b.cwiseAbs().maxCoeff());
  for (int k = 0; k < 60 && iterations_ < limit_; ++k) {
    if (!(merit > size)) return true;
    ++iterations_;
    if (!map_.step(dz)) return false;
    double t = 1, next = 0, least = std::numeric_limits<double>::infinity(), best_t = 0;
    for (int half = 0; half < 12; ++half, t *= 0.5) {
      trial = z + t * dz;
      map_.evaluate(trial);
      next = map_.merit();
      if (next < least) {
        least = next;
        best_t = t;
      }
      if (next <= (1 - 1e-3 * t) * merit) break;
    }
    if (!(least < merit * (1 - 1e-6))) return merit <= 1e6 * size;
    z += best_t * dz;
    map_.evaluate(z);
    merit = least;
  }
  return !(merit > size);
}

/// Proximal steps of the given weight; the first about 0, or about z.
bool ConeNewton::attempt(VecX z, double weight, bool about_zero) {
  map_.regularisation = weight;
  if (about_zero)
    map_.centre.setZero();
  else
    map_.centre = z;
  int idle = 0;
  for (int k = 0; k < 60 && idle < 3; ++k) {
    const bool converged = inner(z);
    const double before = best_residual_;
    consider(z);
    if (best_residual_ <= goal_) return true;
    if (!converged) break;
    idle = best_residual_ > 0.5 * before ? idle + 1 : 0;
    map_.centre = z;
  }
  return best_residual_ <= 100 * goal_;
}

LcpSolution ConeNewton::run(const LcpOptions& options, const VecX* start) {
  LcpSolution out;
  out.report.solver = "cone_newton";
  Sweeper sweeper(problem_, scaled_);
  bool done = scaled_.n == 0;
  best_ = VecX::Zero(scaled_.n);
  if (!done && start) {
    VecX z = *start;
    for (int i = 0; i < scaled_.n; ++i) z[i] /= scaled_.d[size_t(i)];
    done = attempt(z, 1e-7, true);
    if (!done) sweeper.z = z;
    sweeper.renew();
  } else if (!done) {
    done = attempt(sweeper.z, 1e-7, true);
  }
  for (int sweeps = 10; !done && sweeps <= 20000 && iterations_ < limit_; sweeps *= 4) {
    bool finite = true;
    for (int k = 0; k < sweeps && finite; ++k) {
      const double moved = sweeper.sweep();
      finite = moved < 1e100;
      if (moved == 0) break;
    }
    if (!finite) break;
    sweeper.renew();
    consider(sweeper.z);
    done = attempt(sweeper.z, 1e-7, true);
    for (const double weight : {1e-4, 1e-2, 1e-10})
      done = done || attempt(sweeper.z, weight, false);
  }
  out.z = best_;
  out.report.iterations = iterations_;
  out.report.status = LcpStatus::solved;
  settle(problem_, options.tolerance, out);
  if (!out.report.solved()) out.report.status = LcpStatus::max_iterations;
  for (int i = 0; i < scaled_.n; ++i)
    out.places.push_back(out.z[i] <= problem_.lower[i]   ? Place::lower
                         : out.z[i] >= problem_.upper[i] ? Place::upper
                                                         : Place::between);
  return out;
}

}  // namespace

Result<LcpSolution> cone_newton(const LcpProblem& problem, const LcpOptions& options) {
  if (Status c = check(problem); !c) return c.error();
  return ConeNewton(problem, options).run(options, nullptr);
}

Result<LcpSolution> cone_newton_from(const LcpProblem& problem, const LcpOptions& options,
                                     const VecX& z) {
  if (Status c = check(problem); !c) return c.error();
  if (z.size() != problem.size() || !z.allFinite())
    return Error{ErrorCode::invalid_argument,
                 "the start is not finite, or not of the problem's size",
                 "lcp",
                 {}};
  return ConeNewton(problem, options).run(options, &z);
}

}  // namespace tumble::lcp
