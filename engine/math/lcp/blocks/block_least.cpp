#include "engine/math/lcp/blocks/block_least.hpp"

#include "engine/math/lcp/blocks/block_factor.hpp"
#include "engine/math/lcp/blocks/block_units.hpp"
#include "engine/math/lcp/tolerances.hpp"

#include <algorithm>
#include <limits>

namespace tumble::lcp {
namespace {

/// 1 + G^T G / weight
bool factor_normal(const BlockUnits& units, int blocks, BlockFactor& factor) {
  units.set_pattern(blocks, factor);
  factor.set_identity();
  BlockFactor::Block m;
  for (size_t k = 0; k < units.parts.size(); ++k) {
    const BlockEntries& e = units.entries[k];
    for (size_t t = 0; t < 2; ++t)
      for (size_t s = 0; s < 2; ++s) {
        if (e.block[s] < 0 || e.block[t] < 0) continue;
        m.fill(0);
        for (size_t r = 0; r < size_t(units.parts[k].count); ++r)
          for (size_t c = 0; c < 6; ++c)
            for (size_t i = 0; i < 6; ++i)
              m[6 * c + i] +=
                  e.g[s][6 * r + i] * (e.g[t][6 * r + c] / tolerances::least_squares_weight);
        factor.add(e.block[s], e.block[t], m.data());
      }
  }
  return factor.factor();
}

double sum_of_squares(const std::vector<double>& x) {
  double sum = 0;
  for (const double v : x) sum += v * v;
  return sum;
}

}  // namespace

std::vector<double> least_columns(const BlockProblem& problem, const VecX& wanted) {
  const BlockUnits units(problem);
  std::vector<double> x(6 * size_t(problem.blocks), 0.0), dx(x.size());
  BlockFactor factor;
  if (!factor_normal(units, problem.blocks, factor)) return x;
  double least = std::numeric_limits<double>::infinity();
  for (int pass = 0; pass < tolerances::most_least_squares_passes; ++pass) {
    std::fill(dx.begin(), dx.end(), 0.0);
    for (size_t k = 0; k < units.parts.size(); ++k) {
      const ConeUnit& unit = units.parts[k];
      Triple rest = units.rows_times(k, x);
      for (size_t r = 0; r < size_t(unit.count); ++r) {
        const auto i = size_t(unit.row[r]);
        rest[r] = (wanted[unit.row[r]] * units.d[i] - rest[r]) / tolerances::least_squares_weight;
      }
      units.add_rows(k, rest, dx);
    }
    factor.solve(dx);
    const double moved = sum_of_squares(dx);
    // Further changes are rounding error.
    if (!(moved < 0.25 * least)) break;
    least = moved;
    for (size_t k = 0; k < x.size(); ++k) x[k] += dx[k];
    if (moved <= tolerances::least_squares_still * sum_of_squares(x)) break;
  }
  return x;
}

}  // namespace tumble::lcp
