#pragma once
#include "engine/math/lcp/report.hpp"

namespace tumble::lcp {

/// Residuals of z, in units in which the diagonal of A is about 1 (for a group the greatest of its
/// three entries) and the largest term of A z + b is 1: they are invariant under scaling of rows
/// with columns, and of b with the bounds.
struct LcpResidual {
  double bounds = 0;   ///< greatest violation of a bound or a cone
  double natural = 0;  ///< greatest |z - P(z - w)|, P the projection on bounds and cones
  /// Greatest min(distance to the bound that the sign of w demands, 1) |w|.
  double complementarity = 0;
  double unit = 1;  ///< the largest term of A z + b, by which the others are divided
  double worst() const { return bounds > natural ? bounds : natural; }
};

/// For a problem that passes check() and z of its size; the residuals of a z that is not finite are
/// infinite. Computes w = A z + b from scratch.
LcpResidual validate(const LcpProblem& problem, const VecX& z);
/// The same; also returns w.
LcpResidual validate(const LcpProblem& problem, const VecX& z, VecX& w);
/// The same from w, the units d of the unknowns (scaling_of) and the largest term, without reading
/// A.
LcpResidual judge(const LcpProblem& problem, const std::vector<double>& d, double unit,
                  const VecX& z, const VecX& w);

/// The largest sum of the absolute terms of a row, |A| |z| + |b|, in those units: residuals are
/// relative to it. 1 if it is 0.
double term_unit(const LcpProblem& problem, const VecX& z);

/// w = A z + b, summed in the order of the columns.
VecX slack(const LcpProblem& problem, const VecX& z);

/// Proof that a problem with a symmetric semi-definite A has no solution: d with d_i > 0 only where
/// there is no upper bound, d_i < 0 only where there is no lower one, A d = 0 and b d < 0 (then w d
/// = b d < 0 for every z, while the signs require w d >= 0). Returns the deviation of d from these
/// conditions, such that in the units of LcpResidual there is no solution with a sum of |z| less
/// than the greatest |b| divided by this figure; infinity when b d >= 0. Groups are ignored.
double ray_residual(const LcpProblem& problem, const VecX& ray);

/// Computes w, residual and complementarity of a solution from its z, and turns `solved` into
/// `numeric` if the residual is above the tolerance, or above 1e-6 of the largest term at the point
/// within the bounds nearest to 0: otherwise terms that grow without bound could make any residual
/// small.
void grade(const LcpProblem& problem, double tolerance, LcpSolution& solution);
/// The same from its residual and the largest term at that point; w must be set.
void grade(const LcpResidual& residual, double rest_unit, double tolerance, LcpSolution& solution);
/// The point within the bounds that is nearest to 0.
VecX nearest_to_zero(const LcpProblem& problem);

}  // namespace tumble::lcp
