#pragma once
// Dense linear algebra for references. Each of Eigen's decompositions takes a source that names it
// two to fifteen seconds to compile, so they are compiled here, once for all tests.
#include "tests/support/dense3.hpp"

#include <complex>
#include <vector>

#include <Eigen/Core>

namespace tumble::test {

/// x of A x = b by Gaussian elimination with full pivoting, and the determinant of A.
struct Solved {
  Eigen::VectorXd x;
  double determinant;
};
Solved solve(const Eigen::MatrixXd& A, const Eigen::VectorXd& b);

/// x of A x = b for symmetric A by Cholesky's decomposition with pivoting, L D L^T.
Eigen::VectorXd solve_symmetric(const Eigen::MatrixXd& A, const Eigen::VectorXd& b);

/// X of least norm among those that make A X - B least in squares, by a complete orthogonal
/// decomposition, and the rank of A: pivots below `threshold` times the largest count as none.
struct LeastNorm {
  Eigen::MatrixXd x;
  Eigen::Index rank;
};
LeastNorm least_norm(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B, double threshold);

/// Falling.
Eigen::VectorXd singular_values(const Eigen::MatrixXd& A);
/// By falling real part, then by falling imaginary part.
std::vector<std::complex<double>> eigenvalues(const Eigen::MatrixXd& A);

/// A B and A B C, which take a source that multiplies matrices of any size two seconds.
Eigen::MatrixXd product(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B);
Eigen::MatrixXd product(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B,
                        const Eigen::MatrixXd& C);

}  // namespace tumble::test
