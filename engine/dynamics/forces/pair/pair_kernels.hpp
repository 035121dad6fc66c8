#pragma once
#include "engine/dynamics/forces/pair/pair_law.hpp"

#include <cstddef>
#include <cstdint>
#include <span>

namespace tumble {

/// Points by place, as NeighbourLists has them, with what lists are filled with at the end.
struct PairPoints {
  const double* x;
  const double* y;
  const double* z;
  const double* weight;  ///< 0 for what fills lists
};

/// Sums over all pairs that a point is in.
struct PairSum {
  double fx, fy, fz;  ///< force on the point [N]
  double energy;      ///< of the pairs, each whole [J]
  double virial;      ///< sum of r.F over the pairs [J]
};

/// Of one point over a list of others whose length is a multiple of eight. Eight sums, in a fixed
/// order: the same bits for every instruction set.
PairSum sum_over_list(const PairLaw& law, const PairPoints& points, size_t place,
                      std::span<const uint32_t> list);
/// The same over all of the first `count` points, a multiple of eight, but itself.
PairSum sum_over_all(const PairLaw& law, const PairPoints& points, size_t place, size_t count);

}  // namespace tumble
