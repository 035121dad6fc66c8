#pragma once
#include "engine/math/lcp/report.hpp"

#include <array>
#include <limits>
#include <span>
#include <vector>

namespace tumble::lcp {

using Triple = std::array<double, 3>;
using Square = std::array<double, 9>;  ///< 3 x 3 by rows

/// A group, or a single unknown, in scaled units (scaling.hpp).
struct ConeUnit {
  int count = 1;  ///< number of unknowns: 1, or 3 for a group
  /// Indices of the axial and the lateral unknowns, or of the single one.
  std::array<int, 3> row{};
  const ConeGroup* group = nullptr;
  double lower = 0, upper = 0;  ///< bounds of the first unknown

  /// The entries of a vector that belong to the unit.
  Triple of(const VecX& v) const {
    return count == 1 ? Triple{v[row[0]], 0, 0} : Triple{v[row[0]], v[row[1]], v[row[2]]};
  }
};

/// Groups first, then the other unknowns in order. The groups must outlive the units.
std::vector<ConeUnit> cone_units(const LcpProblem& conditions, const std::vector<double>& d);

/// Conditions of a unit as a function F(z, w) whose zeros are the solutions, and its derivatives.
struct UnitValue {
  Triple f{};
  Square by_z{}, by_w{};
};

/// A problem as iterative methods use it, independent of the form of A. In scaled units unless
/// stated otherwise.
class ConeSystem {
 public:
  virtual ~ConeSystem() = default;

  virtual const LcpProblem& conditions() const = 0;      ///< all but A, in the problem's units
  virtual const std::vector<double>& units() const = 0;  ///< of the unknowns
  virtual const VecX& b() const = 0;
  virtual std::span<const ConeUnit> parts() const = 0;
  int size() const { return int(b().size()); }
  VecX in_own_units(VecX z) const;
  VecX in_scaled_units(VecX z) const;
  /// The point within the bounds that is nearest to 0.
  VecX rest() const;

  /// w = A z + b
  virtual void slack(const VecX& z, VecX& w) = 0;
  /// Solves by_z dz + by_w (A + weight) dz = -f, by parts; false if it is singular.
  virtual bool step(std::span<const UnitValue> values, const VecX& f, double weight, VecX& dz) = 0;
  /// LcpResidual::worst() of a z in the problem's units.
  virtual double residual(const VecX& z) = 0;
  /// grade() of validate.hpp.
  virtual void grade(double tolerance, LcpSolution& solution) = 0;

  /// Projected Gauss-Seidel, part by part: start_sweeps(z), then any number of sweep(z), which
  /// returns the greatest change of an unknown.
  virtual void start_sweeps(const VecX& z) = 0;
  double sweep(VecX& z);

  int systems = 0;  ///< matrices factored so far

 protected:
  /// w of a part during sweeps, and the part's diagonal block of A.
  virtual Triple swept_slack(size_t part) const = 0;
  virtual const Square& own(size_t part) const = 0;
  /// z of a part has changed by this.
  virtual void swept(size_t part, const Triple& by) = 0;
};

/// The point with the least residual so far.
struct BestPoint {
  explicit BestPoint(int size) : z(VecX::Zero(size)) {}
  void consider(ConeSystem& system, const VecX& scaled);

  VecX z;  ///< in the problem's units
  double residual = std::numeric_limits<double>::infinity();
};

/// Completes a solution; the status is solved if the residual is within the tolerance.
void grade_iterated(ConeSystem& system, const LcpOptions& options, LcpSolution& solution);

}  // namespace tumble::lcp
