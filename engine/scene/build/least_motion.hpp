#pragma once
#include "engine/scene/build/jointed_bodies.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace tumble {

/// A hard limit of a coordinate x of a joint: sign (x - bound) >= 0.
struct KeptLimit {
  uint32_t joint = 0, coordinate = 0;
  double bound = 0;  ///< [m] or [rad]
  double sign = 1;   ///< 1: x is not below the bound; -1: not above it
};

/// Of all displacements, or velocities, that the joints, couplings and hard limits of bodies allow
/// to first order, the nearest to a wanted one p* in the metric of mass:
///   min (p - p*)^T M (p - p*) / 2   with   G p = -C   and   s (x + g.p - bound) >= 0.
/// M is positive definite, so that there is one at most. The dual active-set method (Goldfarb and
/// Idnani 1983; active sets: Nocedal and Wright, Numerical Optimization, 2nd ed., ch. 16) starts
/// from the nearest one without limits; it takes the limit that is passed most into the active set,
/// and lets go those of which the multiplier would change sign: a limit only pushes. Each limit
/// that is taken moves p farther from p*, so that no active set returns.
class LeastMotion {
 public:
  /// The bodies must outlive this; between calls they may be moved.
  explicit LeastMotion(JointedBodies& bodies);

  const std::vector<KeptLimit>& limits() const { return limits_; }
  /// Of the limits, those that push in the last motion.
  const std::vector<uint32_t>& active() const { return active_; }
  const Articulation& equations() const { return equations_; }

  /// Computes errors and limits at the present poses.
  void look();
  /// By how much a limit is passed at the last look() [m, rad]; 0 if it is not.
  double passed(const KeptLimit& limit) const;
  /// Sum of the squares of errors and of what limits are passed by, at the last look().
  double square_misfit() const;
  /// The greatest error, or what a limit is passed by.
  double misfit() const;

  /// The displacement that is nearest to the wanted one. What differs from p* by `rounding` counts
  /// as equal [m, rad]. A limit that nothing that the joints allow keeps is left out.
  std::vector<DofBlock> displacement(std::span<const DofBlock> wanted, double rounding);
  /// The same for velocities; of the limits only those that push in the last displacement count.
  std::vector<DofBlock> velocity(std::span<const DofBlock> wanted, double rounding);
  /// m v^2 + omega I omega over all bodies.
  double square(std::span<const DofBlock> motion) const;

 private:
  enum class Sort : uint8_t { displacement, velocity };

  std::vector<DofBlock> nearest(std::span<const DofBlock> wanted, double rounding);
  void look_at(size_t limit);
  /// s (x + g.p - bound), or s g.p for velocities.
  double slack(size_t limit, std::span<const DofBlock> motion) const;
  void renew();
  void hold_active(std::span<DofBlock> motion);
  bool take(uint32_t limit, std::vector<DofBlock>& motion);
  size_t first_active_row() const { return held_.size() - active_.size(); }

  JointedBodies& bodies_;
  std::vector<uint32_t> slots_, joints_;
  std::vector<KeptLimit> limits_;
  std::vector<JointRow> rows_;  ///< by limit
  Articulation equations_;      ///< joints and couplings
  Articulation held_;           ///< these and the active limits
  Sort sort_ = Sort::displacement;
  std::vector<uint32_t> counted_;    ///< limits that count
  std::vector<uint32_t> active_;     ///< limits, in the order in which they were taken
  std::vector<double> multipliers_;  ///< of these, none of them negative
};

}  // namespace tumble
