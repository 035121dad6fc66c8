#include "engine/math/lcp/system/dense_system.hpp"

#include "engine/core/work_meter.hpp"
#include "engine/math/kernels.hpp"
#include "engine/math/lcp/tolerances.hpp"
#include "engine/math/lcp/validate.hpp"

#include <algorithm>
#include <cmath>

namespace tumble::lcp {
namespace {

/// Whether a row of a unit is simply dz_i = -f_i.
bool says_itself(const UnitValue& value, size_t r) {
  for (size_t q = 0; q < 3; ++q)
    if (value.by_w[3 * r + q] != 0 || value.by_z[3 * r + q] != (q == r ? 1 : 0)) return false;
  return true;
}

}  // namespace

DenseSystem::DenseSystem(const LcpProblem& problem)
    : problem_(problem),
      scaled_(problem),
      parts_(cone_units(problem, scaled_.d)),
      own_(parts_.size()),
      place_(size_t(scaled_.n)) {
  for (size_t k = 0; k < parts_.size(); ++k)
    for (size_t r = 0; r < size_t(parts_[k].count); ++r)
      for (size_t q = 0; q < size_t(parts_[k].count); ++q)
        own_[k][3 * r + q] = scaled_.at(parts_[k].row[r], parts_[k].row[q]);
}

void DenseSystem::slack(const VecX& z, VecX& w) {
  charge_work(size_t(scaled_.n), size_t(scaled_.n) + 20);
  w = scaled_.b;
  std::vector<int> columns;
  std::vector<double> factors;
  for (int j = 0; j < scaled_.n; ++j) {
    if (z[j] == 0) continue;
    columns.push_back(j);
    factors.push_back(z[j]);
  }
  add_columns(w.data(), scaled_.A.data(), scaled_.n, columns.data(), factors.data(),
              int(columns.size()), scaled_.n);
}

/// Adds the row of a unit's r-th unknown to the linear system; terms of known dz go to the
/// right-hand side.
void DenseSystem::add_row(const ConeUnit& unit, const UnitValue& value, size_t r, double weight,
                          const VecX& dz) {
  const size_t m = active_.size(), own_row = size_t(place_[size_t(unit.row[r])]);
  const auto at = [&](size_t column) -> double& { return matrix_[column * m + own_row]; };
  const auto add = [&](int unknown, double f) {
    if (const int c = place_[size_t(unknown)]; c >= 0)
      at(size_t(c)) += f;
    else
      right_[own_row] -= f * dz[unknown];
  };
  // Each lateral row begins with its own entry, so that mirror images have the same rounding.
  const std::array<size_t, 3> order =
      r == 2 ? std::array<size_t, 3>{0, 2, 1} : std::array<size_t, 3>{0, 1, 2};
  for (const size_t q : order) {
    const double f = value.by_w[3 * r + q];
    if (f == 0) continue;
    const int i = unit.row[q];
    // A need not be symmetric: rows are read, although columns would be contiguous.
    for (size_t c = 0; c < m; ++c) at(c) += f * scaled_.at(i, active_[c]);
    for (int j = 0; j < scaled_.n; ++j)
      if (place_[size_t(j)] < 0) right_[own_row] -= f * scaled_.at(i, j) * dz[j];
    add(i, f * weight);
  }
  for (const size_t q : order)
    if (const double f = value.by_z[3 * r + q]; f != 0) add(unit.row[q], f);
}

bool DenseSystem::step(std::span<const UnitValue> values, const VecX& f, double weight, VecX& dz) {
  ++systems;
  charge_work(size_t(scaled_.n), size_t(scaled_.n), 3);
  dz = -f;
  std::fill(place_.begin(), place_.end(), 0);
  for (size_t k = 0; k < parts_.size(); ++k)
    for (size_t r = 0; r < size_t(parts_[k].count); ++r)
      if (says_itself(values[k], r)) place_[size_t(parts_[k].row[r])] = -1;
  active_.clear();
  for (int i = 0; i < scaled_.n; ++i) {
    if (place_[size_t(i)] < 0) continue;
    place_[size_t(i)] = int(active_.size());
    active_.push_back(i);
  }
  const size_t m = active_.size();
  if (m == 0) return true;
  matrix_.assign(m * m, 0.0);
  right_.resize(m);
  for (size_t c = 0; c < m; ++c) right_[c] = -f[active_[c]];
  for (size_t k = 0; k < parts_.size(); ++k)
    for (size_t r = 0; r < size_t(parts_[k].count); ++r)
      if (place_[size_t(parts_[k].row[r])] >= 0) add_row(parts_[k], values[k], r, weight, dz);
  if (!lu_.factor(matrix_, int(m), tolerances::lost_pivot)) return false;
  lu_.solve(right_.data());
  for (size_t c = 0; c < m; ++c) dz[active_[c]] = right_[c];
  return dz.allFinite();
}

double DenseSystem::residual(const VecX& z) {
  charge_work(size_t(scaled_.n), size_t(scaled_.n) + 20);
  return validate(problem_, z).worst();
}

void DenseSystem::grade(double tolerance, LcpSolution& solution) {
  lcp::grade(problem_, tolerance, solution);
}

void DenseSystem::start_sweeps(const VecX& z) {
  swept_w_ = scaled_.b;
  for (int j = 0; j < scaled_.n; ++j)
    if (z[j] != 0) add_scaled(swept_w_.data(), z[j], scaled_.column(j), scaled_.n);
}

void DenseSystem::swept(size_t part, const Triple& by) {
  charge_work(size_t(scaled_.n), 3);
  for (size_t r = 0; r < size_t(parts_[part].count); ++r)
    if (by[r] != 0)
      add_scaled(swept_w_.data(), by[r], scaled_.column(parts_[part].row[r]), scaled_.n);
}

}  // namespace tumble::lcp
