#include "engine/dynamics/particles/neighbours/cell_order.hpp"

#include "engine/core/chunks.hpp"
#include "engine/dynamics/particles/tolerances.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <utility>

namespace tumble {
namespace {

constexpr int axis_bits = 21;
constexpr uint64_t axis_mask = (uint64_t{1} << axis_bits) - 1;
/// Least number of keys that are sorted on several threads: with fewer, tables of digits cost more.
constexpr size_t least_sorted = 8192;
/// Offset of coordinates [cells], so that those about the origin do not wrap around.
constexpr int64_t middle = int64_t{1} << (axis_bits - 1);

/// The lowest 21 bits, spread with two zeros between neighbours.
uint64_t spread(uint64_t v) {
  v &= axis_mask;
  v = (v | v << 32) & 0x001f00000000ffff;
  v = (v | v << 16) & 0x001f0000ff0000ff;
  v = (v | v << 8) & 0x100f00f00f00f00f;
  v = (v | v << 4) & 0x10c30c30c30c30c3;
  v = (v | v << 2) & 0x1249249249249249;
  return v;
}

uint64_t morton(int64_t i, int64_t j, int64_t k) {
  return spread(uint64_t(i + middle)) | spread(uint64_t(j + middle)) << 1 |
         spread(uint64_t(k + middle)) << 2;
}

int64_t cell_coordinate(double x, double size) {
  return int64_t(std::clamp(std::floor(x / size), -tolerances::most_cells, tolerances::most_cells));
}

size_t hash(uint64_t key) {
  return size_t(key * 0x9e3779b97f4a7c15 >> 20);
}

}  // namespace

void CellOrder::sort(std::span<const Vec3> points, double size, Crew* crew) {
  size_ = size;
  make_keys(points, crew);
  sort_keys(crew);
  list_cells(points);
  fill_table();
}

void CellOrder::line_up(std::span<const Vec3> points, double size, Crew* crew) {
  size_ = size;
  make_keys(points, crew);
  sort_keys(crew);
  order_.resize(keyed_.size());
  for (size_t p = 0; p < keyed_.size(); ++p) order_[p] = keyed_[p].index;
  cells_.clear();
}

void CellOrder::make_keys(std::span<const Vec3> points, Crew* crew) {
  keyed_.resize(points.size());
  scratch_.resize(points.size());
  for_chunks(crew, points.size(), [&](size_t, size_t first, size_t last) {
    for (size_t p = first; p < last; ++p) {
      const Vec3& x = points[p];
      keyed_[p] = {morton(cell_coordinate(x[0], size_), cell_coordinate(x[1], size_),
                          cell_coordinate(x[2], size_)),
                   uint32_t(p)};
    }
  });
}

/// Radix sort from the lowest digit, which keeps the order of equal keys; skips digits that are
/// equal in all. The keys of a chunk with the same digit come after those of the chunks before.
void CellOrder::sort_keys(Crew* crew) {
  if (std::ranges::is_sorted(keyed_, {}, &Keyed::key)) return;
  uint64_t varying = 0;
  for (const Keyed& k : keyed_) varying |= k.key ^ keyed_[0].key;
  constexpr uint64_t digit_mask = (1u << digit_bits) - 1;
  digits_.resize(keyed_.size() < least_sorted ? 1 : chunk_count);
  for (int shift = 0; shift < 3 * axis_bits; shift += digit_bits) {
    if ((varying >> shift & digit_mask) == 0) continue;
    const auto digit = [shift](const Keyed& k) { return size_t(k.key >> shift & digit_mask); };
    std::array<bool, chunk_count> counted{};
    const auto count = [&](size_t chunk, size_t first, size_t last) {
      counted[chunk] = true;
      digits_[chunk].fill(0);
      for (size_t p = first; p < last; ++p) ++digits_[chunk][digit(keyed_[p])];
    };
    for_chunks(crew, keyed_.size(), count, least_sorted);
    const auto chunks = std::span(digits_).first(size_t(std::ranges::count(counted, true)));
    Digits next{};
    for (const Digits& of : chunks)
      for (size_t d = 0; d < next.size(); ++d) next[d] += of[d];
    uint32_t sum = 0;
    for (uint32_t& place : next) sum += std::exchange(place, sum);
    for (Digits& of : chunks)
      for (size_t d = 0; d < next.size(); ++d) next[d] += std::exchange(of[d], next[d]);
    const auto scatter = [&](size_t chunk, size_t first, size_t last) {
      Digits& place = digits_[chunk];
      for (size_t p = first; p < last; ++p) scratch_[place[digit(keyed_[p])]++] = keyed_[p];
    };
    for_chunks(crew, keyed_.size(), scatter, least_sorted);
    keyed_.swap(scratch_);
  }
}

void CellOrder::list_cells(std::span<const Vec3> points) {
  const auto cell_of = [&](uint32_t index) {
    const Vec3& x = points[index];
    return std::array{cell_coordinate(x[0], size_), cell_coordinate(x[1], size_),
                      cell_coordinate(x[2], size_)};
  };
  // Equal keys are those of one cell unless coordinates wrap around.
  const double most = double(middle - 1) * size_;
  const bool wraps = std::ranges::any_of(
      points, [most](const Vec3& x) { return !(x.cwiseAbs().maxCoeff() < most); });
  const size_t n = keyed_.size();
  order_.resize(n);
  cells_.clear();
  for (size_t begin = 0, end = 0; begin < n; begin = end) {
    const auto first = cell_of(keyed_[begin].index);
    bool same = true;
    for (end = begin; end < n && keyed_[end].key == keyed_[begin].key; ++end)
      same = same && (!wraps || cell_of(keyed_[end].index) == first);
    if (!same)
      std::stable_sort(
          keyed_.begin() + ptrdiff_t(begin), keyed_.begin() + ptrdiff_t(end),
          [&](const Keyed& a, const Keyed& b) { return cell_of(a.index) < cell_of(b.index); });
    for (size_t p = begin; p < end; ++p) order_[p] = keyed_[p].index;
    if (same) {
      cells_.push_back({first[0], first[1], first[2], uint32_t(begin), uint32_t(end)});
      continue;
    }
    for (size_t p = begin; p < end; ++p) {
      const auto [i, j, k] = cell_of(order_[p]);
      if (p == begin || !cells_.back().at(i, j, k))
        cells_.push_back({i, j, k, uint32_t(p), uint32_t(p)});
      ++cells_.back().end;
    }
  }
}

void CellOrder::fill_table() {
  table_.assign(std::bit_ceil(2 * cells_.size() + 1), 0);
  for (size_t c = 0; c < cells_.size(); ++c) {
    const Cell& cell = cells_[c];
    size_t slot = hash(morton(cell.i, cell.j, cell.k)) & (table_.size() - 1);
    while (table_[slot] != 0) slot = (slot + 1) & (table_.size() - 1);
    table_[slot] = uint32_t(c + 1);
  }
}

size_t CellOrder::about(const Cell& cell, std::array<const Cell*, 27>& out) const {
  std::array<uint64_t, 3> ci, cj, ck;
  for (int64_t d = 0; d < 3; ++d) {
    ci[size_t(d)] = spread(uint64_t(cell.i - 1 + d + middle));
    cj[size_t(d)] = spread(uint64_t(cell.j - 1 + d + middle)) << 1;
    ck[size_t(d)] = spread(uint64_t(cell.k - 1 + d + middle)) << 2;
  }
  size_t found = 0;
  for (size_t k = 0; k < 3; ++k)
    for (size_t j = 0; j < 3; ++j)
      for (size_t i = 0; i < 3; ++i)
        if (const Cell* at = find(ci[i] | cj[j] | ck[k], cell.i - 1 + int64_t(i),
                                  cell.j - 1 + int64_t(j), cell.k - 1 + int64_t(k)))
          out[found++] = at;
  return found;
}

const CellOrder::Cell* CellOrder::find(int64_t i, int64_t j, int64_t k) const {
  return cells_.empty() ? nullptr : find(morton(i, j, k), i, j, k);
}

const CellOrder::Cell* CellOrder::find(uint64_t code, int64_t i, int64_t j, int64_t k) const {
  for (size_t slot = hash(code) & (table_.size() - 1); table_[slot] != 0;
       slot = (slot + 1) & (table_.size() - 1))
    if (cells_[table_[slot] - 1].at(i, j, k)) return &cells_[table_[slot] - 1];
  return nullptr;
}

}  // namespace tumble
