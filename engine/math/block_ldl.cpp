#include "engine/math/block_ldl.hpp"

#include "engine/core/work_meter.hpp"

#include <algorithm>
#include <set>

namespace tumble {
namespace {

/// What is left of a diagonal entry whose row depends on others, relative to it.
constexpr double dependent_share = 1e-9;
/// A row with less left gives way to one of its block that has more: what rounding leaves of rows
/// that depend on others grows as pivots shrink.
constexpr double good_share = 1e-2;

}  // namespace

BlockLdl::BlockLdl(std::span<const uint32_t> sizes,
                   std::span<const std::pair<uint32_t, uint32_t>> coupled) {
  uint32_t rows = 0;
  for (const uint32_t size : sizes) {
    first_.push_back(rows);
    rows += size;
  }
  diagonal_.resize(rows);
  pivot_.resize(rows);
  row_of_column_.resize(rows);
  inverse_.resize(rows);
  order(sizes, coupled);
  lay_out(sizes);
}

/// Eliminates the block with the fewest neighbours, the first of several.
void BlockLdl::order(std::span<const uint32_t> sizes,
                     std::span<const std::pair<uint32_t, uint32_t>> coupled) {
  std::vector<std::set<uint32_t>> neighbours(sizes.size());
  for (const auto& [i, j] : coupled) {
    neighbours[i].insert(j);
    neighbours[j].insert(i);
  }
  std::set<std::pair<size_t, uint32_t>> left;
  for (uint32_t i = 0; i < sizes.size(); ++i) left.emplace(neighbours[i].size(), i);
  place_.resize(sizes.size());
  while (!left.empty()) {
    const uint32_t block = left.begin()->second;
    left.erase(left.begin());
    place_[block] = uint32_t(panels_.size());
    Panel& panel = panels_.emplace_back();
    panel.block = block;
    panel.below.assign(neighbours[block].begin(), neighbours[block].end());
    for (const uint32_t i : panel.below) {
      left.erase({neighbours[i].size(), i});
      neighbours[i].erase(block);
      for (const uint32_t j : panel.below)
        if (j != i) neighbours[i].insert(j);
      left.emplace(neighbours[i].size(), i);
    }
  }
}

void BlockLdl::lay_out(std::span<const uint32_t> sizes) {
  size_t values = 0;
  for (Panel& panel : panels_) {
    for (uint32_t& b : panel.below) b = place_[b];
    std::sort(panel.below.begin(), panel.below.end());
    panel.columns = panel.rows = sizes[panel.block];
    for (const uint32_t place : panel.below) {
      panel.row_of.push_back(panel.rows);
      panel.rows += sizes[panels_[place].block];
    }
    panel.values = values;
    values += size_t(panel.rows) * panel.columns;
  }
  values_.resize(values);
  for (Panel& panel : panels_)
    for (size_t a = 0; a < panel.below.size(); ++a)
      for (size_t b = 0; b <= a; ++b) {
        panel.goes_to.push_back(entry(panel.below[b], panel.below[a]));
        panel.strides.push_back(panels_[panel.below[b]].rows);
      }
}

/// The first entry of the block in the columns of `place` and the rows of `row_place` >= place.
size_t BlockLdl::entry(uint32_t place, uint32_t row_place) const {
  const Panel& panel = panels_[place];
  if (place == row_place) return panel.values;
  const auto it = std::lower_bound(panel.below.begin(), panel.below.end(), row_place);
  return panel.values + panel.row_of[size_t(it - panel.below.begin())];
}

void BlockLdl::clear() {
  std::fill(values_.begin(), values_.end(), 0.0);
}

void BlockLdl::add(uint32_t i, uint32_t r, uint32_t j, uint32_t c, double value) {
  uint32_t row = place_[i], column = place_[j];
  if (row < column) {
    std::swap(row, column);
    std::swap(r, c);
  }
  values_[entry(column, row) + size_t(c) * panels_[column].rows + r] += value;
}

void BlockLdl::factor() {
  dependent_ = 0;
  uint64_t work = 0;
  for (const Panel& panel : panels_)
    for (uint32_t c = 0; c < panel.columns; ++c)
      diagonal_[first_[panel.block] + c] = values_[panel.values + size_t(c) * panel.rows + c];
  for (Panel& panel : panels_) {
    factor_columns(panel);
    update_below(panel);
    work += uint64_t(panel.rows) * panel.rows * panel.columns;
  }
  charge_work(work);
}

/// Takes the next column of a panel, `left` being what is left of its diagonal by column.
void BlockLdl::choose_column(const Panel& panel, uint32_t c, std::span<double> left) {
  uint32_t* const row_of = &row_of_column_[first_[panel.block]];
  const auto share = [&](uint32_t k) {
    return left[k] / diagonal_[first_[panel.block] + row_of[k]];
  };
  if (share(c) > good_share) return;
  uint32_t best = c;
  for (uint32_t k = c + 1; k < panel.columns; ++k)
    if (share(k) > share(best)) best = k;
  if (best == c) return;
  double* const values = &values_[panel.values];
  const size_t rows = panel.rows;
  std::swap_ranges(values + c * rows, values + (c + 1) * rows, values + best * rows);
  for (uint32_t k = 0; k < panel.columns; ++k)
    std::swap(values[k * rows + c], values[k * rows + best]);
  std::swap(row_of[c], row_of[best]);
  std::swap(left[c], left[best]);
}

void BlockLdl::factor_columns(Panel& panel) {
  const uint32_t rows = panel.rows;
  double* const values = &values_[panel.values];
  uint32_t* const row_of = &row_of_column_[first_[panel.block]];
  left_.resize(panel.columns);
  for (uint32_t c = 0; c < panel.columns; ++c) {
    row_of[c] = c;
    left_[c] = values[size_t(c) * rows + c];
  }
  for (uint32_t c = 0; c < panel.columns; ++c) {
    choose_column(panel, c, left_);
    double* const column = values + size_t(c) * rows;
    for (uint32_t k = 0; k < c; ++k) {
      const double* const before = values + size_t(k) * rows;
      const double f = before[c] * pivot_[first_[panel.block] + row_of[k]];
      if (f == 0) continue;
      for (uint32_t r = c; r < rows; ++r) column[r] -= f * before[r];
    }
    const uint32_t at = first_[panel.block] + row_of[c];
    const double pivot = column[c];
    const bool counts = pivot > dependent_share * diagonal_[at];
    dependent_ += counts ? 0 : 1;
    pivot_[at] = counts ? pivot : 0;
    inverse_[at] = counts ? 1 / pivot : 0;
    for (uint32_t r = c + 1; r < rows; ++r) column[r] *= inverse_[at];
    for (uint32_t r = c + 1; r < panel.columns; ++r) left_[r] -= column[r] * column[r] * pivot_[at];
  }
}

void BlockLdl::update_below(const Panel& panel) {
  size_t pair = 0;
  for (size_t a = 0; a < panel.below.size(); ++a) {
    const uint32_t row_a = panel.row_of[a];
    const uint32_t count_a = panels_[panel.below[a]].columns;
    for (size_t b = 0; b <= a; ++b, ++pair) {
      const uint32_t row_b = panel.row_of[b];
      const uint32_t count_b = panels_[panel.below[b]].columns;
      double* const to = &values_[panel.goes_to[pair]];
      for (uint32_t k = 0; k < panel.columns; ++k) {
        const double* const column = &values_[panel.values + size_t(k) * panel.rows];
        const double pivot = pivot_[first_[panel.block] + row_of_column_[first_[panel.block] + k]];
        for (uint32_t c = 0; c < count_b; ++c) {
          const double f = pivot * column[row_b + c];
          double* const to_column = to + size_t(c) * panel.strides[pair];
          for (uint32_t r = 0; r < count_a; ++r) to_column[r] -= f * column[row_a + r];
        }
      }
    }
  }
}

void BlockLdl::forward(std::span<double> x) const {
  charge_work(values_.size());
  for (const Panel& panel : panels_) {
    const uint32_t first = first_[panel.block];
    const uint32_t* const row_of = &row_of_column_[first];
    for (uint32_t c = 0; c < panel.columns; ++c) {
      const double f = x[first + row_of[c]];
      if (f == 0) continue;
      const double* const column = &values_[panel.values + size_t(c) * panel.rows];
      for (uint32_t r = c + 1; r < panel.columns; ++r) x[first + row_of[r]] -= f * column[r];
      for (size_t b = 0; b < panel.below.size(); ++b) {
        const Panel& below = panels_[panel.below[b]];
        const double* const part = column + panel.row_of[b];
        for (uint32_t r = 0; r < below.columns; ++r) x[first_[below.block] + r] -= f * part[r];
      }
    }
  }
}

void BlockLdl::solve(std::span<double> x) const {
  forward(x);
  charge_work(values_.size());
  for (size_t i = 0; i < x.size(); ++i) x[i] *= inverse_[i];
  for (size_t p = panels_.size(); p-- > 0;) {
    const Panel& panel = panels_[p];
    const uint32_t first = first_[panel.block];
    const uint32_t* const row_of = &row_of_column_[first];
    for (uint32_t c = panel.columns; c-- > 0;) {
      const double* const column = &values_[panel.values + size_t(c) * panel.rows];
      double sum = x[first + row_of[c]];
      for (uint32_t r = c + 1; r < panel.columns; ++r) sum -= column[r] * x[first + row_of[r]];
      for (size_t b = 0; b < panel.below.size(); ++b) {
        const Panel& below = panels_[panel.below[b]];
        const double* const part = column + panel.row_of[b];
        for (uint32_t r = 0; r < below.columns; ++r) sum -= part[r] * x[first_[below.block] + r];
      }
      x[first + row_of[c]] = sum;
    }
  }
}

}  // namespace tumble
