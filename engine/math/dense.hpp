#pragma once
#include "engine/math/types.hpp"

#include <Eigen/Core>

// The way to and from vectors and matrices of a size that is found at run time, which are Eigen's.
// For sources that hand small vectors to a solver of such a size; headers that many read should do
// without, since Eigen is two thirds of what a compiler would read for them.
namespace tumble {

inline Eigen::Map<const Eigen::Vector3d> dense(const Vec3& v) {
  return Eigen::Map<const Eigen::Vector3d>(v.data());
}
inline Eigen::Map<const Eigen::Matrix3d> dense(const Mat3& m) {
  return Eigen::Map<const Eigen::Matrix3d>(m.data());
}
/// Three coefficients of an expression as a vector of the house.
template <class Expression>
Vec3 small_vector(const Eigen::MatrixBase<Expression>& v) {
  return {v(0), v(1), v(2)};
}
/// Three by three coefficients of an expression as a matrix of the house.
template <class Expression>
Mat3 small_matrix(const Eigen::MatrixBase<Expression>& m) {
  return {m(0, 0), m(0, 1), m(0, 2), m(1, 0), m(1, 1), m(1, 2), m(2, 0), m(2, 1), m(2, 2)};
}

}  // namespace tumble
