#pragma once
#include "engine/core/bytes.hpp"
#include "engine/core/handle.hpp"
#include "engine/core/result.hpp"
#include "engine/dynamics/particles/neighbours/periodic_box.hpp"
#include "engine/dynamics/particles/particle_look.hpp"
#include "engine/math/types.hpp"

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace tumble {

struct FluidDef;
struct ParticleSystemTag;
using ParticleSystemId = Handle<ParticleSystemTag>;
struct EmitterTag;
using EmitterId = Handle<EmitterTag>;

/// One particle as given by a caller.
struct ParticleDef {
  Vec3 x = Vec3::Zero();  ///< [m]
  Vec3 v = Vec3::Zero();  ///< [m/s]
  double mass = 0.001;    ///< [kg]
  double radius = 0.02;   ///< [m]
  Vec3f colour{0.9f, 0.6f, 0.2f};
  double life = std::numeric_limits<double>::infinity();  ///< [s]
  Vec3 spin = Vec3::Zero();                               ///< of grains [rad/s]
};

inline constexpr int most_grain_substeps = 1000;
/// What grains have besides friction and restitution. A contact with normal force N resists rolling
/// by a torque of up to rolling_friction r N, and spinning about its normal by up to
/// torsional_friction r N. At a body r is the grain's radius; between two grains r is 2 r_a r_b /
/// (r_a + r_b), and the coefficients are sqrt(mu_a mu_b).
struct GrainDef {
  double rolling_friction = 0.05;    ///< [-]
  double torsional_friction = 0.05;  ///< [-]
  /// Least number of sub-steps in a tick; 0: that of RealtimeSettings. A sudden load travels
  /// through a heap by about one grain per sub-step, and the heap yields until it has passed, as if
  /// grains were springs with that speed of sound.
  int substeps = 0;
};
void save(ByteWriter& out, const std::optional<GrainDef>& grains);
std::optional<GrainDef> load_grains(ByteReader& in);

/// Recent motion of a grain: decides whether it may sleep.
struct GrainRest {
  Vec3 drift = Vec3::Zero();  ///< averaged velocity [m/s]
  double time = 0;            ///< for how long it has been slow; infinite: it sleeps [s]

  bool asleep() const { return time == std::numeric_limits<double>::infinity(); }
};

struct ParticleSystemDef {
  std::string name;
  std::vector<ParticleDef> particles;
  double gravity_scale = 1;  ///< [-]
  double friction = 0.5;     ///< Coulomb coefficient [-]
  double restitution = 0;    ///< coefficient of restitution, 0..1 [-]
  /// Whether they collide with bodies, and with particles of other such systems.
  bool collide = true;
  /// Moved once per tick after the bodies, instead of with their equations of motion.
  bool fast = false;
  /// Whether contacts with bodies, and with particles of other such systems, are found and put into
  /// frames.
  bool detect = false;
  double charge = 0;  ///< of each particle [C]
  /// Particles that leave the box enter it on the other side; nothing else is affected by it.
  PeriodicBox box;
  double glow = 0;  ///< emitted light, in units of their colour [-]
  ParticleLook look;
  /// If not null, the particles are a fluid, moved by its solver, which also treats their
  /// interaction with bodies and each other; `collide` and `fast` must be false. See
  /// particles/fluid_def.hpp.
  std::shared_ptr<const FluidDef> fluid;
  /// If set, they are solid balls that rotate under the realtime stepper (`../grains`); under the
  /// event stepper they are ordinary particles.
  std::optional<GrainDef> grains;
};

/// Identifies a particle independently of its index.
struct ParticleName {
  ParticleSystemId system;
  uint64_t particle = 0;  ///< ParticleSystem::id
};

/// In slots that may also stand for particles: this bit says that the rest is an index in a list of
/// ParticleNames.
inline constexpr uint32_t particle_bit = 0x80000000;

void save(ByteWriter& out, std::span<const ParticleName> names);
std::vector<ParticleName> load_particle_names(ByteReader& in);
/// Whether a slot is a body's below `body_slots`, or has particle_bit and an index in `names`.
inline bool known_slot(uint32_t slot, uint32_t body_slots, std::span<const ParticleName> names) {
  return (slot & particle_bit) == 0 ? slot < body_slots : (slot & ~particle_bit) < names.size();
}

/// Point masses as a structure of arrays; index i of every array is the same particle. Removal
/// keeps the order of the others, so that sums and hashes do not depend on history. Particles are
/// born and die in the world's stage of emission (world/emission).
struct ParticleSystem {
  std::string name;
  double gravity_scale = 1;
  double friction = 0.5, restitution = 0;             ///< see ParticleSystemDef
  bool collide = true, fast = false, detect = false;  ///< see ParticleSystemDef
  double charge = 0;                                  ///< of each [C]
  PeriodicBox box;                                    ///< see ParticleSystemDef
  double glow = 0;                                    ///< see ParticleSystemDef
  std::shared_ptr<const FluidDef> fluid;              ///< see ParticleSystemDef
  std::optional<GrainDef> grains;                     ///< see ParticleSystemDef
  ParticleLook look;
  /// Range since the start of the quantity that the look shows, if it gives no range.
  ValueRange seen;
  uint64_t next_id = 1;
  std::vector<Vec3> x;              ///< [m]
  std::vector<Vec3> v;              ///< [m/s]
  std::vector<Vec3> force;          ///< sum over this tick [N]
  std::vector<double> mass;         ///< [kg]
  std::vector<double> radius;       ///< [m]
  std::vector<Vec3f> colour;        ///< linear RGB
  std::vector<double> age;          ///< [s]
  std::vector<double> life;         ///< age at which it dies; may be infinite [s]
  std::vector<double> born_radius;  ///< radius at birth [m]
  std::vector<double> born_mass;    ///< likewise [kg]
  std::vector<EmitterId> emitter;   ///< that made it; null for none
  std::vector<uint64_t> id;         ///< never reused; ascending
  std::vector<double> pressure;     ///< of fluids, at the end of the last tick [Pa]
  std::vector<double> density;      ///< of fluids, in the last tick, else empty [kg/m3]
  std::vector<Vec3> spin;           ///< of grains, else empty [rad/s]
  std::vector<GrainRest> rest;      ///< of grains, else empty

  size_t size() const { return x.size(); }
  /// Appends a particle with age `age` [s].
  void add(const ParticleDef& def, EmitterId emitter = {}, double age = 0);
  /// Reserves memory, so that add() does not allocate up to this number.
  void reserve(size_t count);
  /// Removes all particles; the properties of the system stay.
  void clear();
  /// Appends a copy of particle i of another system, with its id.
  void add_copy(const ParticleSystem& from, size_t i);
  /// Removes the particles with gone[i] != 0; the others keep their order.
  void remove(std::span<const uint8_t> gone);
  /// Whether any particle may die of age.
  bool mortal() const;
  /// Moment of inertia of grain i, about any axis through its centre [kg m2].
  double moment(size_t i) const { return 0.4 * mass[i] * radius[i] * radius[i]; }
  /// Wakes all grains.
  void wake_grains();
  /// Index of the particle with this id, or size() when it is gone.
  size_t find(uint64_t particle_id) const;
  void save(ByteWriter& out) const;
  void load(ByteReader& in);
};

/// Names the particle and value that are wrong.
Status validate(const ParticleSystemDef& def);
ParticleSystem make_particle_system(const ParticleSystemDef& def);
/// Takes over a definition except for positions and velocities: existing particles that no emitter
/// made take mass, radius, colour and life of the definition's particle of the same number.
void take_values(ParticleSystem& system, const ParticleSystemDef& def);

/// Exact copies of all numbers of a fluid; load does not check them.
void save(ByteWriter& out, const FluidDef& def);
std::shared_ptr<const FluidDef> load_fluid(ByteReader& in);

/// Moves particles over h seconds under the constant acceleration a = g + force/m: x += h v + h^2
/// a/2, v += h a; clears the forces.
void integrate(ParticleSystem& particles, const Vec3& gravity, double h);

}  // namespace tumble
