#pragma once
#include "engine/collision/shapes/vertex_scan.hpp"
#include "engine/math/triple.hpp"

#include <cstddef>

namespace tumble {

/// The pose of B in A's frame: columns of the rotation and the translation, padded to the width of
/// SIMD registers.
struct PaddedPose {
  alignas(32) double column[4][4];  ///< the fourth is the translation [m]

  Plain3 row(size_t k) const { return {column[0][k], column[1][k], column[2][k]}; }
  Plain3 shift() const { return {column[3][0], column[3][1], column[3][2]}; }
  /// Transforms a point from B's frame to A's.
  Plain3 operator*(const Plain3& p) const {
    return Plain3{row(0).dot(p), row(1).dot(p), row(2).dot(p)} + shift();
  }
  /// Rotates a direction from A's frame to B's.
  Plain3 back(const Plain3& d) const { return row(0) * d.x + row(1) * d.y + row(2) * d.z; }

  /// Computed from the rotations of both and the vector from A's origin to B's, all in one frame,
  /// in the registers of `Scan`, with the same rounding for each.
  template <class Scan>
  void set(const Mat3& A, const Mat3& B, const Plain3& way) {
    const double *a = A.data(), *b = B.data();
    for (size_t k = 0; k < 3; ++k)
      Scan::turn_back(a, b[3 * k], b[3 * k + 1], b[3 * k + 2], column[k]);
    Scan::turn_back(a, way.x, way.y, way.z, column[3]);
  }
};

}  // namespace tumble
