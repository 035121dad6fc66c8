#pragma once
#include <cstddef>
#include <cstdint>

namespace tumble {

/// Grains in the order of the cells of a grid, as separate arrays, which are longer than the number
/// of grains by `grain_batch`.
struct GrainColumns {
  const double *x, *y, *z;  ///< [m]
  const float* extent;      ///< radius plus how far the grain may move towards others [m]
  const float* radius;      ///< [m]
  const float *way_x, *way_y, *way_z;  ///< motion relative to the mean of all grains [m]
  const uint32_t* place;
  const int32_t* ordinal;
};

/// Grains near a cell, relative to its centre, padded to a multiple of `grain_batch` with entries
/// far from everything.
struct GrainsNearCell {
  float *x, *y, *z, *extent, *radius, *way_x, *way_y, *way_z;  ///< [m]
  uint32_t* place;
  int32_t* ordinal;
};

/// No less than the number of lanes of a vector on any machine.
constexpr size_t grain_batch = 16;

/// Appends those grains of [begin, end) that lie in the cube about `centre` of half edge `half`
/// [m], in order, from index `size` on; returns the new size. `to` must have room for all of them
/// and one batch.
size_t add_near_cell(const GrainColumns& from, uint32_t begin, uint32_t end, const double* centre,
                     float half, const GrainsNearCell& to, size_t size);

/// A search for grains whose ordinals are above `after`, and whose distance from this grain is at
/// most the sum of the radii, of `more`, of grain_margin times the lesser radius, and of their
/// relative motion up to grain_foresight times the lesser radius.
struct NearGrain {
  float x, y, z;                                    ///< relative to the centre of the cell [m]
  float extent, radius, way_x, way_y, way_z, more;  ///< [m]
  int32_t after;
};

/// This bit of an index says that the distance is so near the limit that rounding may decide: the
/// grain may be one that is not searched for.
constexpr uint32_t doubtful_grain = uint32_t{1} << 31;

/// Writes the indices of the grains found among the first `padded`, in order; returns their number.
/// `out` must have room for all and one batch.
size_t find_near(const GrainsNearCell& among, size_t padded, const NearGrain& grain, uint32_t* out);

}  // namespace tumble
