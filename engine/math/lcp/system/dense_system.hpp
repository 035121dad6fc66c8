#pragma once
#include "engine/math/lcp/scaling.hpp"
#include "engine/math/lcp/system/cone_system.hpp"
#include "engine/math/lu.hpp"

namespace tumble::lcp {

/// A problem with a dense matrix. The linear system of a step has only the unknowns whose equation
/// is not simply dz_i = -f_i.
class DenseSystem final : public ConeSystem {
 public:
  /// The problem must outlive it.
  explicit DenseSystem(const LcpProblem& problem);

  const ScaledProblem& scaled() const { return scaled_; }
  const LcpProblem& conditions() const override { return problem_; }
  const std::vector<double>& units() const override { return scaled_.d; }
  const VecX& b() const override { return scaled_.b; }
  std::span<const ConeUnit> parts() const override { return parts_; }
  void slack(const VecX& z, VecX& w) override;
  bool step(std::span<const UnitValue> values, const VecX& f, double weight, VecX& dz) override;
  double residual(const VecX& z) override;
  void grade(double tolerance, LcpSolution& solution) override;
  void start_sweeps(const VecX& z) override;

 private:
  void add_row(const ConeUnit& unit, const UnitValue& value, size_t r, double weight,
               const VecX& dz);
  Triple swept_slack(size_t part) const override { return parts_[part].of(swept_w_); }
  const Square& own(size_t part) const override { return own_[part]; }
  void swept(size_t part, const Triple& by) override;

  const LcpProblem& problem_;
  const ScaledProblem scaled_;
  std::vector<ConeUnit> parts_;
  std::vector<Square> own_;
  std::vector<int> active_, place_;  ///< unknowns of the linear system; their columns
  std::vector<double> matrix_, right_;
  LuFactor lu_;
  VecX swept_w_;
};

}  // namespace tumble::lcp
