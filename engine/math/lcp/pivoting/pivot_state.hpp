#pragma once
#include "engine/math/lcp/pivoting/ldl.hpp"
#include "engine/math/lcp/report.hpp"
#include "engine/math/lcp/scaling.hpp"

#include <cstdint>

namespace tumble::lcp {

/// Where an unknown is.
enum class Place : uint8_t { lower, between, upper };

/// A point of principal pivoting: each unknown is clamped (a member of the factorisation, its w is
/// 0) or not (at a bound; a free one whose row depends on the clamped rows rests where it is).
/// z and w = A z + b are kept in scaled units.
struct PivotState {
  explicit PivotState(const ScaledProblem& problem);

  const ScaledProblem& problem;
  LdlFactor factor;
  std::vector<Place> place;
  std::vector<char> clamped;
  std::vector<char> excused;  ///< w misses 0 by no more than rounding of dependent rows can explain
  VecX z, w;
  int pivots = 0;
  double magnitude = 0;  ///< of the terms that make up w: what its rounding errors are relative to

  bool is_free(int i) const;
  bool is_fixed(int i) const { return problem.lower[i] == problem.upper[i]; }
  /// By how much w_i has the wrong sign; 0 for clamped, fixed and excused unknowns.
  double wrong(int i) const;
  /// By how much z_i is beyond its bounds: negative below the lower, positive above the upper.
  double beyond(int i) const;
  double tolerance() const { return 1e-13 * magnitude; }

  /// The column of i in the rows of the clamped unknowns, through L^-1, in `y`; what remains of
  /// A_ii.
  double reduce(int i, std::vector<double>& y) const;
  /// Clamps i unless less than `least` remains of its diagonal entry.
  bool enter(int i, double least);
  /// Clamps i with known y and remainder.
  void enter(int i, const std::vector<double>& y, double remainder);
  /// Puts a clamped unknown at one of its bounds.
  void leave(int i, Place to);
  void leave_at(int position, Place to);
  /// Puts those at `positions` (ascending) at their nearer bounds; factors anew where that is less
  /// work.
  void leave_many(const std::vector<int>& positions);
  /// z of the clamped unknowns from the others, then w.
  void solve();
  /// One step of iterative refinement of the clamped unknowns.
  void refine();
  /// w = A z + b from scratch.
  void renew_w();
  /// Identifies the set of clamped unknowns and the places of the others.
  uint64_t signature() const;

 private:
  void factor_anew(const std::vector<int>& members);
  std::vector<double> y_;
};

}  // namespace tumble::lcp
