#include "engine/math/lcp/sweep/sweep.hpp"

#include "engine/math/kernels.hpp"
#include "engine/math/lcp/cone.hpp"

namespace tumble::lcp {

Sweeper::Sweeper(const LcpProblem& problem, const ScaledProblem& scaled)
    : z(scaled.n), w(scaled.n), problem_(problem), p_(scaled), grouped_(size_t(scaled.n), 0) {
  for (int i = 0; i < p_.n; ++i) z[i] = std::clamp(0.0, p_.lower[i], p_.upper[i]);
  for (const ConeGroup& g : problem.groups)
    grouped_[size_t(g.axial)] = grouped_[size_t(g.lateral[0])] = grouped_[size_t(g.lateral[1])] = 1;
  renew();
}

void Sweeper::renew() {
  w = p_.b;
  for (int j = 0; j < p_.n; ++j)
    if (z[j] != 0) add_scaled(w.data(), z[j], p_.column(j), p_.n);
}

void Sweeper::change(int i, double to) {
  const double d = to - z[i];
  if (d == 0) return;
  z[i] = to;
  most_ = std::max(most_, std::fabs(d));
  add_scaled(w.data(), d, p_.column(i), p_.n);
}

void Sweeper::sweep_axial(const ConeGroup& g) {
  const int a = g.axial;
  double slope = p_.at(a, a);
  if (g.mode == ConeMode::sliding)
    slope -= g.slope *
             (p_.at(a, g.lateral[0]) * g.direction[0] + p_.at(a, g.lateral[1]) * g.direction[1]);
  if (slope > 1e-12) change(a, std::max(0.0, z[a] - w[a] / slope));
}

void Sweeper::sweep_lateral(const ConeGroup& g) {
  const int s = g.lateral[0], t = g.lateral[1];
  const double ss = p_.at(s, s), tt = p_.at(t, t), st = p_.at(s, t);
  const double greatest = 0.5 * (ss + tt) + std::sqrt(0.25 * (ss - tt) * (ss - tt) + st * st);
  const int steps = g.mode == ConeMode::sliding ? 1 : 3;
  for (int k = 0; k < steps; ++k) {
    const double f = greatest > 1e-12 ? 1 / greatest : 0;
    const auto to = nearest_lateral(g, z[g.axial], {z[s] - f * w[s], z[t] - f * w[t]});
    change(s, to[0]);
    change(t, to[1]);
  }
}

double Sweeper::sweep() {
  most_ = 0;
  for (int i = 0; i < p_.n; ++i) {
    if (grouped_[size_t(i)]) continue;
    const double a = p_.at(i, i);
    if (a > 0)
      change(i, std::clamp(z[i] - w[i] / a, p_.lower[i], p_.upper[i]));
    else if (w[i] != 0 && std::isfinite(w[i] < 0 ? p_.upper[i] : p_.lower[i]))
      change(i, w[i] < 0 ? p_.upper[i] : p_.lower[i]);
  }
  for (const ConeGroup& g : problem_.groups) {
    sweep_axial(g);
    sweep_lateral(g);
  }
  return most_;
}

}  // namespace tumble::lcp
