#pragma once
#include "engine/geometry/triangle_mesh.hpp"

namespace tumble {

/// Volume, first and second moments of a solid about a point, as sums over its triangles of signed
/// tetrahedra with their apex there.
struct MomentSums {
  double volume6 = 0;             ///< 6 integral 1 [m^3]
  Vec3 moment24 = Vec3::Zero();   ///< 24 integral x [m^4]
  Mat3 second120 = Mat3::Zero();  ///< 120 integral x x^T [m^5]
  /// What rounding is relative to: the same sums with every product taken by its magnitude. Of all
  /// triangles: a few large ones among thousands of small ones may decide.
  double size6 = 0;    ///< of volume6 [m^3]
  double size120 = 0;  ///< of the trace of second120 [m^5]
};

/// In double, four triangles at a time, summed in blocks of 128 with compensation between blocks
/// (Neumaier 1974): the rounding that remains is that of the triangles' own terms. Bits are the
/// same for every width of vector instructions. `narrow`: with the instructions that every machine
/// has, for tests.
MomentSums sum_moments(const TriangleMesh& mesh, const Vec3& origin, bool narrow = false);

/// Mass, centre and inertia at density 1 from sums about `origin`.
struct SolidMoments {
  double volume = 0;            ///< signed [m^3]
  Vec3 centre = Vec3::Zero();   ///< [m]
  Mat3 inertia = Mat3::Zero();  ///< about the centre [m^5]
};
SolidMoments moments_about_centre(const MomentSums& sums, const Vec3& origin);

/// Whether rounding of `sums` may exceed 1e-14 of volume, size or inertia: thin sheets, much wound
/// solids.
bool too_rough(const MomentSums& sums, const SolidMoments& moments, const Vec3& origin);

/// The same with about 106 bits, good to a few units in the last place for any solid that is
/// thicker than 1e-14 of its size. Some hundred times slower.
SolidMoments precise_moments(const TriangleMesh& mesh, const Vec3& origin);

}  // namespace tumble
