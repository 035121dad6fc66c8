#include "engine/math/lcp/blocks/block_units.hpp"

#include "engine/math/lcp/scaling.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tumble::lcp {
namespace {

double dot6(const double* a, const double* b) {
  double sum = 0;
  for (size_t k = 0; k < 6; ++k) sum += a[k] * b[k];
  return sum;
}

BlockEntries block_entries(const BlockProblem& p, const std::vector<double>& d,
                           const ConeUnit& unit) {
  BlockEntries out;
  out.block = p.rows[size_t(unit.row[0])].block;
  const auto count = size_t(unit.count);
  for (size_t r = 0; r < count; ++r) {
    const auto i = size_t(unit.row[r]);
    for (size_t s = 0; s < 2; ++s)
      for (size_t k = 0; k < 6; ++k) out.g[s][6 * r + k] = d[i] * p.rows[i].entries[s][k];
  }
  for (size_t s = 0; s < 2; ++s)
    for (size_t r = 0; r < count && out.block[s] >= 0; ++r)
      for (size_t q = 0; q < count; ++q)
        out.own[3 * r + q] += dot6(&out.g[s][6 * r], &out.g[s][6 * q]);
  return out;
}

}  // namespace

BlockUnits::BlockUnits(const BlockProblem& p) : n(p.size()), d(row_units(p)), b(p.conditions.b) {
  for (int i = 0; i < n; ++i) b[i] *= d[size_t(i)];
  parts = cone_units(p.conditions, d);
  for (const ConeUnit& unit : parts) entries.push_back(block_entries(p, d, unit));
}

void BlockUnits::set_pattern(int blocks, BlockFactor& factor) const {
  std::vector<std::pair<int, int>> pairs;
  for (const BlockEntries& e : entries)
    if (e.block[0] >= 0 && e.block[1] >= 0) pairs.emplace_back(e.block[0], e.block[1]);
  factor.set_pattern(blocks, std::move(pairs));
}

void BlockUnits::add_response(size_t unit, const Square& response, BlockFactor& factor) const {
  const BlockEntries& e = entries[unit];
  const auto count = size_t(parts[unit].count);
  BlockFactor::Block m;
  for (size_t t = 0; t < 2; ++t) {
    if (e.block[t] < 0) continue;
    std::array<double, 18> dg{};
    for (size_t r = 0; r < count; ++r)
      for (size_t q = 0; q < count; ++q)
        for (size_t c = 0; c < 6; ++c) dg[6 * r + c] += response[3 * r + q] * e.g[t][6 * q + c];
    for (size_t s = 0; s < 2; ++s) {
      if (e.block[s] < 0) continue;
      m.fill(0);
      for (size_t r = 0; r < count; ++r)
        for (size_t c = 0; c < 6; ++c)
          for (size_t i = 0; i < 6; ++i) m[6 * c + i] += e.g[s][6 * r + i] * dg[6 * r + c];
      factor.add(e.block[s], e.block[t], m.data());
    }
  }
}

void BlockUnits::gather(const VecX& z, std::vector<double>& u) const {
  std::fill(u.begin(), u.end(), 0.0);
  for (size_t k = 0; k < parts.size(); ++k) add_rows(k, parts[k].of(z), u);
}

Triple BlockUnits::rows_times(size_t unit, const std::vector<double>& u) const {
  const BlockEntries& e = entries[unit];
  Triple out{};
  for (size_t s = 0; s < 2; ++s) {
    if (e.block[s] < 0) continue;
    const double* x = &u[6 * size_t(e.block[s])];
    for (size_t r = 0; r < size_t(parts[unit].count); ++r) out[r] += dot6(&e.g[s][6 * r], x);
  }
  return out;
}

void BlockUnits::add_rows(size_t unit, const Triple& x, std::vector<double>& u) const {
  const BlockEntries& e = entries[unit];
  for (size_t s = 0; s < 2; ++s) {
    if (e.block[s] < 0) continue;
    double* to = &u[6 * size_t(e.block[s])];
    for (size_t r = 0; r < size_t(parts[unit].count); ++r)
      for (size_t k = 0; k < 6; ++k) to[k] += e.g[s][6 * r + k] * x[r];
  }
}

double BlockUnits::own_terms(const VecX& z) const {
  double most = 0;
  for (size_t k = 0; k < parts.size(); ++k) {
    const Triple x = parts[k].of(z);
    for (size_t r = 0; r < size_t(parts[k].count); ++r) {
      double sum = std::fabs(b[parts[k].row[r]]);
      for (size_t q = 0; q < size_t(parts[k].count); ++q)
        sum += std::fabs(entries[k].own[3 * r + q] * x[q]);
      most = std::max(most, sum);
    }
  }
  return most == 0 ? 1 : most;
}

}  // namespace tumble::lcp
