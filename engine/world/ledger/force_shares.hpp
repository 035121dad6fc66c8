#pragma once
#include "engine/dynamics/forces/force.hpp"

#include <cstdint>
#include <optional>
#include <vector>

namespace tumble {

/// What one force does to each thing that it acts on.
struct ForceShare {
  struct OnBody {
    uint32_t slot;
    Vec3 force, torque;  ///< [N], [N m]
  };
  struct OnParticle {
    uint32_t system;
    size_t index;
    Vec3 force;  ///< [N]
  };
  std::vector<OnBody> bodies;
  std::vector<OnParticle> particles;
  double conserved = 0;  ///< part of the force that comes from its potential, 0..1 for fields [-]

  void clear() {
    bodies.clear();
    particles.clear();
    conserved = 0;
  }
};

/// ForceShare::conserved of a force that did this.
double conserved_part(const ForceDef& def, const ForceContext& context, const ForceShare& share);

/// Force sums before a force acted; memory that is kept.
struct SumsBefore {
  std::vector<Vec3> force, torque;
  std::vector<std::vector<Vec3>> particles;
};

/// Adds all forces to the force sums, which begin at zero, and notes the share of each, by slot.
void sum_force_shares(const std::vector<std::optional<ForceDef>>& forces, ForceContext& context,
                      SumsBefore& scratch, std::vector<ForceShare>& shares);

}  // namespace tumble
