#include "engine/math/lcp/blocks/block_factor.hpp"

#include "engine/core/stop.hpp"
#include "engine/core/work_meter.hpp"
#include "engine/math/lcp/tolerances.hpp"

#include <algorithm>
#include <cmath>

namespace tumble::lcp {
namespace {

constexpr int side = BlockFactor::width;

/// c -= a b
void subtract_product(const double* a, const double* b, double* __restrict c) {
  for (int j = 0; j < side; ++j)
    for (int k = 0; k < side; ++k) {
      const double f = b[side * j + k];
      for (int i = 0; i < side; ++i) c[side * j + i] -= a[side * k + i] * f;
    }
}

/// y -= a x
void subtract_times(const double* a, const double* x, double* __restrict y) {
  for (int k = 0; k < side; ++k)
    for (int i = 0; i < side; ++i) y[i] -= a[side * k + i] * x[k];
}

bool factor_dense(double* a, std::array<int, side>& swaps) {
  double most = 0;
  for (int i = 0; i < side * side; ++i) most = std::max(most, std::fabs(a[i]));
  for (int k = 0; k < side; ++k) {
    int row = k;
    for (int i = k + 1; i < side; ++i)
      if (std::fabs(a[side * k + i]) > std::fabs(a[side * k + row])) row = i;
    swaps[size_t(k)] = row;
    if (!(std::fabs(a[side * k + row]) > tolerances::block_rank_lost * most)) return false;
    if (row != k)
      for (int j = 0; j < side; ++j) std::swap(a[side * j + k], a[side * j + row]);
    for (int i = k + 1; i < side; ++i) a[side * k + i] /= a[side * k + k];
    for (int j = k + 1; j < side; ++j)
      for (int i = k + 1; i < side; ++i) a[side * j + i] -= a[side * k + i] * a[side * j + k];
  }
  return true;
}

/// X := A^-1 X for a matrix X by rows.
template <int columns>
void solve_dense(const double* a, const std::array<int, side>& swaps, double (*x)[columns]) {
  const auto subtract = [&](int to, int from, double f) {
    for (int j = 0; j < columns; ++j) x[to][j] -= f * x[from][j];
  };
  for (int k = 0; k < side; ++k)
    if (swaps[size_t(k)] != k) std::swap(x[k], x[swaps[size_t(k)]]);
  for (int k = 0; k < side; ++k)
    for (int i = k + 1; i < side; ++i) subtract(i, k, a[side * k + i]);
  for (int k = side; k-- > 0;) {
    for (int j = 0; j < columns; ++j) x[k][j] /= a[side * k + k];
    for (int i = 0; i < k; ++i) subtract(i, k, a[side * k + i]);
  }
}

/// The same for a block, which is stored by columns.
void solve_columns(const double* a, const std::array<int, side>& swaps, BlockFactor::Block& x) {
  double rows[side][side];
  for (int k = 0; k < side; ++k)
    for (int j = 0; j < side; ++j) rows[k][j] = x[size_t(side * j + k)];
  solve_dense<side>(a, swaps, rows);
  for (int k = 0; k < side; ++k)
    for (int j = 0; j < side; ++j) x[size_t(side * j + k)] = rows[k][j];
}

}  // namespace

void BlockFactor::set_pattern(int blocks, std::vector<std::pair<int, int>> pairs) {
  n_ = blocks;
  charge_work(size_t(blocks), size_t(blocks) + 100);
  std::vector<std::vector<int>> near(static_cast<size_t>(n_));  // sorted, not yet eliminated
  for (const auto& [i, j] : pairs) {
    near[size_t(i)].push_back(j);
    near[size_t(j)].push_back(i);
  }
  for (std::vector<int>& list : near) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
  }
  order_.clear();
  place_.assign(size_t(n_), -1);
  links_.assign(size_t(n_), {});
  std::vector<int> merged;
  for (int step = 0; step < n_; ++step) {
    int least = -1;
    for (int i = 0; i < n_; ++i)
      if (place_[size_t(i)] < 0 &&
          (least < 0 || near[size_t(i)].size() < near[size_t(least)].size()))
        least = i;
    place_[size_t(least)] = step;
    order_.push_back(least);
    const std::vector<int> clique = std::move(near[size_t(least)]);
    for (const int i : clique) {
      links_[size_t(least)].push_back({i, 0, 0});
      std::vector<int>& list = near[size_t(i)];
      merged.clear();
      std::set_union(list.begin(), list.end(), clique.begin(), clique.end(),
                     std::back_inserter(merged));
      std::erase_if(merged, [&](int j) { return j == i || j == least; });
      list = merged;
    }
  }
  int count = n_;
  for (std::vector<Link>& list : links_) {
    std::sort(list.begin(), list.end(), [&](const Link& a, const Link& b) {
      return place_[size_t(a.other)] < place_[size_t(b.other)];
    });
    for (Link& link : list) link.lower = count++, link.upper = count++;
  }
  blocks_.resize(size_t(count));
  swaps_.resize(size_t(n_));
}

void BlockFactor::set_identity() {
  for (Block& b : blocks_) b.fill(0);
  for (int i = 0; i < n_; ++i)
    for (size_t k = 0; k < size_t(side); ++k) blocks_[size_t(i)][size_t(side) * k + k] = 1;
}

const BlockFactor::Link* BlockFactor::find(int earlier, int later) const {
  const std::vector<Link>& list = links_[size_t(earlier)];
  const auto at = std::lower_bound(
      list.begin(), list.end(), place_[size_t(later)],
      [&](const Link& link, int place) { return place_[size_t(link.other)] < place; });
  return &*at;
}

void BlockFactor::add(int row, int column, const double* m) {
  int at = row;
  if (place_[size_t(row)] > place_[size_t(column)])
    at = find(column, row)->lower;
  else if (row != column)
    at = find(row, column)->upper;
  Block& to = blocks_[size_t(at)];
  for (size_t k = 0; k < to.size(); ++k) to[k] += m[k];
}

/// Row k holds A_kk^-1 A_kj afterwards; column k is left as it is.
bool BlockFactor::eliminate(int k) {
  Block& pivot = blocks_[size_t(k)];
  if (!factor_dense(pivot.data(), swaps_[size_t(k)])) return false;
  const std::vector<Link>& list = links_[size_t(k)];
  charge_work((list.size() + 1) * (list.size() + 1), size_t(side * side * side));
  Block solved;
  for (const Link& column : list) {
    solved = blocks_[size_t(column.upper)];
    solve_columns(pivot.data(), swaps_[size_t(k)], solved);
    for (const Link& row : list) {
      int at = row.other;
      if (place_[size_t(row.other)] > place_[size_t(column.other)])
        at = find(column.other, row.other)->lower;
      else if (row.other != column.other)
        at = find(row.other, column.other)->upper;
      subtract_product(blocks_[size_t(row.lower)].data(), solved.data(),
                       blocks_[size_t(at)].data());
    }
    blocks_[size_t(column.upper)] = solved;
  }
  return true;
}

bool BlockFactor::factor() {
  return std::all_of(order_.begin(), order_.end(),
                     [&](int k) { return !stop_requested() && eliminate(k); });
}

void BlockFactor::solve(std::span<double> x) const {
  charge_work(blocks_.size(), size_t(side * side));
  for (const int k : order_) {
    double* own = &x[size_t(side * k)];
    // What is below gets A_ik A_kk^-1 x_k: the blocks above the diagonal hold A_kk^-1 already.
    double x_k[side][1];
    for (int i = 0; i < side; ++i) x_k[i][0] = own[i];
    solve_dense<1>(blocks_[size_t(k)].data(), swaps_[size_t(k)], x_k);
    for (int i = 0; i < side; ++i) own[i] = x_k[i][0];
    for (const Link& link : links_[size_t(k)])
      subtract_times(blocks_[size_t(link.lower)].data(), own, &x[size_t(side * link.other)]);
  }
  for (size_t step = order_.size(); step-- > 0;) {
    const int k = order_[step];
    for (const Link& link : links_[size_t(k)])
      subtract_times(blocks_[size_t(link.upper)].data(), &x[size_t(side * link.other)],
                     &x[size_t(side * k)]);
  }
}

}  // namespace tumble::lcp
