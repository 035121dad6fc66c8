#pragma once
#include "engine/dynamics/bodies/body.hpp"
#include "engine/dynamics/particles/emission_shape.hpp"
#include "engine/dynamics/particles/particle_system.hpp"
#include "engine/dynamics/particles/random_values.hpp"
#include "engine/dynamics/particles/time_curve.hpp"

#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace tumble {

/// Several particles at once, at one or several times.
struct Burst {
  double time = 0;   ///< of the first burst, since the emitter was made [s]
  int count = 1;     ///< particles in each
  int times = 1;     ///< number of bursts
  double every = 1;  ///< time between bursts [s]
};

/// Emission by particles or bodies of an emitter: at an event, `count` particles or bodies of
/// another emitter are born where it is, and may inherit its velocity.
struct SpawnRule {
  enum class On : uint8_t {
    birth,
    life,       ///< throughout its life, at `rate`
    death,      ///< at the end of its life, or in a collision that ends it; not in a sink
    collision,  ///< of a particle with a body or another particle; of a body with another body
    sink,       ///< a sink takes it
  };
  On on = On::death;
  EmitterId emitter;  ///< null: none
  int count = 1;
  double rate = 0;    ///< [1/s]
  bool dies = false;  ///< whether the particle dies in the collision
};

/// What changes of an emitter with the time since it was made, for those that are born then.
struct EmissionCourse {
  FactorCurve rate, speed, spread, life, mass, radius, spin;
  TimeCurve<Vec3f> colour;  ///< in place of `colours`

  /// Calls f for every curve of factors.
  template <class Self, class F>
  static void for_factors(Self& self, const F& f) {
    for (auto* curve :
         {&self.rate, &self.speed, &self.spread, &self.life, &self.mass, &self.radius, &self.spin})
      f(*curve);
  }
};

/// Emits particles into a system, or copies of a body into the world.
struct EmitterDef {
  static constexpr double for_ever = std::numeric_limits<double>::infinity();

  std::string name;
  ParticleSystemId particles;           ///< null: bodies
  std::shared_ptr<const BodyDef> body;  ///< template of the bodies

  // Where. The y axis of the emitter's frame is the direction of emission.
  BodyId carrier;  ///< the frame moves with its body frame; null: fixed in the world
  Pose pose;       ///< of the frame in the carrier's, or the world's
  EmissionShapeDef shape;

  // When, in seconds since the emitter was made.
  double rate = 0;                   ///< [1/s]
  double start = 0, end = for_ever;  ///< between which the rate applies [s]
  std::vector<Burst> bursts;         ///< at most 1000
  uint64_t count = ~uint64_t{0};     ///< greatest number by rate and bursts in all
  uint64_t at_most = ~uint64_t{0};   ///< greatest number alive at once: further ones are left out

  // Properties of each particle or body.
  /// Directions are about the shape's outward normal instead of the frame's y axis.
  bool outward = false;
  double spread = 0;   ///< half opening angle of the cone of directions [rad]
  RandomNumber speed;  ///< [m/s]
  /// Share of the velocity of the carrier there, or of the parent particle [-]
  double inherit = 1;
  RandomNumber life{for_ever};  ///< [s]
  RandomNumber mass{0.001};     ///< of particles [kg]
  RandomNumber radius{0.02};    ///< of particles [m]
  /// One of these at random, linear RGB; empty: that of the body template, or the default.
  std::vector<Vec3f> colours;
  /// Values at equal intervals over a particle's life: factors of its radius, and colours that
  /// replace the above. Empty: constant.
  std::vector<double> size_over_life;
  /// Factors of the mass; what is lost of it leaves with the particle's velocity.
  std::vector<double> mass_over_life;
  std::vector<Vec3f> colour_over_life;
  std::vector<double> opacity_over_life;  ///< factors of the look's opacity, 0..1; empty: 1
  bool changes() const {
    return !(size_over_life.empty() && mass_over_life.empty() && colour_over_life.empty() &&
             opacity_over_life.empty());
  }
  EmissionCourse over_time;
  double least_life() const { return life.least() * over_time.life.least(); }
  double most_life() const { return life.most() * over_time.life.most(); }
  bool any_orientation = false;  ///< of bodies: uniformly random, instead of the template's
  RandomNumber spin;             ///< of bodies and grains, about a random axis [rad/s]

  std::vector<SpawnRule> events;
  uint64_t seed = 1;
};

/// Names the value that is wrong. The world checks that what it refers to exists.
Status validate(const EmitterDef& def);

/// A live emitter. The properties of its n-th particle depend on the seed and n only.
struct Emitter {
  std::shared_ptr<const EmitterDef> def;       ///< null if the slot is free
  std::shared_ptr<const EmissionShape> shape;  ///< of the definition
  double begun = 0;                            ///< world time at which it was made [s]
  double emitted_to = -1;  ///< everything due until then was emitted [s, since begun]
  uint64_t scheduled = 0;  ///< number emitted by rate and bursts until then
  uint64_t made = 0;       ///< number emitted in all
  uint64_t alive = 0;      ///< number of its particles that are alive

  struct OwnBody {
    BodyId id;
    double dies = EmitterDef::for_ever;  ///< world time of its end [s]
    double born = 0;                     ///< world time of its birth [s]
    std::vector<BodyId> touching{};      ///< what it touched in the last tick, ascending
  };
  std::vector<OwnBody> bodies;  ///< alive, in the order of their birth

  /// Births that an event asked for, and that are still to come.
  struct Asked {
    Vec3 x = Vec3::Zero(), v = Vec3::Zero();  ///< of the one that asks, then [m], [m/s]
    double time = 0;                          ///< [s], of the world's time
    int count = 1;
  };
  std::vector<Asked> asked;
};

/// Number emitted by the rate until a time since the beginning [s]: floor of rate times time, where
/// values within rounding error of a whole number are rounded to it.
uint64_t count_by_rate(const EmitterDef& def, double time);
/// How many times a burst has happened until a time since the beginning [s].
uint64_t bursts_by(const Burst& burst, double time);
/// Appends the times of birth after `emitted_to` and up to `time`, both since the beginning, in
/// order of time; and adds them to `scheduled`.
void take_due(Emitter& emitter, double time, std::vector<double>& births);
/// Whether rate and bursts are exhausted.
bool spent(const Emitter& emitter);

/// Pose and motion of the emitter's frame at a birth.
struct EmissionPlace {
  Pose frame;
  Vec3 centre = Vec3::Zero();                   ///< centre of mass of the carrier [m]
  Vec3 v = Vec3::Zero(), omega = Vec3::Zero();  ///< velocities of the carrier [m/s], [rad/s]

  Vec3 velocity_at(const Vec3& x) const { return v + omega.cross(x - centre); }
};

/// The next particle, with its state at birth, `time` [s] after the emitter was made.
ParticleDef next_particle(Emitter& emitter, const EmissionPlace& place, double time = 0);
/// The next body, and its life [s].
struct EmittedBody {
  BodyDef def;
  double life = EmitterDef::for_ever;
};
EmittedBody next_body(Emitter& emitter, const EmissionPlace& place, double time = 0);

/// Value at the share u (0..1) of a life: linear interpolation between values at equal intervals.
double over_life(std::span<const double> values, double u);
Vec3f over_life(std::span<const Vec3f> values, double u);

}  // namespace tumble
