#include "engine/math/lcp/blocks/block_problem.hpp"

#include "engine/math/lcp/scaling.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

namespace tumble::lcp {
namespace {

Error bad_blocks(std::string message) {
  return {ErrorCode::invalid_argument, std::move(message), "lcp", {}};
}

Status check_block_row(const BlockProblem& p, size_t i) {
  const BlockRow& row = p.rows[i];
  for (size_t s = 0; s < 2; ++s) {
    if (row.block[s] < -1 || row.block[s] >= p.blocks)
      return bad_blocks(fmt::format("row {} names block {} of {}", i, row.block[s], p.blocks));
    if (row.block[s] < 0) continue;
    for (const double x : row.entries[s])
      if (!std::isfinite(x))
        return bad_blocks(fmt::format("row {} has an entry that is not finite", i));
  }
  if (row.block[0] >= 0 && row.block[0] == row.block[1])
    return bad_blocks(fmt::format("row {} names block {} twice", i, row.block[0]));
  return {};
}

double row_product(const std::array<double, 6>& a, const std::array<double, 6>& b) {
  double sum = 0;
  for (size_t k = 0; k < 6; ++k) sum += a[k] * b[k];
  return sum;
}

/// An entry of G G^T.
double row_product(const BlockRow& a, const BlockRow& b) {
  double sum = 0;
  for (size_t s = 0; s < 2; ++s)
    for (size_t t = 0; t < 2 && a.block[s] >= 0; ++t)
      if (a.block[s] == b.block[t]) sum += row_product(a.entries[s], b.entries[t]);
  return sum;
}

/// Calls visit(i, j) for each pair of rows that share a block, also i = j, in a fixed order.
template <class Visit>
void for_each_coupling(const BlockProblem& p, const Visit& visit) {
  std::vector<std::vector<int>> rows_of(static_cast<size_t>(p.blocks));
  for (int i = 0; i < p.size(); ++i)
    for (const int block : p.rows[size_t(i)].block)
      if (block >= 0) rows_of[size_t(block)].push_back(i);
  for (int i = 0; i < p.size(); ++i) {
    const BlockRow& row = p.rows[size_t(i)];
    const int first = row.block[0];
    if (first >= 0)
      for (const int j : rows_of[size_t(first)]) visit(i, j);
    if (row.block[1] < 0) continue;
    for (const int j : rows_of[size_t(row.block[1])]) {
      const BlockRow& other = p.rows[size_t(j)];
      if (first < 0 || (other.block[0] != first && other.block[1] != first)) visit(i, j);
    }
  }
}

}  // namespace

Status check(const BlockProblem& p) {
  if (Status s = check_conditions(p.conditions); !s) return s;
  if (p.rows.size() != size_t(p.size()))
    return bad_blocks(fmt::format("{} rows for {} unknowns", p.rows.size(), p.size()));
  for (size_t i = 0; i < p.rows.size(); ++i)
    if (Status s = check_block_row(p, i); !s) return s;
  for (const ConeGroup& g : p.conditions.groups)
    for (const int t : g.lateral)
      if (p.rows[size_t(t)].block != p.rows[size_t(g.axial)].block)
        return bad_blocks(
            fmt::format("unknowns {} and {} of a group name different blocks", g.axial, t));
  return {};
}

std::vector<double> row_units(const BlockProblem& p) {
  std::vector<double> diagonal;
  for (const BlockRow& row : p.rows) diagonal.push_back(row_product(row, row));
  return scaling_of(std::move(diagonal), p.conditions.groups);
}

double largest_term(const BlockProblem& p, const std::vector<double>& d, const VecX& z) {
  VecX terms = p.conditions.b.cwiseAbs();
  if (!z.isZero(0))
    for_each_coupling(p, [&](int i, int j) {
      terms[i] += std::fabs(row_product(p.rows[size_t(i)], p.rows[size_t(j)]) * z[j]);
    });
  double unit = 0;
  bool finite = true;
  for (int i = 0; i < p.size(); ++i) {
    finite = finite && std::isfinite(terms[i]);
    unit = std::max(unit, terms[i] * d[size_t(i)]);
  }
  if (!finite) return std::numeric_limits<double>::infinity();
  return unit == 0 ? 1 : unit;
}

}  // namespace tumble::lcp
