#pragma once
#include "engine/core/result.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

/// Linear complementarity with bounds and cones. The code is independent of the meaning and units
/// of the unknowns.
namespace tumble::lcp {

using VecX = Eigen::VectorXd;
using MatX = Eigen::MatrixXd;

enum class ConeMode : uint8_t {
  /// The lateral part is in the cone, and opposes w_lateral on its surface.
  undecided,
  sliding,  ///< z_lateral = -slope z_axial direction, for any w_lateral
};

enum class ConeShape : uint8_t {
  circular,  ///< |z_lateral| <= slope z_axial
  pyramid,   ///< |z_lateral[k]| <= slope z_axial for each k separately
};

/// Three unknowns coupled by a cone: for axial a and laterals t
///   z_a >= 0, w_a >= 0, z_a w_a = 0, and, undecided,
///   z_t in the cone of this slope, w_t = -k z_t with k >= 0, k = 0 inside the cone
/// (for a pyramid: for each lateral unknown separately).
struct ConeGroup {
  int axial = 0;                 ///< its bounds are 0 and infinity
  std::array<int, 2> lateral{};  ///< their bounds are infinite
  double slope = 0;              ///< >= 0
  ConeMode mode = ConeMode::undecided;
  ConeShape shape = ConeShape::circular;
  std::array<double, 2> direction{};  ///< unit; read in mode sliding only
};

/// Find z, and w = A z + b, with lower <= z <= upper and
///   w_i >= 0 where z_i = lower_i, w_i <= 0 where z_i = upper_i, w_i = 0 between;
/// any w_i where lower_i = upper_i. Infinite bounds make an unknown free and its row an equation.
/// The groups restrict and relate unknowns further. (Cottle, Pang & Stone, The Linear
/// Complementarity Problem, chapter 1; Coutinho, Guide to Dynamic Simulations, chapter 14.)
struct LcpProblem {
  MatX A;
  VecX b, lower, upper;
  std::vector<ConeGroup> groups;

  int size() const { return int(b.size()); }
  /// All bounds 0 and infinity, no groups.
  static LcpProblem plain(MatX A, VecX b);
  /// Adds an undecided, circular group of an axial unknown and the two that follow it in index.
  ConeGroup& add_group(int axial, double slope);
};

/// Refuses unequal sizes, non-finite A or b, NaN or crossed bounds, and groups that share unknowns,
/// have indices out of range, wrong bounds, a negative or non-finite slope, or (sliding) a
/// direction that is not of unit length. An empty problem is valid, and solved.
Status check(const LcpProblem& problem);
/// The same without checking A.
Status check_conditions(const LcpProblem& problem);

/// Refuses a matrix with |A_ij - A_ji| > 1e-10 sqrt(A_ii A_jj).
Status check_symmetric(const LcpProblem& problem);

}  // namespace tumble::lcp
