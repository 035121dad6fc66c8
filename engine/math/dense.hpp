#pragma once
#include "engine/math/types.hpp"

#include <Eigen/Core>

// Conversions to and from vectors and matrices of dynamic size, which are Eigen's. For sources that
// pass small vectors to a solver of dynamic size. Widely included headers should avoid it: Eigen
// would be two thirds of what they compile.
namespace tumble {

inline Eigen::Map<const Eigen::Vector3d> dense(const Vec3& v) {
  return Eigen::Map<const Eigen::Vector3d>(v.data());
}
inline Eigen::Map<const Eigen::Matrix3d> dense(const Mat3& m) {
  return Eigen::Map<const Eigen::Matrix3d>(m.data());
}
/// Three coefficients of an expression as a Vec3.
template <class Expression>
Vec3 small_vector(const Eigen::MatrixBase<Expression>& v) {
  return {v(0), v(1), v(2)};
}
/// Three by three coefficients of an expression as a Mat3.
template <class Expression>
Mat3 small_matrix(const Eigen::MatrixBase<Expression>& m) {
  return {m(0, 0), m(0, 1), m(0, 2), m(1, 0), m(1, 1), m(1, 2), m(2, 0), m(2, 1), m(2, 2)};
}

}  // namespace tumble
