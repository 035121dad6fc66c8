#include "tests/support/dense.hpp"

#include "engine/math/dense.hpp"

#include <algorithm>

#include <Eigen/Dense>

namespace tumble::test {

Solved solve(const Eigen::MatrixXd& A, const Eigen::VectorXd& b) {
  const Eigen::FullPivLU<Eigen::MatrixXd> lu(A);
  return {lu.solve(b), lu.determinant()};
}

Vec3 solve(const Mat3& A, const Vec3& b) {
  const Eigen::Vector3d x = dense(A).fullPivLu().solve(dense(b));
  return small_vector(x);
}

Eigen::VectorXd solve_symmetric(const Eigen::MatrixXd& A, const Eigen::VectorXd& b) {
  return A.ldlt().solve(b);
}

LeastNorm least_norm(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B, double threshold) {
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> dense(A);
  dense.setThreshold(threshold);
  return {dense.solve(B), dense.rank()};
}

Eigen::VectorXd singular_values(const Eigen::MatrixXd& A) {
  return Eigen::JacobiSVD<Eigen::MatrixXd>(A).singularValues();
}

Vec3 symmetric_eigenvalues(const Mat3& A) {
  return small_vector(Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(dense(A)).eigenvalues());
}

std::vector<std::complex<double>> eigenvalues(const Eigen::MatrixXd& A) {
  const auto all = Eigen::EigenSolver<Eigen::MatrixXd>(A, false).eigenvalues();
  std::vector<std::complex<double>> out(all.begin(), all.end());
  std::ranges::sort(out, [](const auto& a, const auto& b) {
    return a.real() != b.real() ? a.real() > b.real() : a.imag() > b.imag();
  });
  return out;
}

Eigen::MatrixXd product(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B) {
  return A * B;
}
Eigen::MatrixXd product(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B,
                        const Eigen::MatrixXd& C) {
  return A * B * C;
}

}  // namespace tumble::test
