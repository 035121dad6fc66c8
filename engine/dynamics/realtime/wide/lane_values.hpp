#pragma once
#include "engine/dynamics/realtime/wide/wide_rows.hpp"
#include "engine/math/types.hpp"

namespace tumble {

/// Vectors and symmetric matrices to and from the single-precision arrays of the kernels.
inline void put_floats(std::array<float, 3>& to, const Vec3& v) {
  for (int k = 0; k < 3; ++k) to[size_t(k)] = float(v[k]);
}
inline Vec3 doubles_of(const std::array<float, 3>& v) {
  return {double(v[0]), double(v[1]), double(v[2])};
}
inline void put_floats(LaneVec& to, size_t lane, const Vec3& v) {
  for (int k = 0; k < 3; ++k) to[size_t(k)][lane] = float(v[k]);
}
inline Vec3 doubles_of(const LaneVec& v, size_t lane) {
  return {double(v[0][lane]), double(v[1][lane]), double(v[2][lane])};
}
inline std::array<float, 6> packed(const Mat3& m) {
  return {float(m(0, 0)), float(m(0, 1)), float(m(0, 2)),
          float(m(1, 1)), float(m(1, 2)), float(m(2, 2))};
}
inline void put_floats(LaneSym& to, size_t lane, const std::array<float, 6>& m) {
  for (size_t k = 0; k < 6; ++k) to[k][lane] = m[k];
}

}  // namespace tumble
