#pragma once
#include "engine/math/lcp/report.hpp"

#include <array>
#include <limits>
#include <span>
#include <vector>

namespace tumble::lcp {

using Triple = std::array<double, 3>;
using Square = std::array<double, 9>;  ///< 3 x 3 by rows

/// A group, or an unknown by itself, in scaled units (scaling.hpp).
struct ConeUnit {
  int count = 1;             ///< of unknowns: 1, or 3 with a group
  std::array<int, 3> row{};  ///< the axial and the lateral ones, or the unknown
  const ConeGroup* group = nullptr;
  double lower = 0, upper = 0;  ///< of the first

  /// The part of a vector that belongs to the unit.
  Triple of(const VecX& v) const {
    return count == 1 ? Triple{v[row[0]], 0, 0} : Triple{v[row[0]], v[row[1]], v[row[2]]};
  }
};

/// Groups first, then the others in order. The groups must outlive them.
std::vector<ConeUnit> cone_units(const LcpProblem& conditions, const std::vector<double>& d);

/// The conditions of a unit as a function F(z, w) with a zero where they hold, and its derivatives.
struct UnitValue {
  Triple f{};
  Square by_z{}, by_w{};
};

/// weight (z - centre), which is added to A z + b where rows of A are redundant.
struct Proximal {
  double weight = 0;
  VecX centre;
};

/// A problem as the iterative methods see it, whatever form its A has: all in scaled units unless
/// it is said otherwise.
class ConeSystem {
 public:
  virtual ~ConeSystem() = default;

  virtual const LcpProblem& conditions() const = 0;      ///< all but A, in their own units
  virtual const std::vector<double>& units() const = 0;  ///< of the unknowns
  virtual const VecX& b() const = 0;
  virtual std::span<const ConeUnit> parts() const = 0;
  int size() const { return int(b().size()); }
  VecX in_own_units(VecX z) const;
  VecX in_scaled_units(VecX z) const;
  /// The point of the bounds that is nearest to 0.
  VecX rest() const;

  /// w = A z + b + weight (z - centre)
  virtual void slack(const VecX& z, const Proximal& about, VecX& w) = 0;
  /// dz with by_z dz + by_w (A + weight) dz = -f, by parts; false where there is none.
  virtual bool step(std::span<const UnitValue> values, const VecX& f, double weight, VecX& dz) = 0;
  /// At most the largest term of A z + b, in absolute value; not 0.
  virtual double least_term(const VecX& z) const = 0;
  /// LcpResidual::worst() of a z in the problem's own units.
  virtual double residual(const VecX& z) = 0;
  /// grade() of validate.hpp.
  virtual void grade(double tolerance, LcpSolution& solution) = 0;

  /// Projected Gauss-Seidel, part by part: start_sweeps(z), then any number of sweep(z), which give
  /// the greatest change of an unknown.
  virtual void start_sweeps(const VecX& z) = 0;
  double sweep(VecX& z);

  int systems = 0;  ///< matrices factored so far

 protected:
  /// w of a part in the sweeps, and the part's own block of A.
  virtual Triple swept_slack(size_t part) const = 0;
  virtual const Square& own(size_t part) const = 0;
  /// z of a part has changed by so much.
  virtual void swept(size_t part, const Triple& by) = 0;
};

/// The point with the least residual of those that were looked at.
struct BestPoint {
  explicit BestPoint(int size) : z(VecX::Zero(size)) {}
  void consider(ConeSystem& system, const VecX& scaled);

  VecX z;  ///< in the problem's own units
  double residual = std::numeric_limits<double>::infinity();
};

/// Completes an answer that is solved if its residual says so.
void grade_iterated(ConeSystem& system, const LcpOptions& options, LcpSolution& solution);

}  // namespace tumble::lcp
