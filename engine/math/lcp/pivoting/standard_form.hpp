#pragma once
#include "engine/math/lcp/report.hpp"
#include "engine/math/lcp/scaling.hpp"

namespace tumble::lcp {

/// Whether no group is undecided.
bool all_slide(const LcpProblem& problem);
/// For groups that all slide: adds the columns of lateral unknowns, which follow the axial ones, to
/// those of the axial ones. Returns which unknowns are lateral.
std::vector<char> fold_sliding(const LcpProblem& problem, ScaledProblem& scaled);
/// Sets the lateral unknowns from the axial ones.
void set_sliding(const LcpProblem& problem, VecX& z);

/// A problem with bounds and sliding groups in the form w' = M v + q >= 0, v >= 0, v w' = 0: lower
/// bounds are shifted to 0, a second bound becomes a row and a multiplier, a free unknown the
/// difference of two, and lateral unknowns of sliding groups are replaced by their axial ones. M is
/// semi-definite if A is.
struct StandardForm {
  explicit StandardForm(const LcpProblem& problem);

  int size = 0;
  std::vector<double> M;  ///< by rows
  std::vector<double> q;
  /// z (unscaled) for a v of the standard form; with `direction` true only its linear part.
  VecX back(const std::vector<double>& v, bool direction) const;

 private:
  struct Part {
    enum Kind { above_lower, below_upper, multiplier, plus, minus } kind;
    int unknown;
  };
  double entry(int row, int column) const;

  const LcpProblem& problem_;
  ScaledProblem scaled_;  // laterals of sliding groups folded into the axial columns
  VecX rest_;             // z where v = 0
  std::vector<Part> parts_;
};

}  // namespace tumble::lcp
