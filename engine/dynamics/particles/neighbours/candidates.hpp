#pragma once
#include "engine/dynamics/particles/neighbours/cell_order.hpp"
#include "engine/dynamics/particles/neighbours/neighbour_kernels.hpp"
#include "engine/dynamics/particles/tolerances.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace tumble {

/// The points in a cell and its neighbouring cells, relative to the cell's centre.
class Candidates {
 public:
  void collect(const CellOrder& cells, const CellOrder& ghosts, const CellOrder::Cell& cell,
               std::span<const double> x, std::span<const double> y, std::span<const double> z,
               uint32_t first_ghost, std::span<const uint32_t> ordinals) {
    centre_ = cells.size() * Vec3(double(cell.i) + 0.5, double(cell.j) + 0.5, double(cell.k) + 0.5);
    size_ = 0;
    if (ghosts.cells().empty()) {
      std::array<const CellOrder::Cell*, 27> about;
      const size_t found = cells.about(cell, about);
      for (size_t n = 0; n < found; ++n) add(*about[n], 0, x, y, z);
    } else {
      add_with_ghosts(cells, ghosts, cell, x, y, z, first_ghost);
    }
    if (!ordinals.empty()) sort(ordinals);
    make_room(batch);
    for (; size_ % batch != 0; ++size_) {
      x_[size_] = y_[size_] = z_[size_] = tolerances::far_coordinate;
      place_[size_] = 0;
    }
  }
  NeighbourCandidates view() const {
    return {x_.data(), y_.data(), z_.data(), place_.data(), size_};
  }
  std::array<float, 3> relative(const Vec3& p) const {
    return {float(p[0] - centre_[0]), float(p[1] - centre_[1]), float(p[2] - centre_[2])};
  }

 private:
  static constexpr size_t batch = 8;
  void make_room(size_t more) {
    if (size_ + more <= place_.size()) return;
    for (std::vector<float>* c : {&x_, &y_, &z_}) c->resize(2 * (size_ + more));
    place_.resize(2 * (size_ + more));
  }
  void add_with_ghosts(const CellOrder& cells, const CellOrder& ghosts, const CellOrder::Cell& cell,
                       std::span<const double> x, std::span<const double> y,
                       std::span<const double> z, uint32_t first_ghost) {
    for (int64_t dk = -1; dk <= 1; ++dk)
      for (int64_t dj = -1; dj <= 1; ++dj)
        for (int64_t di = -1; di <= 1; ++di) {
          const int64_t i = cell.i + di, j = cell.j + dj, k = cell.k + dk;
          if (const CellOrder::Cell* at = cells.find(i, j, k)) add(*at, 0, x, y, z);
          if (const CellOrder::Cell* at = ghosts.find(i, j, k)) add(*at, first_ghost, x, y, z);
        }
  }
  void add(const CellOrder::Cell& cell, uint32_t first, std::span<const double> x,
           std::span<const double> y, std::span<const double> z) {
    const size_t n = cell.end - cell.first, from = first + cell.first;
    make_room(n);
    const auto relative_to = [&](std::vector<float>& to, std::span<const double> c, double centre) {
      for (size_t k = 0; k < n; ++k) to[size_ + k] = float(c[from + k] - centre);
    };
    relative_to(x_, x, centre_[0]);
    relative_to(y_, y, centre_[1]);
    relative_to(z_, z, centre_[2]);
    for (size_t k = 0; k < n; ++k) place_[size_ + k] = uint32_t(from + k);
    size_ += n;
  }
  /// Sorts by ascending ordinals of places: radix sort that skips digits which are equal in all.
  void sort(std::span<const uint32_t> ordinals) {
    keys_.resize(size_), next_.resize(size_);
    uint32_t varying = 0;
    for (size_t k = 0; k < size_; ++k) {
      keys_[k] = {ordinals[place_[k]], uint32_t(k)};
      varying |= keys_[k].ordinal ^ keys_[0].ordinal;
    }
    for (int shift = 0; shift < 32; shift += 8) {
      if ((varying >> shift & 255) == 0) continue;
      std::array<uint32_t, 256> first{};
      for (const Key& key : keys_) ++first[key.ordinal >> shift & 255];
      uint32_t sum = 0;
      for (uint32_t& f : first) sum += std::exchange(f, sum);
      for (const Key& key : keys_) next_[first[key.ordinal >> shift & 255]++] = key;
      keys_.swap(next_);
    }
    const auto rearrange = [this](auto& from, auto& scratch) {
      scratch.resize(from.size());
      for (size_t k = 0; k < size_; ++k) scratch[k] = from[keys_[k].slot];
      from.swap(scratch);
    };
    rearrange(x_, sorted_), rearrange(y_, sorted_), rearrange(z_, sorted_);
    rearrange(place_, sorted_places_);
  }

  struct Key {
    uint32_t ordinal, slot;
  };
  Vec3 centre_;
  size_t size_ = 0;  ///< number of entries in use
  std::vector<float> x_, y_, z_;
  std::vector<uint32_t> place_;
  // scratch memory
  std::vector<Key> keys_, next_;
  std::vector<float> sorted_;
  std::vector<uint32_t> sorted_places_;
};

}  // namespace tumble
