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

/// What a tick of the grains is made of. The bodies have had theirs: they go from `start_poses` to
/// their poses while the grains move, and only their velocities change.
struct GrainTick {
  std::span<ParticleSystem> systems;  ///< by slot
  const HandlePool<ParticleSystemTag>& ids;
  BodySet& bodies;
  std::span<const Pose> start_poses;  ///< by body slot
  Vec3 gravity;                       ///< [m/s2]
  double h = 0;                       ///< [s]
  const RealtimeSettings& settings;
  Crew* crew = nullptr;
};

/// The grains of all systems in one list; index i of each array is the same grain, its *place*.
/// They stand along a space-filling curve through where the tick found them, so that what is near
/// in space is near in memory; their order by ascending keys gives each an *ordinal* besides.
struct GrainField {
  struct Owner {
    uint32_t system, index;
  };
  std::vector<Owner> owner;
  std::vector<uint64_t> key;
  std::vector<GrainPoint> points;
  std::vector<GrainMover> movers;
  std::vector<Vec3> acceleration;  ///< 0 while they sleep [m/s2]
  std::vector<uint8_t> asleep;
  std::vector<uint32_t> ordinal;   ///< by place
  std::vector<uint32_t> place_of;  ///< by ordinal
  std::vector<uint32_t> first;     ///< by system slot: ordinal of its first grain; then the end
  size_t sleepers = 0;
  double least_radius = 0, largest_radius = 0;  ///< [m]

  size_t size() const { return points.size(); }
  /// Refuses places that are not finite.
  Status gather(const GrainTick& tick);
  void wake(const GrainTick& tick, size_t i);
  /// Places and velocities back to the systems.
  void give_back(const GrainTick& tick) const;
  /// Place of the grain with this key, or size().
  size_t find(std::span<const ParticleSystem> systems, uint64_t grain) const;
  /// Speed below which a grain of this radius rests in the mean [m/s].
  static double rest_speed(const GrainTick& tick, double radius);

 private:
  Status line_up(const GrainTick& tick);

  CellOrder curve_;
  std::vector<Vec3> by_ordinal_;
};

}  // namespace tumble
