#pragma once
#include <cstddef>
#include <cstdint>

namespace tumble {

/// Grains in the order of the cells of a grid, a number of each in an array of its own; arrays are
/// longer by `grain_batch` than there are grains.
struct GrainColumns {
  const double *x, *y, *z;  ///< [m]
  const float* extent;      ///< radius, and what the grain may close on others [m]
  const uint32_t* place;
  const int32_t* ordinal;
};

/// Grains near a cell, relative to its centre, filled up to a multiple of `grain_batch` with what
/// is far from everything.
struct GrainsNearCell {
  float *x, *y, *z, *extent;  ///< [m]
  uint32_t* place;
  int32_t* ordinal;
};

/// At least as many as a vector has lanes on any machine.
constexpr size_t grain_batch = 16;

/// Writes those of [begin, end) that are in the cube about `centre` whose faces are `half` metres
/// from it, in their order, from `size` on; gives the new size. There is room for all and a batch.
size_t add_near_cell(const GrainColumns& from, uint32_t begin, uint32_t end, const double* centre,
                     float half, const GrainsNearCell& to, size_t size);

/// What a search looks for: grains whose ordinals are above `after`, and which are no farther
/// from a point than the sum of their extents and its own.
struct NearGrain {
  float x, y, z, extent;  ///< relative to the centre of the cell [m]
  int32_t after;
};

/// Indices of what is found among the first `padded`, in their order; how many. `out` has room for
/// all and a batch.
size_t find_near(const GrainsNearCell& among, size_t padded, const NearGrain& grain, uint32_t* out);

}  // namespace tumble
