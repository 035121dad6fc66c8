#pragma once
#include <cstddef>
#include <cstdint>

namespace tumble {

/// Points that may be neighbours of those of a cell, relative to its centre [m], in arrays padded
/// to a multiple of eight with points far away.
struct NeighbourCandidates {
  const float* x;
  const float* y;
  const float* z;
  const uint32_t* place;
  size_t padded;
};

/// Writes the places of the candidates within sqrt(reach2) of a point, except for the place `self`,
/// in order, and returns their number. `out` must have room for NeighbourCandidates::padded and
/// eight more.
size_t gather_near(const NeighbourCandidates& candidates, const float* point, float reach2,
                   uint32_t self, uint32_t* out);
/// The same of four points together, by coordinate: the candidates within reach of any of them, and
/// they themselves.
size_t gather_near_four(const NeighbourCandidates& candidates, const float (&points)[3][4],
                        float reach2, uint32_t* out);

}  // namespace tumble
