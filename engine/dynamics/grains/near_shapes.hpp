#pragma once
#include "engine/collision/bounds_tree.hpp"
#include "engine/collision/motion.hpp"
#include "engine/collision/particle_contacts/particle_contacts.hpp"
#include "engine/dynamics/grains/grain_field.hpp"

#include <memory>
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
             std::vector<Touch>& out);
  /// Grains that went far since they were at `from` are put where they first met a shape, and
  /// carried along with it; they keep their velocities. How many.
  Result<size_t> hold_back(const GrainTick& tick, GrainField& grains, std::span<const Vec3> from,
                           double t0, double t1);

 private:
  struct Placed {
    Pose pose, start;
    Pose carried;  ///< from the beginning of a part of a tick to its end
  };
  /// What is known of how far a grain is from all shapes: it need not ask while it and they have
  /// moved by less. Only saves time: what is found does not depend on it.
  struct Clearance {
    uint64_t key = 0;  ///< of the grain
    Vec3 x = Vec3::Zero();
    double moved = 0,
           distance = 0;  ///< NearShapes::moved_ then; of its centre then [m]
  };
  /// What a part is a part of, and where it was at the end of the tick.
  struct Known {
    uint32_t body, shape;
    std::shared_ptr<const Shape> of;  ///< held, so that no other can have its address
    Pose pose;
    bool operator==(const Known& other) const;
  };
  struct Memory {
    std::vector<uint32_t> near;
  };

  Motion motion(const GrainTick& tick, uint32_t body) const;
  void forget_what_changed(const GrainTick& tick);
  std::vector<Placed> place(const GrainTick& tick, double t0, double t1) const;
  template <class Margin>
  void find(const GrainTick& tick, std::span<const Placed> placed, const GrainField& grains,
            size_t i, double h, const Margin& margin, Memory& memory,
            std::vector<Touch>& found) const;
  /// Distance of a point from all shapes, or `most` [m].
  double clearance(const GrainTick& tick, std::span<const Placed> placed, const Vec3& x,
                   double most) const;

  std::vector<Part> parts_;
  std::vector<Aabb> bounds_, moving_bounds_;
  std::vector<uint32_t> moving_;  ///< parts
  size_t moving_count_ = 0;
  double longest_way_ = 0;  ///< [m]
  double moved_ = 0;        ///< sum of the longest ways of all ticks so far [m]
  std::vector<Known> known_, before_;
  std::vector<Clearance> clear_;  ///< by ordinal
  BoundsTree tree_, moving_tree_;
  ParticleContactFinder finder_;
};

}  // namespace tumble
