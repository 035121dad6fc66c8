#include "engine/math/block_ldl.hpp"

#include "engine/core/work_meter.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <functional>
#include <queue>

namespace tumble {
namespace {

/// What is left of a diagonal entry whose row depends on others, relative to it.
constexpr double dependent_share = 1e-9;
/// A row with less left gives way to one of its block that has more: what rounding leaves of rows
/// that depend on others grows as pivots shrink.
constexpr double good_share = 1e-2;

/// a | b, both ascending, without two values.
void unite(std::vector<uint32_t>& a, std::span<const uint32_t> b, uint32_t without_1,
           uint32_t without_2, std::vector<uint32_t>& scratch) {
  scratch.clear();
  std::set_union(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(scratch));
  std::erase_if(scratch, [&](uint32_t v) { return v == without_1 || v == without_2; });
  a.swap(scratch);
}

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
  std::vector<std::vector<uint32_t>> below = order(sizes.size(), coupled);
  lay_out(sizes, below);
}

/// Eliminates the block with the fewest neighbours, the first of several; what it leaves below
/// each, by place in the order.
std::vector<std::vector<uint32_t>> BlockLdl::order(
    size_t n, std::span<const std::pair<uint32_t, uint32_t>> coupled) {
  std::vector<std::vector<uint32_t>> neighbours(n), below;
  for (const auto& [i, j] : coupled) {
    neighbours[i].push_back(j);
    neighbours[j].push_back(i);
  }
  for (std::vector<uint32_t>& of : neighbours) {
    std::sort(of.begin(), of.end());
    of.erase(std::unique(of.begin(), of.end()), of.end());
  }
  // Entries that are out of date stay in the queue, and are passed over.
  using Entry = std::pair<size_t, uint32_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  std::vector<uint8_t> gone(n);
  for (uint32_t i = 0; i < n; ++i) queue.emplace(neighbours[i].size(), i);
  place_.resize(n);
  std::vector<uint32_t> scratch;
  while (!queue.empty()) {
    const auto [degree, block] = queue.top();
    queue.pop();
    if (gone[block] || degree != neighbours[block].size()) continue;
    gone[block] = 1;
    place_[block] = uint32_t(panels_.size());
    panels_.emplace_back().block = block;
    for (const uint32_t i : neighbours[block]) {
      const size_t before = neighbours[i].size();
      unite(neighbours[i], neighbours[block], block, i, scratch);
      if (neighbours[i].size() != before) queue.emplace(neighbours[i].size(), i);
    }
    below.push_back(std::move(neighbours[block]));
  }
  assert(panels_.size() == n);
  return below;
}

void BlockLdl::lay_out(std::span<const uint32_t> sizes, std::span<std::vector<uint32_t>> below) {
  size_t values = 0;
  for (size_t p = 0; p < panels_.size(); ++p) {
    Panel& panel = panels_[p];
    for (uint32_t& b : below[p]) b = place_[b];
    std::sort(below[p].begin(), below[p].end());
    panel.columns = panel.rows = sizes[panel.block];
    panel.below = below_.size();
    panel.count = uint32_t(below[p].size());
    for (const uint32_t place : below[p]) {
      const uint32_t block = panels_[place].block;
      below_.push_back({place, panel.rows, sizes[block], first_[block]});
      panel.rows += sizes[block];
    }
    panel.values = values;
    values += size_t(panel.rows) * panel.columns;
  }
  values_.resize(values);
  for (Panel& panel : panels_) {
    panel.pairs = targets_.size();
    for (size_t a = 0; a < panel.count; ++a)
      for (size_t b = 0; b <= a; ++b) {
        const uint32_t to = below_[panel.below + b].place;
        targets_.push_back({entry(to, below_[panel.below + a].place), panels_[to].rows});
      }
  }
}

/// The first entry of the block in the columns of `place` and the rows of `row_place` >= place.
size_t BlockLdl::entry(uint32_t place, uint32_t row_place) const {
  const Panel& panel = panels_[place];
  if (place == row_place) return panel.values;
  const auto first = below_.begin() + std::ptrdiff_t(panel.below);
  const auto it = std::lower_bound(first, first + panel.count, row_place,
                                   [](const Below& b, uint32_t v) { return b.place < v; });
  return panel.values + it->row;
}

BlockLdl::Place BlockLdl::place(uint32_t i, uint32_t j) const {
  const uint32_t row = place_[i], column = place_[j];
  if (row >= column) return {entry(column, row), 1, panels_[column].rows};
  return {entry(row, column), panels_[row].rows, 1};
}

void BlockLdl::clear() {
  std::fill(values_.begin(), values_.end(), 0.0);
}

void BlockLdl::factor() {
  dependent_ = 0;
  uint64_t work = 0;
  for (const Panel& panel : panels_)
    for (uint32_t c = 0; c < panel.columns; ++c) {
      const size_t row = first_[panel.block] + c;
      diagonal_[row] = values_[panel.values + size_t(c) * panel.rows + c];
    }
  for (const Panel& panel : panels_) {
    factor_columns(panel);
    update_below(panel);
    work += uint64_t(panel.rows) * panel.rows * panel.columns;
  }
  charge_work(work);
}

/// Takes the next column of a panel, `left` being what is left of its diagonal by column.
void BlockLdl::choose_column(const Panel& panel, uint32_t c, std::span<double> left) {
  uint32_t* const row_of = row_of_column_.data() + first_[panel.block];
  const auto share = [&](uint32_t k) {
    return left[k] / diagonal_[first_[panel.block] + row_of[k]];
  };
  if (share(c) > good_share) return;
  uint32_t best = c;
  for (uint32_t k = c + 1; k < panel.columns; ++k)
    if (share(k) > share(best)) best = k;
  if (best == c) return;
  double* const values = values_.data() + panel.values;
  const size_t rows = panel.rows;
  std::swap_ranges(values + c * rows, values + (c + 1) * rows, values + best * rows);
  for (uint32_t k = 0; k < panel.columns; ++k)
    std::swap(values[k * rows + c], values[k * rows + best]);
  std::swap(row_of[c], row_of[best]);
  std::swap(left[c], left[best]);
}

void BlockLdl::factor_columns(const Panel& panel) {
  const uint32_t rows = panel.rows, first = first_[panel.block];
  double* const values = values_.data() + panel.values;
  uint32_t* const row_of = row_of_column_.data() + first;
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
      const double f = before[c] * pivot_[first + row_of[k]];
      if (f == 0) continue;
      for (uint32_t r = c; r < rows; ++r) column[r] -= f * before[r];
    }
    const uint32_t at = first + row_of[c];
    const double pivot = column[c];
    const bool counts = std::fabs(pivot) > dependent_share * std::fabs(diagonal_[at]) &&
                        (pivot > 0) == (diagonal_[at] > 0);
    dependent_ += counts ? 0 : 1;
    pivot_[at] = counts ? pivot : 0;
    inverse_[at] = counts ? 1 / pivot : 0;
    for (uint32_t r = c + 1; r < rows; ++r) column[r] *= inverse_[at];
    for (uint32_t r = c + 1; r < panel.columns; ++r) left_[r] -= column[r] * column[r] * pivot_[at];
  }
}

void BlockLdl::update_below(const Panel& panel) {
  const Below* const below = below_.data() + panel.below;
  const Target* target = targets_.data() + panel.pairs;
  const double* const values = values_.data() + panel.values;
  const uint32_t first = first_[panel.block];
  for (uint32_t a = 0; a < panel.count; ++a) {
    const uint32_t rows_a = below[a].columns;
    for (uint32_t b = 0; b <= a; ++b, ++target) {
      double* const to = &values_[target->first];
      for (uint32_t k = 0; k < panel.columns; ++k) {
        const double* const column = values + size_t(k) * panel.rows;
        const double pivot = pivot_[first + row_of_column_[first + k]];
        const double *const of_a = column + below[a].row, *const of_b = column + below[b].row;
        for (uint32_t c = 0; c < below[b].columns; ++c) {
          const double f = pivot * of_b[c];
          double* const to_column = to + size_t(c) * target->rows;
          for (uint32_t r = 0; r < rows_a; ++r) to_column[r] -= f * of_a[r];
        }
      }
    }
  }
}

void BlockLdl::solve(std::span<double> x) const {
  charge_work(2 * values_.size());
  for (const Panel& panel : panels_) {
    const uint32_t first = first_[panel.block];
    const uint32_t* const row_of = row_of_column_.data() + first;
    for (uint32_t c = 0; c < panel.columns; ++c) {
      const double f = x[first + row_of[c]];
      if (f == 0) continue;
      const double* const column = &values_[panel.values + size_t(c) * panel.rows];
      for (uint32_t r = c + 1; r < panel.columns; ++r) x[first + row_of[r]] -= f * column[r];
      for (uint32_t b = 0; b < panel.count; ++b) {
        const Below& below = below_[panel.below + b];
        const double* const part = column + below.row;
        // The rows of a block below stand there in their own order.
        for (uint32_t r = 0; r < below.columns; ++r) x[below.first + r] -= f * part[r];
      }
    }
  }
  for (size_t i = 0; i < x.size(); ++i) x[i] *= inverse_[i];
  for (size_t p = panels_.size(); p-- > 0;) {
    const Panel& panel = panels_[p];
    const uint32_t first = first_[panel.block];
    const uint32_t* const row_of = row_of_column_.data() + first;
    for (uint32_t c = panel.columns; c-- > 0;) {
      const double* const column = &values_[panel.values + size_t(c) * panel.rows];
      double sum = x[first + row_of[c]];
      for (uint32_t r = c + 1; r < panel.columns; ++r) sum -= column[r] * x[first + row_of[r]];
      for (uint32_t b = 0; b < panel.count; ++b) {
        const Below& below = below_[panel.below + b];
        const double* const part = column + below.row;
        for (uint32_t r = 0; r < below.columns; ++r) sum -= part[r] * x[below.first + r];
      }
      x[first + row_of[c]] = sum;
    }
  }
}

}  // namespace tumble
