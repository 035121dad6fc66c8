#pragma once
#include "engine/math/lcp/report.hpp"

namespace tumble::lcp {

/// How well z solves a problem, in units in which the diagonal of A is about 1 (per group the
/// greatest of its three entries) and the largest term of A z + b is 1: no scaling of rows with
/// columns, nor of b with the bounds, changes these figures.
struct LcpResidual {
  double bounds = 0;           ///< greatest violation of a bound or a cone
  double natural = 0;          ///< greatest |z - P(z - w)|, P the projection on bounds and cones
  double complementarity = 0;  ///< greatest min(distance from the bound that w pushes to, 1) |w|
  double unit = 1;             ///< the largest term of A z + b, which the others are relative to
  double worst() const { return bounds > natural ? bounds : natural; }
};

/// For a problem that passes check() and z of its size; a z that is not finite has infinite
/// residuals. Computes w = A z + b from scratch.
LcpResidual validate(const LcpProblem& problem, const VecX& z);
/// The same; also gives w.
LcpResidual validate(const LcpProblem& problem, const VecX& z, VecX& w);
/// The same from w, the units d of the unknowns (scaling_of) and the largest term; A is not read.
LcpResidual judge(const LcpProblem& problem, const std::vector<double>& d, double unit,
                  const VecX& z, const VecX& w);

/// The largest sum of the terms of a row of |A| |z| + |b| in those units: what residuals are
/// relative to. 1 if that is 0.
double term_unit(const LcpProblem& problem, const VecX& z);

/// w = A z + b, summed in the order of the columns.
VecX slack(const LcpProblem& problem, const VecX& z);

/// Proof that a problem with a symmetric semi-definite A has no solution: d with d_i > 0 only where
/// there is no upper bound, d_i < 0 only where there is no lower one, A d = 0 and b d < 0 (then
/// w d = b d < 0 for every z, while the signs demand w d >= 0). Returns how far d is from that,
/// such that in the units of LcpResidual there is no solution whose |z| add up to less than the
/// greatest |b| divided by this figure; infinity when b d >= 0. Groups are not looked at.
double ray_residual(const LcpProblem& problem, const VecX& ray);

/// Fills w, residual and complementarity of a solution from its z, and turns `solved` into
/// `numeric` when the residual is above the tolerance; or above 1e-6 of the largest term at the
/// point of the bounds that is nearest to 0, lest terms that grow without limit make anything
/// small.
void grade(const LcpProblem& problem, double tolerance, LcpSolution& solution);
/// The same from its residual and the largest term at that point; w must be known.
void grade(const LcpResidual& residual, double rest_unit, double tolerance, LcpSolution& solution);
/// The point of the bounds that is nearest to 0.
VecX nearest_to_zero(const LcpProblem& problem);

}  // namespace tumble::lcp
