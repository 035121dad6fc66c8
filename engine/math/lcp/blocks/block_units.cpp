#include "engine/math/lcp/blocks/block_units.hpp"

#include "engine/math/lcp/scaling.hpp"

#include <algorithm>
#include <cmath>

namespace tumble::lcp {
namespace {

double dot6(const double* a, const double* b) {
  double sum = 0;
  for (size_t k = 0; k < 6; ++k) sum += a[k] * b[k];
  return sum;
}

BlockUnit block_unit(const BlockProblem& p, const std::vector<double>& d, const ConeGroup* group,
                     int single) {
  BlockUnit unit;
  unit.group = group;
  if (group) {
    unit.count = 3;
    unit.row = {group->axial, group->lateral[0], group->lateral[1]};
  } else {
    unit.row[0] = single;
    unit.lower = p.conditions.lower[single] / d[size_t(single)];
    unit.upper = p.conditions.upper[single] / d[size_t(single)];
  }
  unit.block = p.rows[size_t(unit.row[0])].block;
  const auto count = size_t(unit.count);
  for (size_t r = 0; r < count; ++r) {
    const auto i = size_t(unit.row[r]);
    for (size_t s = 0; s < 2; ++s)
      for (size_t k = 0; k < 6; ++k) unit.g[s][6 * r + k] = d[i] * p.rows[i].entries[s][k];
  }
  for (size_t s = 0; s < 2; ++s)
    for (size_t r = 0; r < count && unit.block[s] >= 0; ++r)
      for (size_t q = 0; q < count; ++q)
        unit.own[3 * r + q] += dot6(&unit.g[s][6 * r], &unit.g[s][6 * q]);
  return unit;
}

}  // namespace

BlockUnits::BlockUnits(const BlockProblem& p) : n(p.size()), b(p.size()) {
  std::vector<double> diagonal;
  for (const BlockRow& row : p.rows) {
    double sum = 0;
    for (size_t s = 0; s < 2; ++s)
      if (row.block[s] >= 0) sum += dot6(row.entries[s].data(), row.entries[s].data());
    diagonal.push_back(sum);
  }
  d = scaling_of(std::move(diagonal), p.conditions.groups);
  std::vector<char> grouped(size_t(n), 0);
  for (const ConeGroup& g : p.conditions.groups) {
    units.push_back(block_unit(p, d, &g, -1));
    for (const int i : units.back().row) grouped[size_t(i)] = 1;
  }
  for (int i = 0; i < n; ++i) {
    b[i] = p.conditions.b[i] * d[size_t(i)];
    if (!grouped[size_t(i)]) units.push_back(block_unit(p, d, nullptr, i));
  }
}

void BlockUnits::gather(const VecX& z, std::vector<double>& u) const {
  std::fill(u.begin(), u.end(), 0.0);
  for (const BlockUnit& unit : units) {
    std::array<double, 3> x{};
    for (size_t r = 0; r < size_t(unit.count); ++r) x[r] = z[unit.row[r]];
    add_rows(unit, x, u);
  }
}

std::array<double, 3> BlockUnits::rows_times(const BlockUnit& unit,
                                             const std::vector<double>& u) const {
  std::array<double, 3> out{};
  for (size_t s = 0; s < 2; ++s) {
    if (unit.block[s] < 0) continue;
    const double* x = &u[6 * size_t(unit.block[s])];
    for (size_t r = 0; r < size_t(unit.count); ++r) out[r] += dot6(&unit.g[s][6 * r], x);
  }
  return out;
}

void BlockUnits::add_rows(const BlockUnit& unit, const std::array<double, 3>& x,
                          std::vector<double>& u) const {
  for (size_t s = 0; s < 2; ++s) {
    if (unit.block[s] < 0) continue;
    double* to = &u[6 * size_t(unit.block[s])];
    for (size_t r = 0; r < size_t(unit.count); ++r)
      for (size_t k = 0; k < 6; ++k) to[k] += unit.g[s][6 * r + k] * x[r];
  }
}

void BlockUnits::slack(const std::vector<double>& u, VecX& w) const {
  for (const BlockUnit& unit : units) {
    const std::array<double, 3> x = rows_times(unit, u);
    for (size_t r = 0; r < size_t(unit.count); ++r) w[unit.row[r]] = b[unit.row[r]] + x[r];
  }
}

double BlockUnits::own_terms(const VecX& z) const {
  double most = 0;
  for (const BlockUnit& unit : units)
    for (size_t r = 0; r < size_t(unit.count); ++r) {
      double sum = std::fabs(b[unit.row[r]]);
      for (size_t q = 0; q < size_t(unit.count); ++q)
        sum += std::fabs(unit.own[3 * r + q] * z[unit.row[q]]);
      most = std::max(most, sum);
    }
  return most == 0 ? 1 : most;
}

void add_response(const BlockUnit& unit, const std::array<double, 9>& d, BlockFactor& factor) {
  const auto count = size_t(unit.count);
  BlockFactor::Block m;
  for (size_t t = 0; t < 2; ++t) {
    if (unit.block[t] < 0) continue;
    std::array<double, 18> dg{};
    for (size_t r = 0; r < count; ++r)
      for (size_t q = 0; q < count; ++q)
        for (size_t c = 0; c < 6; ++c) dg[6 * r + c] += d[3 * r + q] * unit.g[t][6 * q + c];
    for (size_t s = 0; s < 2; ++s) {
      if (unit.block[s] < 0) continue;
      m.fill(0);
      for (size_t r = 0; r < count; ++r)
        for (size_t c = 0; c < 6; ++c)
          for (size_t i = 0; i < 6; ++i) m[6 * c + i] += unit.g[s][6 * r + i] * dg[6 * r + c];
      factor.add(unit.block[s], unit.block[t], m.data());
    }
  }
}

}  // namespace tumble::lcp
