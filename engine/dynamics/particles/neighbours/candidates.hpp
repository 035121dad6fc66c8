#pragma once
#include "engine/dynamics/particles/neighbours/cell_order.hpp"
#include "engine/dynamics/particles/neighbours/neighbour_kernels.hpp"
#include "engine/dynamics/particles/tolerances.hpp"

#include <array>

namespace tumble {

/// What the cells about a cell hold, relative to its centre.
class Candidates {
 public:
  void collect(const CellOrder& cells, const CellOrder& ghosts, const CellOrder::Cell& cell,
               std::span<const double> x, std::span<const double> y, std::span<const double> z,
               uint32_t first_ghost) {
    x_.clear(), y_.clear(), z_.clear(), place_.clear();
    centre_ = cells.size() * Vec3(double(cell.i) + 0.5, double(cell.j) + 0.5, double(cell.k) + 0.5);
    for (int64_t dk = -1; dk <= 1; ++dk)
      for (int64_t dj = -1; dj <= 1; ++dj)
        for (int64_t di = -1; di <= 1; ++di) {
          const CellOrder::Cell* at = cells.find(cell.i + di, cell.j + dj, cell.k + dk);
          for (uint32_t p = at ? at->first : 0; at && p < at->end; ++p) add(p, x, y, z);
          at = ghosts.find(cell.i + di, cell.j + dj, cell.k + dk);
          for (uint32_t p = at ? at->first : 0; at && p < at->end; ++p)
            add(first_ghost + p, x, y, z);
        }
    while (x_.size() % batch != 0) {
      for (std::vector<float>* c : {&x_, &y_, &z_}) c->push_back(tolerances::far_coordinate);
      place_.push_back(0);
    }
  }
  NeighbourCandidates view() const {
    return {x_.data(), y_.data(), z_.data(), place_.data(), x_.size()};
  }
  std::array<float, 3> relative(const Vec3& p) const {
    return {float(p[0] - centre_[0]), float(p[1] - centre_[1]), float(p[2] - centre_[2])};
  }

 private:
  static constexpr size_t batch = 8;
  void add(uint32_t p, std::span<const double> x, std::span<const double> y,
           std::span<const double> z) {
    const auto at = relative({x[p], y[p], z[p]});
    x_.push_back(at[0]), y_.push_back(at[1]), z_.push_back(at[2]);
    place_.push_back(p);
  }
  Vec3 centre_;
  std::vector<float> x_, y_, z_;
  std::vector<uint32_t> place_;
};

}  // namespace tumble
