#include "engine/math/lcp/newton/cone_newton.hpp"

#include "engine/core/stop.hpp"
#include "engine/math/kernels.hpp"
#include "engine/math/lcp/newton/natural_map.hpp"
#include "engine/math/lcp/pivoting/ldl.hpp"
#include "engine/math/lcp/sweep/sweep.hpp"
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
  bool start_inside(VecX& z);

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
  for (int k = 0; k < 60 && iterations_ < limit_ && !stop_requested(); ++k) {
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
  for (int k = 0; k < 60 && idle < 3 && !stop_requested(); ++k) {
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

/// The solution with all rows of groups and of free unknowns as equations, which is that of the
/// problem where no cone nor bound matters; made regular and converged like attempt(), with one
/// symmetric factorisation. True when it is the solution.
bool ConeNewton::start_inside(VecX& z) {
  std::vector<char> equation(size_t(scaled_.n), 0);
  for (const ConeGroup& g : problem_.groups)
    for (const int i : {g.axial, g.lateral[0], g.lateral[1]}) equation[size_t(i)] = 1;
  LdlFactor factor;
  factor.reset(scaled_.n);
  std::vector<double> y(static_cast<size_t>(scaled_.n));
  for (int i = 0; i < scaled_.n; ++i) {
    const bool is_free = std::isinf(scaled_.lower[i]) && std::isinf(scaled_.upper[i]);
    if (!equation[size_t(i)] && !is_free) continue;
    if (stop_requested()) return false;
    const auto& members = factor.members();
    for (size_t k = 0; k < members.size(); ++k) y[k] = scaled_.column(i)[members[k]];
    factor.forward(y.data());
    const double left = factor.remainder(scaled_.at(i, i) + 1e-7, y.data());
    if (!(left > 1e-9)) return false;
    factor.append(i, y.data(), left);
  }
  ++iterations_;
  const auto& members = factor.members();
  for (int pass = 0; pass < 4; ++pass) {
    const double before = best_residual_;
    VecX w = scaled_.b;
    for (int j = 0; j < scaled_.n; ++j)
      if (z[j] != 0) add_scaled(w.data(), z[j], scaled_.column(j), scaled_.n);
    for (size_t k = 0; k < members.size(); ++k) y[k] = -w[members[k]];
    factor.solve(y.data());
    for (size_t k = 0; k < members.size(); ++k) z[members[k]] += y[k];
    consider(z);
    if (best_residual_ <= goal_) return true;
    if (pass == 0 ? best_residual_ > 1e-3 : best_residual_ > 0.1 * before) break;
  }
  return best_residual_ <= goal_;
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
    VecX z = sweeper.z;
    done = !problem_.groups.empty() && start_inside(z);
    if (!done && !problem_.groups.empty()) done = attempt(z, 1e-7, true);
    done = done || attempt(sweeper.z, 1e-7, true);
  }
  for (int sweeps = 10; !done && sweeps <= 20000 && iterations_ < limit_; sweeps *= 4) {
    bool finite = true;
    for (int k = 0; k < sweeps && finite; ++k) {
      const double moved = sweeper.sweep();
      finite = moved < 1e100 && !stop_requested();
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
