#include "engine/math/lcp/validate.hpp"

#include "engine/math/kernels.hpp"
#include "engine/math/lcp/cone.hpp"
#include "engine/math/lcp/scaling.hpp"
#include "engine/math/lcp/tolerances.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tumble::lcp {
namespace {

constexpr double no_limit = std::numeric_limits<double>::infinity();

/// Residuals of one unknown with bounds, in units in which A_ii is 1 and the largest term is
/// `unit`.
void judge(double z, double w, double lower, double upper, double unit, LcpResidual& out) {
  out.bounds = std::max({out.bounds, (lower - z) / unit, (z - upper) / unit});
  const double projected = std::clamp(z - w, lower, upper);
  out.natural = std::max(out.natural, std::fabs(z - projected) / unit);
  const double room = std::max(0.0, w > 0 ? z - lower : upper - z);
  out.complementarity =
      std::max(out.complementarity, std::min(room / unit, 1.0) * (std::fabs(w) / unit));
}

void judge(const ConeGroup& g, double a, std::array<double, 2> t, std::array<double, 2> w,
           double unit, LcpResidual& out) {
  const auto size = [](double x, double y) { return std::sqrt(x * x + y * y); };
  const auto inside = nearest_lateral(g, a, t);
  out.bounds = std::max(out.bounds, size(t[0] - inside[0], t[1] - inside[1]) / unit);
  const auto pushed = nearest_lateral(g, a, {t[0] - w[0], t[1] - w[1]});
  const double move = size(t[0] - pushed[0], t[1] - pushed[1]) / unit;
  out.natural = std::max(out.natural, move);
  if (g.mode == ConeMode::sliding) return;
  out.complementarity =
      std::max(out.complementarity, std::min(move, 1.0) * (size(w[0], w[1]) / unit));
}

/// Computes w = A z + b; returns the largest term, infinite if it or z is not finite.
double weigh(const LcpProblem& p, const VecX& z, const std::vector<double>& d, VecX& w) {
  const int n = p.size();
  w = p.b;
  VecX terms = p.b.cwiseAbs();
  for (int j = 0; j < n; ++j) {
    if (!std::isfinite(z[j])) return no_limit;
    if (z[j] == 0) continue;
    const double* column = p.A.data() + std::ptrdiff_t(j) * n;
    const double zj = z[j];
    double *wi = w.data(), *ti = terms.data();
    for (int i = 0; i < n; ++i) {
      const double term = column[i] * zj;
      wi[i] += term;
      ti[i] += std::fabs(term);
    }
  }
  double unit = 0;
  for (int i = 0; i < n; ++i) unit = std::max(unit, terms[i] * d[size_t(i)]);
  return unit == 0 ? 1 : unit == unit ? unit : no_limit;
}

}  // namespace

VecX slack(const LcpProblem& p, const VecX& z) {
  VecX w = p.b;
  for (int j = 0; j < p.size(); ++j)
    if (z[j] != 0) add_scaled(w.data(), z[j], p.A.data() + std::ptrdiff_t(j) * p.size(), p.size());
  return w;
}

LcpResidual validate(const LcpProblem& p, const VecX& z) {
  VecX w;
  return validate(p, z, w);
}

LcpResidual validate(const LcpProblem& p, const VecX& z, VecX& w) {
  const std::vector<double> d = scaling_of(p);
  const double unit = weigh(p, z, d, w);
  return judge(p, d, unit, z, w);
}

LcpResidual judge(const LcpProblem& p, const std::vector<double>& d, double unit, const VecX& z,
                  const VecX& w) {
  if (!std::isfinite(unit)) return {no_limit, no_limit, no_limit, 1};
  const int n = p.size();
  LcpResidual out;
  out.unit = unit;
  std::vector<bool> lateral(size_t(n), false);
  for (const ConeGroup& g : p.groups) {
    const int s = g.lateral[0], t = g.lateral[1];
    const double u = d[size_t(g.axial)];
    lateral[size_t(s)] = lateral[size_t(t)] = true;
    judge(g, z[g.axial] / u, {z[s] / u, z[t] / u}, {w[s] * u, w[t] * u}, unit, out);
  }
  for (int i = 0; i < n; ++i) {
    const double u = d[size_t(i)];
    if (!lateral[size_t(i)]) judge(z[i] / u, w[i] * u, p.lower[i] / u, p.upper[i] / u, unit, out);
  }
  return out;
}

double term_unit(const LcpProblem& p, const VecX& z) {
  VecX w;
  return weigh(p, z, scaling_of(p), w);
}

double ray_residual(const LcpProblem& p, const VecX& ray) {
  const int n = p.size();
  if (ray.size() != n) return no_limit;
  const double gain = -dot(p.b.data(), ray.data(), n);
  if (!(gain > 0)) return no_limit;
  const std::vector<double> d = scaling_of(p);
  VecX change = VecX::Zero(n);
  double length = 0, b_size = 0, worst = 0;
  for (int j = 0; j < n; ++j) {
    length = std::max(length, std::fabs(ray[j]) / d[size_t(j)]);
    b_size = std::max(b_size, std::fabs(p.b[j]) * d[size_t(j)]);
    add_scaled(change.data(), ray[j], p.A.data() + std::ptrdiff_t(j) * n, n);
  }
  for (int i = 0; i < n; ++i) {
    const double u = d[size_t(i)], r = ray[i] / u;
    worst = std::max(worst, std::fabs(change[i]) * u * (b_size / gain));
    if ((r > 0 && p.upper[i] < no_limit) || (r < 0 && p.lower[i] > -no_limit))
      worst = std::max(worst, std::fabs(r) / length * (b_size * length / gain));
  }
  return worst;
}

VecX nearest_to_zero(const LcpProblem& problem) {
  VecX rest = VecX::Zero(problem.size());
  for (int i = 0; i < problem.size(); ++i)
    rest[i] = std::clamp(0.0, problem.lower[i], problem.upper[i]);
  return rest;
}

void grade(const LcpResidual& r, double rest_unit, double tolerance, LcpSolution& s) {
  s.report.residual = r.worst();
  s.report.complementarity = r.complementarity;
  if (!s.report.solved()) return;
  const bool tiny = r.worst() * r.unit <= tolerances::of_rest_terms * rest_unit;
  if (!(r.worst() <= tolerance) || !tiny) s.report.status = LcpStatus::numeric;
}

void grade(const LcpProblem& problem, double tolerance, LcpSolution& s) {
  const LcpResidual r = validate(problem, s.z, s.w);
  grade(r, s.report.solved() ? term_unit(problem, nearest_to_zero(problem)) : 1, tolerance, s);
}

}  // namespace tumble::lcp
