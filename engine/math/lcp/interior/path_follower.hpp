#pragma once
#include "engine/math/lcp/interior/smoothed_map.hpp"
#include "engine/math/lcp/report.hpp"

#include <limits>
#include <span>

namespace tumble::lcp {

/// A problem as the path follower sees it, in scaled units.
class PathProblem {
 public:
  virtual ~PathProblem() = default;
  virtual const LcpProblem& conditions() const = 0;
  virtual const std::vector<double>& units() const = 0;  ///< of the unknowns
  virtual const VecX& b() const = 0;
  /// w = A z + b
  virtual void slack(const VecX& z, VecX& w) = 0;
  /// dz with (by_z + by_w A) dz = -f, A made regular by a little on its diagonal; false where there
  /// is none.
  virtual bool step(std::span<const SmoothedMap::Unit> parts,
                    std::span<const SmoothedMap::Value> values, const VecX& f, VecX& dz) = 0;
  /// LcpResidual::worst() of a z in the problem's own units.
  virtual double residual(const VecX& z) = 0;
};

/// Follows the central path of a problem to its end by Newton's method with a line search, the
/// smoothing falling as fast as that goes well.
class PathFollower {
 public:
  PathFollower(PathProblem& problem, const LcpOptions& options);

  void follow();
  const VecX& best() const { return best_; }  ///< z in the problem's own units
  double best_residual() const { return best_residual_; }
  int systems() const { return systems_; }

 private:
  void evaluate(const VecX& z, double smoothing);
  double size() const;
  bool reach(VecX& z, double smoothing);
  bool consider(const VecX& z);

  PathProblem& problem_;
  VecX lower_, upper_;
  SmoothedMap map_;
  std::vector<SmoothedMap::Value> values_;
  VecX w_, f_, best_;
  double best_residual_ = std::numeric_limits<double>::infinity();
  double goal_, enough_;
  int limit_, systems_ = 0;
};

/// The answer of a path: settled but for w and residuals.
LcpSolution path_solution(const LcpProblem& conditions, const PathFollower& path);

}  // namespace tumble::lcp
