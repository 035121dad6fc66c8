#pragma once
#include "engine/math/lcp/blocks/block_units.hpp"
#include "engine/math/lcp/validate.hpp"

namespace tumble::lcp {

/// A problem with A = G G^T, with linear systems in the columns of G rather than in its rows: the
/// step by_z dz + by_w (A + e) dz = -f has a = G^T dz from (1 + G^T D G) a = -G^T E^-1 f, where E =
/// by_z + e by_w and D = E^-1 by_w are diagonal except for groups (Woodbury). This matrix is as
/// sparse as the graph of blocks that share rows, and regular for redundant rows. Its factorisation
/// is kept as long as D is unchanged.
class BlockSystem final : public ConeSystem {
 public:
  /// The problem must outlive it.
  explicit BlockSystem(const BlockProblem& problem);

  const LcpProblem& conditions() const override { return problem_.conditions; }
  const std::vector<double>& units() const override { return units_.d; }
  const VecX& b() const override { return units_.b; }
  std::span<const ConeUnit> parts() const override { return units_.parts; }
  void slack(const VecX& z, VecX& w) override;
  bool step(std::span<const UnitValue> values, const VecX& f, double weight, VecX& dz) override;
  /// Relative to the largest sum of terms within units, which is at most that of all terms.
  double residual(const VecX& z) override;
  /// As for problems with a matrix, up to the rounding of w.
  LcpResidual validate(const VecX& z, VecX& w) { return judged(z, largest_term(z), w); }
  void grade(double tolerance, LcpSolution& solution) override;
  void start_sweeps(const VecX& z) override { units_.gather(z, u_); }

 private:
  LcpResidual judged(const VecX& z, double unit, VecX& w);
  double largest_term(const VecX& z) const { return lcp::largest_term(problem_, units_.d, z); }
  bool renew_factor(std::vector<Square> responses);
  Triple swept_slack(size_t part) const override;
  const Square& own(size_t part) const override { return units_.entries[part].own; }
  void swept(size_t part, const Triple& by) override { units_.add_rows(part, by, u_); }

  const BlockProblem& problem_;
  const BlockUnits units_;
  std::vector<double> u_, a_;
  std::vector<Square> responses_;  ///< D at the last factorisation
  bool factored_ = false;
  BlockFactor factor_;
};

}  // namespace tumble::lcp
