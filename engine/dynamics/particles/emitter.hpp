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

/// Many at once, at one moment or several.
struct Burst {
  double time = 0;   ///< of the first, after the emitter began [s]
  int count = 1;     ///< of each
  int times = 1;     ///< how often
  double every = 1;  ///< between one and the next [s]
};

/// What the particles or bodies of an emitter give birth to: at an event `count` of another emitter
/// come from where it is, and may inherit its velocity.
struct SpawnRule {
  enum class On : uint8_t {
    birth,
    life,       ///< all the time that it lives, `rate` a second
    death,      ///< at the end of its life, or in a collision that it dies of; not in a sink
    collision,  ///< of a particle with a body or another particle; of a body with another body
    sink,       ///< a sink takes it
  };
  On on = On::death;
  EmitterId emitter;  ///< null: none
  int count = 1;
  double rate = 0;    ///< [1/s]
  bool dies = false;  ///< of the collision
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
  std::shared_ptr<const BodyDef> body;  ///< what the bodies are copies of

  // Where. The y axis of the frame is the direction of emission.
  BodyId carrier;  ///< the frame moves along with its body frame; null: it stands in the world
  Pose pose;       ///< of the frame in the carrier's, or the world's
  EmissionShapeDef shape;

  // When, in seconds after the emitter was made.
  double rate = 0;                   ///< [1/s]
  double start = 0, end = for_ever;  ///< of the rate [s]
  std::vector<Burst> bursts;         ///< at most 1000
  uint64_t count = ~uint64_t{0};     ///< so many in all by rate and bursts
  uint64_t at_most = ~uint64_t{0};   ///< of its own at once: what would be more is left out

  // How each one is.
  bool outward = false;  ///< directions are about the shape's outward normal, not the frame's y
  double spread = 0;     ///< half the opening of the cone of directions [rad]
  RandomNumber speed;    ///< [m/s]
  double inherit = 1;    ///< of the carrier's velocity there, or the parent particle's [-]
  RandomNumber life{for_ever};  ///< [s]
  RandomNumber mass{0.001};     ///< of particles [kg]
  RandomNumber radius{0.02};    ///< of particles [m]
  std::vector<Vec3f> colours;   ///< one of these, linear RGB; empty: of bodies their own
  /// Over the life of a particle, evenly spaced from its birth to its death: factors of the radius,
  /// and colours in place of those above. Empty: as at birth.
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
  bool any_orientation = false;  ///< of bodies: all as likely, not the template's in the frame
  RandomNumber spin;             ///< of bodies and grains, about any axis [rad/s]

  std::vector<SpawnRule> events;
  uint64_t seed = 1;
};

/// Says which value is wrong. That what it names exists is the world's to check.
Status validate(const EmitterDef& def);

/// A live emitter. What number n is like depends on the seed and n alone.
struct Emitter {
  std::shared_ptr<const EmitterDef> def;       ///< null: none in this slot
  std::shared_ptr<const EmissionShape> shape;  ///< of the definition
  double begun = 0;                            ///< when it was made [s]
  double emitted_to = -1;  ///< what was due by then was emitted [s, since begun]
  uint64_t scheduled = 0;  ///< by rate and bursts up to then
  uint64_t made = 0;       ///< in all: the number of the next
  uint64_t alive = 0;      ///< of its particles

  struct OwnBody {
    BodyId id;
    double dies = EmitterDef::for_ever;  ///< [s], of the world's time
    double born = 0;                     ///< likewise
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

/// How many the rate has made by a time since the beginning [s]: the whole part of its integral.
/// Within rounding of a whole number it is that.
uint64_t count_by_rate(const EmitterDef& def, double time);
/// How often a burst has been by a time since the beginning [s].
uint64_t bursts_by(const Burst& burst, double time);
/// Appends when those are born that are due after `emitted_to` and by `time`, both since the
/// beginning, in the order of time; and counts them as scheduled.
void take_due(Emitter& emitter, double time, std::vector<double>& births);
/// Whether rate and bursts have nothing more to make.
bool spent(const Emitter& emitter);

/// Where and how the frame of an emitter moves at a birth.
struct EmissionPlace {
  Pose frame;
  Vec3 centre = Vec3::Zero();                   ///< of the carrier [m]
  Vec3 v = Vec3::Zero(), omega = Vec3::Zero();  ///< of the carrier [m/s], [rad/s]

  Vec3 velocity_at(const Vec3& x) const { return v + omega.cross(x - centre); }
};

/// The next particle, as it is at its birth, so long after the emitter was made [s].
ParticleDef next_particle(Emitter& emitter, const EmissionPlace& place, double time = 0);
/// The next body, and how long it lives [s].
struct EmittedBody {
  BodyDef def;
  double life = EmitterDef::for_ever;
};
EmittedBody next_body(Emitter& emitter, const EmissionPlace& place, double time = 0);

/// Value at a share u in 0..1 of a life, of values evenly spaced over it; linear in between.
double over_life(std::span<const double> values, double u);
Vec3f over_life(std::span<const Vec3f> values, double u);

}  // namespace tumble
