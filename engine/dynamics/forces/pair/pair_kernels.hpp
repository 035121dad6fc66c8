#pragma once
#include "engine/dynamics/forces/pair/pair_law.hpp"

#include <cstddef>
#include <cstdint>
#include <span>

namespace tumble {

struct PairPoint {
  double x, y, z;  ///< [m]
  double weight;   ///< 0 for what fills lists up
};

inline constexpr size_t pair_batch = 8;

/// Of the points that a list names those within the cut-off of another, in their order; gives their
/// number. `near` has room for the list and four.
size_t find_near(const PairPoint* points, const PairPoint& own, std::span<const uint32_t> list,
                 double cutoff2, PairPoint* near);
/// Fills up to a multiple of pair_batch with what no law reaches, and gives that.
size_t fill_up(PairPoint* near, size_t count, const PairPoint& own, double cutoff);

/// Sums over pairs of one point, without its own weight: eight sums, to which neighbours come in
/// turn, added in a fixed order. The same bits for every instruction set.
struct PairPush {
  double fx, fy, fz;  ///< force on the point [N]
};
struct PairEnergy {
  double energy;  ///< [J]
  double virial;  ///< sum of r.F [J]
};

/// Of `own` over others; their number is a multiple of pair_batch.
PairPush push_of(const PairLaw& law, const PairPoint& own, std::span<const PairPoint> near);
PairEnergy energy_of(const PairLaw& law, const PairPoint& own, std::span<const PairPoint> near);

/// Over the first `count` points but that at `own`, and over those of them behind it; there are a
/// multiple of pair_batch of points.
PairPush push_of_all(const PairLaw& law, std::span<const PairPoint> points, size_t count,
                     size_t own);
PairEnergy energy_of_later(const PairLaw& law, std::span<const PairPoint> points, size_t count,
                           size_t own);

}  // namespace tumble
