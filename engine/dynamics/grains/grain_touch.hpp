#pragma once
#include "engine/core/bytes.hpp"
#include "engine/dynamics/particles/particle_system.hpp"

#include <array>
#include <span>
#include <vector>

namespace tumble {

/// Forces of a contact, kept as a warm start only: single precision suffices.
struct GrainForces {
  float push = 0;               ///< normal force [N]
  std::array<float, 3> rub{};   ///< friction force on b [N]
  std::array<float, 3> turn{};  ///< torque of rolling and torsional friction on b [N m]
  float spare = 0;
};
static_assert(sizeof(GrainForces) == 8 * sizeof(float));

/// What is remembered of a contact of a grain from tick to tick: its partners and forces. Forces,
/// not impulses, so that the length of a sub-step may change.
struct GrainTouch : GrainForces {
  uint64_t a = 0;  ///< grain_key() of a grain
  uint64_t b = 0;  ///< grain_key() of a later grain, or shape_key() of a body's shape

  bool on_body() const { return (b >> 63) != 0; }
  uint32_t body() const { return uint32_t(b >> 24 & 0xffffffff); }
};

/// Keys order grains by the slot of their system, then by id; keys of shapes are greater than all
/// of these.
inline uint64_t grain_key(uint32_t system, uint64_t id) {
  return uint64_t{system} << 48 | id;
}
inline uint64_t shape_key(uint32_t body, uint32_t shape) {
  return uint64_t{1} << 63 | uint64_t{body} << 24 | shape;
}

/// Impulses of grains on a body in a tick.
struct GrainLoad {
  uint64_t slot = 0;
  Vec3 impulse = Vec3::Zero();  ///< [N s]
  Vec3 moment = Vec3::Zero();   ///< angular impulse about its centre of mass [N m s]
};

/// The contacts of all grains after a tick: grouped by `a`, in the order in which the tick stored
/// the grains, with ascending `b` in each group. Part of the state of a world.
class GrainTouches {
 public:
  std::span<const GrainTouch> all() const { return now_; }
  uint64_t grains() const { return grains_; }  ///< number of grains in the tick that stored them
  /// Stores the contacts of a tick; go_back() restores those that it replaced.
  void replace(std::vector<GrainTouch>& next, uint64_t grains);
  /// Impulses on bodies in the same tick, in the order of their slots.
  std::vector<GrainLoad>& loads() { return loads_; }
  void begin_tick() {
    replaced_ = false;
    loads_before_ = loads_;
  }
  void go_back();
  void clear();
  void save(ByteWriter& out) const;
  void load(ByteReader& in);

 private:
  bool in_order() const;

  std::vector<GrainTouch> now_, before_;
  std::vector<GrainLoad> loads_, loads_before_;
  uint64_t grains_ = 0, grains_before_ = 0;
  bool replaced_ = false;
};

/// Wakes the grains that touch a body; to be called before it is removed or moved from outside.
void wake_grains_on(const GrainTouches& touches, uint32_t body, std::span<ParticleSystem> systems);

}  // namespace tumble
