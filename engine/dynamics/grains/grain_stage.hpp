#pragma once
#include "engine/dynamics/grains/grain_field.hpp"
#include "engine/dynamics/grains/grain_pairs.hpp"
#include "engine/dynamics/grains/grain_touch.hpp"
#include "engine/dynamics/grains/near_shapes.hpp"
#include "engine/dynamics/grains/solve_grains.hpp"

#include <utility>
#include <vector>

namespace tumble {

/// What a cause did to grains and bodies in a tick.
struct GrainEffect {
  double work = 0;  ///< [J]
  Vec3 momentum = Vec3::Zero(), angular_momentum = Vec3::Zero();
};

struct GrainReport {
  bool moved = false;  ///< false: all sleep, and nothing came near
  bool woke_bodies = false;
  size_t awake = 0, contacts = 0;
  size_t held = 0;     ///< grains that would have passed into a shape
  double deepest = 0;  ///< greatest overlap [m]
  GrainEffect restitution, friction, kinematic, sleeping;
  /// A body whose velocities changed, and what they were before.
  struct Pushed {
    uint32_t slot;
    Vec3 v, omega;
  };
  std::vector<Pushed> bodies;  ///< by ascending slot
};

/// Moves grains by one tick of the realtime stepper (README.md). What a tick needs of the one
/// before is in the systems and in the touches; the rest is memory.
class GrainStage {
 public:
  static bool asked_for(const HandlePool<ParticleSystemTag>& ids,
                        std::span<const ParticleSystem> systems);
  /// Before the bodies have their tick: they are carried by what grains gave them in the last one,
  /// up to their weight, as if it went on. step() takes it back and gives what they give now.
  /// Without it a body on grains would fall a little in every tick.
  void carry(GrainTouches& touches, BodySet& bodies, const Vec3& gravity, double h);
  std::span<const GrainLoad> carried() const { return carried_; }
  Status step(const GrainTick& tick, GrainTouches& touches, GrainReport& report);

 private:
  void wake_lost(const GrainTick& tick, const GrainTouches& touches);
  double closing_speed() const;
  void take_back(const GrainTick& tick, GrainReport& report);
  void give_to_bodies(const GrainTick& tick, GrainTouches& touches, GrainReport& report) const;
  Status part(const GrainTick& tick, GrainTouches& touches, double t0, double t1, int substeps,
              GrainReport& report);
  void make_pairs(const GrainTick& tick);
  void make_walls(const GrainTick& tick, GrainReport& report);
  GrainBodyRow wall_row(const GrainTick& tick, const NearShapes::Touch& touch, GrainReport& report);
  uint32_t body_of(const GrainTick& tick, uint32_t slot);
  void remember(const GrainTick& tick, const GrainTouches& touches, double hs);
  void keep_or_wake(const GrainTick& tick, const GrainTouch& touch);
  void paint();
  void store(GrainTouches& touches, double hs);
  void count(GrainReport& report) const;
  void age(const GrainTick& tick) const;
  void watch(const GrainTick& tick);
  void find_held(const GrainTick& tick, const GrainTouches& touches);
  void rest(const GrainTick& tick, const GrainTouches& touches, GrainReport& report);
  GrainRest& rest_of(const GrainTick& tick, size_t i) const {
    return tick.systems[grains_.owner[i].system].rest[grains_.owner[i].index];
  }

  GrainField grains_;
  GrainPairs finder_;
  NearShapes shapes_;
  std::vector<std::pair<uint32_t, uint32_t>> found_;
  std::vector<NearShapes::Touch> touching_;
  std::vector<GrainRow> rows_, pairs_;  ///< by key; by colour
  std::vector<GrainBodyRow> walls_, held_;
  std::vector<GrainBody> bodies_;
  std::vector<GrainLoad> carried_;
  std::vector<uint32_t> body_index_;  ///< by slot
  std::vector<GrainTouch> kept_, next_;
  std::vector<uint32_t> lost_;  ///< grains whose hold has gone
  std::vector<uint32_t> order_, colours_, order_scratch_;
  std::vector<uint64_t> used_;
  std::vector<uint8_t> touched_;
  std::vector<Vec3> from_, start_;
  enum class Hold : uint8_t { none, firm, restless };
  std::vector<Hold> hold_;  ///< what a grain touches
};

}  // namespace tumble
