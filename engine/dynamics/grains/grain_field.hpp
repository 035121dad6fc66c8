#pragma once
#include "engine/core/crew.hpp"
#include "engine/dynamics/bodies/body.hpp"
#include "engine/dynamics/grains/grain_rows.hpp"
#include "engine/dynamics/particles/neighbours/cell_order.hpp"
#include "engine/dynamics/particles/particle_system.hpp"
#include "engine/dynamics/realtime/realtime_settings.hpp"

#include <span>
#include <vector>

namespace tumble {

/// Inputs of a tick of the grains. The bodies have been moved already: while the grains move,
/// bodies go from `start_poses` to their present poses, and only their velocities change.
struct GrainTick {
  std::span<ParticleSystem> systems;  ///< by slot
  const HandlePool<ParticleSystemTag>& ids;
  BodySet& bodies;
  std::span<const Pose> start_poses;  ///< by body slot
  Vec3 gravity;                       ///< [m/s2]
  double h = 0;                       ///< length of the tick [s]
  const RealtimeSettings& settings;
  Crew* crew = nullptr;
};

/// The grains of all systems in one list; index i of each array is the same grain, its *place*.
/// Grains are stored along a space-filling curve through their positions at the start of the tick,
/// so that neighbours in space are near in memory. Their rank by ascending keys is their *ordinal*.
struct GrainField {
  struct Owner {
    uint32_t system, index;
  };
  std::vector<Owner> owner;
  std::vector<uint64_t> key;
  std::vector<GrainPoint> points;
  std::vector<GrainMover> movers;
  std::vector<Vec3> acceleration;  ///< 0 while asleep [m/s2]
  std::vector<uint8_t> asleep;
  std::vector<uint32_t> ordinal;   ///< by place
  std::vector<uint32_t> place_of;  ///< by ordinal
  std::vector<uint32_t> first;     ///< by system slot: ordinal of its first grain; then the end
  size_t sleepers = 0;
  double least_radius = 0, largest_radius = 0;  ///< [m]
  double largest_mass = 0;                      ///< [kg]

  size_t size() const { return points.size(); }
  /// Reads the grains from the systems. Error if a position is not finite.
  Status gather(const GrainTick& tick);
  void wake(const GrainTick& tick, size_t i);
  /// Writes positions and velocities back to the systems.
  void give_back(const GrainTick& tick) const;
  /// The place of the grain with this key, or size().
  size_t find(std::span<const ParticleSystem> systems, uint64_t grain) const;
  /// Averaged speed below which a grain of this radius rests [m/s].
  static double rest_speed(const GrainTick& tick, double radius);

 private:
  Status line_up(const GrainTick& tick);
  /// The owner of the grain of this ordinal.
  Owner owner_of(uint32_t n) const;

  CellOrder curve_;
  std::vector<Vec3> by_ordinal_;
};

}  // namespace tumble
