#pragma once
#include "engine/math/lcp/system/cone_system.hpp"
#include "engine/math/lcp/tolerances.hpp"

namespace tumble::lcp {

/// Limits of Newton's method.
struct NewtonLimits {
  int steps;    ///< from one start
  int systems;  ///< matrices factored, unless options give another limit
  int sweeps;   ///< sweeps of projected Gauss-Seidel before the last start
};

/// Semi-smooth Newton on the natural map of a system (natural_map.hpp), with the best point found.
/// Rows may be redundant, so a weight is added to the diagonal of A in the linear systems, but not
/// in the map: each step is the first Newton step of a proximal problem that is centred at its
/// start (proximal point method, Rockafellar 1976, whose problems need not be solved any further
/// than that). Points are in scaled units.
class SemismoothNewton {
 public:
  static constexpr double usual_weight = tolerances::usual_weight;

  SemismoothNewton(ConeSystem& system, const NewtonLimits& limits, const LcpOptions& options);

  /// Measures a point; true if it is good enough.
  bool consider(const VecX& z);
  /// Steps from z until nothing is gained. True if the best point is good enough.
  bool attempt(VecX z, double weight = usual_weight);
  /// Starts from the solution with the rows of all undecided groups as equations.
  bool attempt_inside();
  /// Restarts after increasing numbers of sweeps, which begin at z.
  bool attempt_after_sweeps(VecX z);

  const BestPoint& best() const { return best_; }
  LcpSolution answer(const LcpOptions& options) const;

 private:
  double evaluate(const VecX& z);
  bool step(const VecX& z, bool inside, double weight, VecX& dz);
  double search_line(VecX& z, const VecX& dz, double& merit);
  bool may_go_on() const { return systems() < limit_; }
  int systems() const { return system_.systems - first_system_; }

  ConeSystem& system_;
  NewtonLimits limits_;
  double goal_;
  int limit_, first_system_;
  VecX w_, f_;
  BestPoint best_;
  std::vector<UnitValue> values_;
};

/// Refuses a start that is not of the problem's size or not finite.
Status check_start(const LcpProblem& conditions, const VecX& start);

}  // namespace tumble::lcp
