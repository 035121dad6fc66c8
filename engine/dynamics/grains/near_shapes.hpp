#pragma once
#include "engine/collision/bounds_tree.hpp"
#include "engine/collision/motion.hpp"
#include "engine/collision/particle_contacts/particle_contacts.hpp"
#include "engine/dynamics/grains/grain_field.hpp"

#include <vector>

namespace tumble {

/// The shapes of bodies that grains may meet in a tick.
class NearShapes {
 public:
  struct Part {
    uint32_t body, shape;  ///< slot, and index in the body
    double way;            ///< how far any of its points comes in the tick, at most [m]
  };
  struct Touch {
    uint32_t grain, part;
    double gap;   ///< [m]
    Vec3 n;       ///< unit, from the grain to the shape
    Vec3 x;       ///< on the surface [m]
    Vec3 drift;   ///< of the surface there, over the part of the tick [m/s]
    Vec3 centre;  ///< of the body [m]
  };

  /// Those near grains that are awake, and those that move near others.
  void collect(const GrainTick& tick, const GrainField& grains);
  bool any_moving() const { return moving_count_ > 0; }
  const std::vector<Part>& parts() const { return parts_; }
  /// Grains that sleep and that something comes near; `speed` [m/s] is slow.
  void rouse(const GrainTick& tick, GrainField& grains);
  /// Contacts of awake grains with them in the part of the tick from t0 to t1, by grain and part.
  void touch(const GrainTick& tick, const GrainField& grains, double t0, double t1,
             std::vector<Touch>& out) const;
  /// Grains that went far since they were at `from` are put where they first met a shape, and
  /// carried along with it; they keep their velocities. How many.
  Result<size_t> hold_back(const GrainTick& tick, GrainField& grains, std::span<const Vec3> from,
                           double t0, double t1);

 private:
  Motion motion(const GrainTick& tick, uint32_t body) const;

  std::vector<Part> parts_;
  std::vector<Aabb> bounds_, moving_bounds_;
  std::vector<uint32_t> moving_;  ///< parts
  size_t moving_count_ = 0;
  double longest_way_ = 0;  ///< [m]
  BoundsTree tree_, moving_tree_;
  ParticleContactFinder finder_;
};

}  // namespace tumble
