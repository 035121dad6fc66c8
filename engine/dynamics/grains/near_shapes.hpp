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
    uint32_t body, shape;  ///< slot of the body, index of the shape in it
    double way;            ///< bound on the displacement of its points in the tick [m]
  };
  struct Touch {
    uint32_t grain, part;
    double gap;   ///< [m]
    Vec3 n;       ///< unit, from the grain to the shape
    Vec3 x;       ///< contact point on the surface [m]
    Vec3 drift;   ///< velocity of the surface there over the part of the tick [m/s]
    Vec3 centre;  ///< centre of mass of the body [m]
  };

  /// Lists the shapes near awake grains, and moving shapes near any grains.
  void collect(const GrainTick& tick, const GrainField& grains);
  bool any_moving() const { return moving_count_ > 0; }
  const std::vector<Part>& parts() const { return parts_; }
  /// Wakes sleeping grains that a moving shape comes near.
  void rouse(const GrainTick& tick, GrainField& grains);
  /// Contacts of awake grains with the listed shapes in the part of the tick from t0 to t1, sorted
  /// by grain and shape.
  void touch(const GrainTick& tick, const GrainField& grains, double t0, double t1,
             std::vector<Touch>& out);
  /// Grains that moved far from `from` are moved back to where they first met a shape, and along
  /// with it from then on; they keep their velocities. Returns their number.
  Result<size_t> hold_back(const GrainTick& tick, GrainField& grains, std::span<const Vec3> from,
                           double t0, double t1);

 private:
  struct Placed {
    Pose pose, start;
    Pose carried;  ///< motion from the beginning of a part of a tick to its end
  };
  /// A lower bound on the distance of a grain from all shapes, which need not be computed again
  /// while grain and shapes have moved by less. Only saves time: results do not depend on it.
  struct Clearance {
    uint64_t key = 0;  ///< grain_key()
    Vec3 x = Vec3::Zero();
    double moved = 0,
           /// `moved`: NearShapes::moved_ when it was computed; `distance`: of the grain's centre
           /// then [m]
        distance = 0;
  };
  /// The shape of a Part, and its pose at the end of the tick.
  struct Known {
    uint32_t body, shape;
    std::shared_ptr<const Shape> of;  ///< kept alive, so that no other shape can get its address
    Pose pose;
    bool operator==(const Known& other) const;
  };
  struct Memory {
    std::vector<uint32_t> near;
  };

  /// Grains that moved far in a part of a tick, and what they met. Scratch memory.
  struct Far {
    std::vector<uint32_t> who;   ///< their places
    std::vector<Vec3> start, v;  ///< [m], [m/s]
    std::vector<double> core;    ///< radius of the ball that is swept [m]
    std::vector<ParticleShapeMeeting> met;
  };

  Motion motion(const GrainTick& tick, uint32_t body) const;
  void forget_what_changed(const GrainTick& tick);
  std::vector<Placed> place(const GrainTick& tick, double t0, double t1) const;
  template <class Margin>
  void find(const GrainTick& tick, std::span<const Placed> placed, const GrainField& grains,
            size_t i, double h, const Margin& margin, Memory& memory,
            std::vector<Touch>& found) const;
  /// Distance of a point from all shapes, at most `most` [m].
  double clearance(const GrainTick& tick, std::span<const Placed> placed, const Vec3& x,
                   double most) const;

  std::vector<Part> parts_;
  std::vector<Aabb> bounds_, moving_bounds_;
  std::vector<uint32_t> moving_;  ///< indices of moving parts
  size_t moving_count_ = 0;
  double longest_way_ = 0;  ///< greatest Part::way [m]
  double moved_ = 0;        ///< sum of longest_way_ over all ticks so far [m]
  std::vector<Known> known_, before_;
  std::vector<Clearance> clear_;  ///< by ordinal
  BoundsTree tree_, moving_tree_;
  ParticleContactFinder finder_;
  Far far_;
};

}  // namespace tumble
