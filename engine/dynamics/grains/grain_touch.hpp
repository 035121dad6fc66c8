#pragma once
#include "engine/core/bytes.hpp"
#include "engine/dynamics/particles/particle_system.hpp"

#include <array>
#include <span>
#include <vector>

namespace tumble {

/// Forces of a contact. A tick only begins with those of the one before: single precision will do.
struct GrainForces {
  float push = 0;               ///< normal force [N]
  std::array<float, 3> rub{};   ///< friction on b [N]
  std::array<float, 3> turn{};  ///< torque on b against rolling and spinning [N m]
  float spare = 0;
};

/// What a contact of a grain remembers from tick to tick: who, and with which forces. Forces and
/// not impulses, so that the length of a sub-step may change.
struct GrainTouch : GrainForces {
  uint64_t a = 0;  ///< key of a grain
  uint64_t b = 0;  ///< of a later grain, or of a body's shape

  bool on_body() const { return (b >> 63) != 0; }
  uint32_t body() const { return uint32_t(b >> 24 & 0xffffffff); }
};

/// Grains have keys in the order of their systems' slots and their ids; those of shapes come after
/// all of them.
inline uint64_t grain_key(uint32_t system, uint64_t id) {
  return uint64_t{system} << 48 | id;
}
inline uint64_t shape_key(uint32_t body, uint32_t shape) {
  return uint64_t{1} << 63 | uint64_t{body} << 24 | shape;
}

/// What grains gave to a body in a tick.
struct GrainLoad {
  uint64_t slot = 0;
  Vec3 impulse = Vec3::Zero();  ///< [N s]
  Vec3 moment = Vec3::Zero();   ///< about its centre [N m s]
};

/// The contacts of all grains after a tick: those of each `a` together, by ascending keys of `b`,
/// in the order that the tick had the grains in. Part of the state of a world.
class GrainTouches {
 public:
  std::span<const GrainTouch> all() const { return now_; }
  uint64_t grains() const { return grains_; }  ///< how many there were
  /// What a tick found; go_back() puts back what it replaced.
  void replace(std::vector<GrainTouch>& next, uint64_t grains);
  /// Of the tick that found them; bodies in the order of their slots.
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

/// Grains that touch a body wake: before it is removed or moved from outside.
void wake_grains_on(const GrainTouches& touches, uint32_t body, std::span<ParticleSystem> systems);

}  // namespace tumble
