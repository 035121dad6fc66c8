#include "engine/math/lcp/newton/natural_map.hpp"

#include "engine/math/kernels.hpp"
#include "engine/math/lcp/cone.hpp"

namespace tumble::lcp {

NaturalMap::NaturalMap(const LcpProblem& problem, const ScaledProblem& scaled)
    : centre(VecX::Zero(scaled.n)),
      problem_(problem),
      p_(scaled),
      z_(scaled.n),
      w_(scaled.n),
      f_(scaled.n),
      step_(scaled.n),
      grouped_(size_t(scaled.n), 0),
      place_(size_t(scaled.n), -1) {
  for (const ConeGroup& g : problem.groups)
    grouped_[size_t(g.axial)] = grouped_[size_t(g.lateral[0])] = grouped_[size_t(g.lateral[1])] = 1;
}

void NaturalMap::evaluate(const VecX& z) {
  z_ = z;
  for (int i = 0; i < p_.n; ++i) w_[i] = p_.b[i] + regularisation * (z[i] - centre[i]);
  std::vector<int> columns;
  std::vector<double> factors;
  for (int j = 0; j < p_.n; ++j) {
    if (z[j] == 0) continue;
    columns.push_back(j);
    factors.push_back(z[j]);
  }
  add_columns(w_.data(), p_.A.data(), p_.n, columns.data(), factors.data(), int(columns.size()),
              p_.n);
  for (int i = 0; i < p_.n; ++i)
    if (!grouped_[size_t(i)]) f_[i] = z[i] - std::clamp(z[i] - w_[i], p_.lower[i], p_.upper[i]);
  for (const ConeGroup& g : problem_.groups) evaluate_group(g, z);
}

void NaturalMap::evaluate_group(const ConeGroup& g, const VecX& z) {
  const int a = g.axial, s = g.lateral[0], t = g.lateral[1];
  const double axial = std::max(0.0, z[a] - w_[a]);
  f_[a] = z[a] - axial;
  const auto to = nearest_lateral(g, axial, {z[s] - w_[s], z[t] - w_[t]});
  f_[s] = z[s] - to[0];
  f_[t] = z[t] - to[1];
}

double NaturalMap::merit() const {
  return 0.5 * dot(f_.data(), f_.data(), p_.n);
}

void NaturalMap::set_still(int i) {
  step_[i] = -f_[i];
}

void NaturalMap::set_equation(int i) {
  Row row{i};
  row.slack[0] = i;
  row.slack_value[0] = 1;
  rows_.push_back(row);
}

void NaturalMap::add_group_rows(const ConeGroup& g) {
  const int a = g.axial;
  const double axial = z_[a] - w_[a];
  if (axial <= 0) {
    set_still(a);
    set_still(g.lateral[0]);
    set_still(g.lateral[1]);
    return;
  }
  set_equation(a);
  // F_t = z_t - P(slope (z_a - w_a), z_t - w_t)
  const double radius = g.slope * axial;
  const std::array<double, 2> r{z_[g.lateral[0]] - w_[g.lateral[0]],
                                z_[g.lateral[1]] - w_[g.lateral[1]]};
  const double length = std::sqrt(r[0] * r[0] + r[1] * r[1]);
  for (size_t k = 0; k < 2; ++k) {
    const int t = g.lateral[k], other = g.lateral[1 - k];
    Row row{t};
    const auto slides = [&](double u) {  // F_t = z_t - u slope (z_a - w_a)
      row.plain = {t, a, -1};
      row.plain_value = {1, -g.slope * u, 0};
      row.slack = {a, -1, -1};
      row.slack_value = {g.slope * u, 0, 0};
    };
    if (g.mode == ConeMode::sliding) {
      slides(-g.direction[k]);
    } else if (g.shape == ConeShape::pyramid) {
      if (std::fabs(r[k]) <= radius) {
        set_equation(t);
        continue;
      }
      slides(r[k] > 0 ? 1 : -1);
    } else if (length <= radius) {
      set_equation(t);
      continue;
    } else {
      const double f = radius / length, u = r[k] / length, v = r[1 - k] / length;
      slides(u);
      row.plain[2] = other;
      row.plain_value = {1 - f * (1 - u * u), -g.slope * u, f * u * v};
      row.slack = {a, t, other};
      row.slack_value = {g.slope * u, f * (1 - u * u), -f * u * v};
    }
    rows_.push_back(row);
  }
}

void NaturalMap::fill_row(const Row& row, int r, int m, std::vector<double>& a,
                          double& right) const {
  const auto at = [&](int column) -> double& { return a[size_t(column) * size_t(m) + size_t(r)]; };
  // A symmetric A is read by columns; for the sake of others, the transposed entries are not
  // assumed.
  for (size_t k = 0; k < 3; ++k) {
    if (row.slack[k] < 0) continue;
    const int i = row.slack[k];
    const double f = row.slack_value[k];
    for (int c = 0; c < m; ++c) at(c) += f * p_.at(i, active_[size_t(c)]);
    for (int j = 0; j < p_.n; ++j)
      if (place_[size_t(j)] < 0) right -= f * p_.at(i, j) * step_[j];
    if (place_[size_t(i)] >= 0)
      at(place_[size_t(i)]) += f * regularisation;
    else
      right -= f * regularisation * step_[i];
  }
  for (size_t k = 0; k < 3; ++k) {
    if (row.plain[k] < 0) continue;
    const int place = place_[size_t(row.plain[k])];
    if (place >= 0)
      at(place) += row.plain_value[k];
    else
      right -= row.plain_value[k] * step_[row.plain[k]];
  }
}

bool NaturalMap::step(VecX& dz) {
  rows_.clear();
  for (int i = 0; i < p_.n; ++i) {
    if (grouped_[size_t(i)]) continue;
    const double to = z_[i] - w_[i];
    if (to > p_.lower[i] && to < p_.upper[i])
      set_equation(i);
    else
      set_still(i);
  }
  for (const ConeGroup& g : problem_.groups) add_group_rows(g);
  active_.clear();
  std::fill(place_.begin(), place_.end(), -1);
  for (const Row& row : rows_) {
    place_[size_t(row.unknown)] = int(active_.size());
    active_.push_back(row.unknown);
  }
  const int m = int(active_.size());
  std::vector<double> a(size_t(m) * size_t(m), 0.0), x(size_t(m), 0.0);
  for (int r = 0; r < m; ++r) {
    const Row& row = rows_[size_t(r)];
    // Rows that are equations w_i = 0 have F_i = w_i.
    x[size_t(r)] = -f_[row.unknown];
    fill_row(row, r, m, a, x[size_t(r)]);
  }
  if (m > 0 && !lu_.factor(a, m, 1e-18)) return false;
  if (m > 0) lu_.solve(x.data());
  for (int r = 0; r < m; ++r) step_[active_[size_t(r)]] = x[size_t(r)];
  dz = step_;
  return true;
}

}  // namespace tumble::lcp
