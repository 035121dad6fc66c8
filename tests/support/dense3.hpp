#pragma once
// What tests/support/dense.hpp has for three by three numbers, for sources that do without Eigen.
#include "engine/math/types.hpp"

namespace tumble::test {

/// x of A x = b by Gaussian elimination with full pivoting.
Vec3 solve(const Mat3& A, const Vec3& b);

/// Of a symmetric matrix, rising.
Vec3 symmetric_eigenvalues(const Mat3& A);

}  // namespace tumble::test
