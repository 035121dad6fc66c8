#pragma once
#include "engine/math/lcp/scaling.hpp"
#include "engine/math/lu.hpp"

namespace tumble::lcp {

/// F(z) = z - P(z - w), whose zeros are the solutions, after Alart & Curnier (1991): P projects on
/// the bounds, for a group on its cone at the axial value max(0, z_a - w_a). Here w = A z + b +
/// regularisation (z - centre), in scaled units.
class NaturalMap {
 public:
  NaturalMap(const LcpProblem& problem, const ScaledProblem& scaled);

  VecX centre;
  double regularisation = 0;

  /// Evaluates F, and w, at z.
  void evaluate(const VecX& z);
  const VecX& value() const { return f_; }
  double merit() const;
  /// The semi-smooth Newton step dz with J dz = -F, where J is an element of the generalised
  /// Jacobian at the point of the last evaluate(); false when J is singular.
  bool step(VecX& dz);

 private:
  /// A row of J: own entries of the identity part plus multiples of rows of A' = A +
  /// regularisation.
  struct Row {
    int unknown;
    std::array<int, 3> plain{-1, -1, -1};  ///< unknowns with entry plain_value
    std::array<double, 3> plain_value{};
    std::array<int, 3> slack{-1, -1, -1};  ///< rows of A' with factor slack_value
    std::array<double, 3> slack_value{};
  };
  void evaluate_group(const ConeGroup& g, const VecX& z);
  void add_group_rows(const ConeGroup& g);
  void set_still(int i);
  void set_equation(int i);
  void fill_row(const Row& row, int r, int m, std::vector<double>& a, double& right) const;

  const LcpProblem& problem_;
  const ScaledProblem& p_;
  VecX z_, w_, f_, step_;
  std::vector<char> grouped_;
  std::vector<int> active_, place_;  // unknowns that the linear system is in, and their columns
  std::vector<Row> rows_;
  LuFactor lu_;
};

}  // namespace tumble::lcp
