#pragma once
#include "engine/scene/workloads/workload.hpp"

#include <span>

namespace tumble {

/// Penetration depths of all pairs of bodies that overlap by more than a micrometre.
struct OverlapDepths {
  double deepest = 0, sum = 0;  ///< [m]
  size_t pairs = 0;
  double mean() const { return pairs > 0 ? sum / double(pairs) : 0; }
  void add(double depth);
};

/// The final state of a run, measured from poses and velocities only, independently of the code
/// that found or solved the contacts.
struct EndState {
  OverlapDepths overlap;
  double joint_gap = 0;       ///< greatest distance of two anchors of a joint [m]
  double kinetic_energy = 0;  ///< [J]
  double fastest = 0;         ///< speed of a centre of mass [m/s]
  size_t escaped = 0;         ///< bodies below y = -20 m, farther than 10 km away, or not finite
};

bool has_escaped(const RigidBody& body);

/// `bodies` are those of the workload, in its order, in their final state. Escaped bodies are only
/// counted as escaped.
EndState measure_end_state(const Workload& w, std::span<const RigidBody> bodies);

/// Depths of overlapping pairs of shapes that may collide: by separating axes, by distances of
/// segments, or, if the workload has tori, by their formula (tori_overlaps).
OverlapDepths measure_overlaps(const Workload& w, std::span<const RigidBody> bodies);

/// Bodies of the workload as they start, made without a world.
std::vector<RigidBody> bodies_at_start(const Workload& w);

}  // namespace tumble
