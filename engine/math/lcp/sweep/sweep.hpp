#pragma once
#include "engine/math/lcp/scaling.hpp"

namespace tumble::lcp {

/// Projected Gauss-Seidel over the unknowns in order, groups last, in scaled units; w = A z + b is
/// kept up to date.
class Sweeper {
 public:
  Sweeper(const LcpProblem& problem, const ScaledProblem& scaled);

  VecX z, w;
  /// w from z.
  void renew();
  /// One pass; the greatest change of an unknown.
  double sweep();

 private:
  void change(int i, double to);
  void sweep_axial(const ConeGroup& g);
  void sweep_lateral(const ConeGroup& g);

  const LcpProblem& problem_;
  const ScaledProblem& p_;
  std::vector<char> grouped_;
  double most_ = 0;
};

}  // namespace tumble::lcp
