#pragma once
#include "engine/math/lcp/problem.hpp"

#include <array>
#include <vector>

namespace tumble::lcp {

/// Smooth stand-ins for the conditions of a problem in scaled units, unit by unit: F(z, w) whose
/// zeros at w = A z + b are, as the smoothing t goes to 0, the solutions. For t > 0 they are the
/// central path: what is complementary has the product t^2, both factors inside their cones.
///
/// Unknowns with bounds and the axial ones of sliding groups use the function of Chen, Harker,
/// Kanzow and Smale, g(v) = (v + sqrt(v^2 + 4 t^2)) / 2. A circular group is, by the change of
/// variable of De Saxcé (De Saxcé & Feng 1998), x = (slope z_a, z_t) and y = (w_a / slope + |w_t|,
/// w_t) in the same self-dual cone with x y = 0, and g is applied to the spectral values of x - y
/// (Fukushima, Luo & Tseng, "Smoothing functions for second-order-cone complementarity problems",
/// SIAM J. Optim. 12, 2001). |w_t| is rounded off by t^2, in units of the greatest |b|, which is
/// what w_t is on the path where the group rests: with more the path need not go on to t = 0.
class SmoothedMap {
 public:
  /// A group, or an unknown by itself.
  struct Unit {
    int count = 1;
    std::array<int, 3> row{};
    const ConeGroup* group = nullptr;
  };
  /// F of a unit and its derivatives with respect to its z and its w, by rows of 3.
  struct Value {
    std::array<double, 3> f{};
    std::array<double, 9> by_z{}, by_w{};
  };

  /// Bounds and b in scaled units; the groups must outlive it.
  SmoothedMap(const std::vector<ConeGroup>& groups, const VecX& b, VecX lower, VecX upper);

  const std::vector<Unit>& units() const { return units_; }
  double scale() const { return scale_; }
  Value value(const Unit& unit, const VecX& z, const VecX& w, double smoothing) const;

 private:
  void add_single(int i, const VecX& z, const VecX& w, double t, Value& out) const;

  VecX lower_, upper_;
  double scale_ = 0;  ///< the greatest |b|
  std::vector<Unit> units_;
};

}  // namespace tumble::lcp
