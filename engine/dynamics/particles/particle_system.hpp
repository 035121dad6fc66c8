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
/// What grains have besides friction and restitution. A contact that presses with N resists turning
/// about axes in its tangent plane by up to rolling_friction r N, and about its normal by up to
/// torsional_friction r N. Against bodies r is the grain's radius; between two grains it is 2 r_a
/// r_b / (r_a + r_b), and the coefficients sqrt(mu_a mu_b).
struct GrainDef {
  double rolling_friction = 0.05;    ///< [-]
  double torsional_friction = 0.05;  ///< [-]
  /// Sub-steps of a tick, at least; 0: those of RealtimeSettings. A load that comes on suddenly
  /// runs through a heap by about a grain in a sub-step, and the heap yields to it until it has: as
  /// if grains were springs along which sound has that speed.
  int substeps = 0;
};
void save(ByteWriter& out, const std::optional<GrainDef>& grains);
std::optional<GrainDef> load_grains(ByteReader& in);

/// How a grain has moved of late: what decides whether it may sleep.
struct GrainRest {
  Vec3 drift = Vec3::Zero();  ///< mean velocity [m/s]
  double time = 0;            ///< how long it has been slow; infinite: it sleeps [s]

  bool asleep() const { return time == std::numeric_limits<double>::infinity(); }
};

struct ParticleSystemDef {
  std::string name;
  std::vector<ParticleDef> particles;
  double gravity_scale = 1;  ///< [-]
  double friction = 0.5;     ///< Coulomb coefficient [-]
  double restitution = 0;    ///< coefficient of restitution, 0..1 [-]
  /// Collide with bodies and with particles of systems that do too.
  bool collide = true;
  /// Not in the equations of motion of bodies: moved once a tick, when bodies have moved.
  bool fast = false;
  /// Look for contacts with bodies and with particles of systems that do too; frames then have
  /// them.
  bool detect = false;
  double charge = 0;  ///< of each particle [C]
  /// Particles that leave it come in on the other side; it has no walls for anything else.
  PeriodicBox box;
  double glow = 0;  ///< light that they give off by themselves, in units of their colour [-]
  ParticleLook look;
  /// They are a fluid, if not null: moved by its solver, which is all that they have to do with
  /// bodies and with each other; `collide` and `fast` must be false. See particles/fluid_def.hpp.
  std::shared_ptr<const FluidDef> fluid;
  /// They are balls that spin, solid and of even density, under the realtime stepper (`../grains`);
  /// under the event stepper particles like others.
  std::optional<GrainDef> grains;
};

/// A particle, wherever it is in its arrays.
struct ParticleName {
  ParticleSystemId system;
  uint64_t particle = 0;  ///< ParticleSystem::id
};

/// Where slots of bodies also stand for particles, this bit says that the rest is a place in a list
/// of their names.
inline constexpr uint32_t particle_bit = 0x80000000;

void save(ByteWriter& out, std::span<const ParticleName> names);
std::vector<ParticleName> load_particle_names(ByteReader& in);
/// Whether a slot is a body's below `body_slots`, or has particle_bit and names one of `names`.
inline bool known_slot(uint32_t slot, uint32_t body_slots, std::span<const ParticleName> names) {
  return (slot & particle_bit) == 0 ? slot < body_slots : (slot & ~particle_bit) < names.size();
}

/// Point masses as a structure of arrays; index i of every array is the same particle. Removal
/// keeps the order of the others, so that sums and hashes do not depend on history. Who gives birth
/// to particles and lets them die is the world's stage of emission (world/emission).
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
  ValueRange seen;  ///< of what the look colours by, since the start, where it gives no range
  uint64_t next_id = 1;
  std::vector<Vec3> x;              ///< [m]
  std::vector<Vec3> v;              ///< [m/s]
  std::vector<Vec3> force;          ///< sum over this tick [N]
  std::vector<double> mass;         ///< [kg]
  std::vector<double> radius;       ///< [m]
  std::vector<Vec3f> colour;        ///< linear RGB
  std::vector<double> age;          ///< [s]
  std::vector<double> life;         ///< the age at which it dies, may be infinite [s]
  std::vector<double> born_radius;  ///< the radius that it had at birth [m]
  std::vector<double> born_mass;    ///< likewise [kg]
  std::vector<EmitterId> emitter;   ///< that it is from, null for none
  std::vector<uint64_t> id;         ///< never reused; ascending
  std::vector<double> pressure;     ///< of fluids, at the end of the last tick [Pa]
  std::vector<double> density;      ///< of fluids, in the last tick, else empty [kg/m3]
  std::vector<Vec3> spin;           ///< of grains, else empty [rad/s]
  std::vector<GrainRest> rest;      ///< of grains, else empty

  size_t size() const { return x.size(); }
  /// One more, at the end of the arrays; `age` [s].
  void add(const ParticleDef& def, EmitterId emitter = {}, double age = 0);
  /// Room for so many: up to there add() takes nothing from the heap.
  void reserve(size_t count);
  /// The same system without its particles.
  void clear();
  /// A copy of particle i of another system, id included.
  void add_copy(const ParticleSystem& from, size_t i);
  /// Removes the particles whose `gone` is not 0; the others keep their order.
  void remove(std::span<const uint8_t> gone);
  /// Whether some may die of age.
  bool mortal() const;
  /// Moment of inertia of grain i, about any axis through its centre [kg m2].
  double moment(size_t i) const { return 0.4 * mass[i] * radius[i] * radius[i]; }
  /// Grains that sleep wake.
  void wake_grains();
  /// Index of the particle with this id, or size() when it is gone.
  size_t find(uint64_t particle_id) const;
  void save(ByteWriter& out) const;
  void load(ByteReader& in);
};

/// Says which value of which particle is wrong.
Status validate(const ParticleSystemDef& def);
ParticleSystem make_particle_system(const ParticleSystemDef& def);
/// Everything of a definition but where its particles are and how they move: those that there are,
/// and that no emitter made, take mass, radius, colour and life of the one of their number.
void take_values(ParticleSystem& system, const ParticleSystemDef& def);

/// Of a fluid, exactly: all numbers as they are, and back; not checked.
void save(ByteWriter& out, const FluidDef& def);
std::shared_ptr<const FluidDef> load_fluid(ByteReader& in);

/// Advances by h seconds under a constant acceleration a = g + force/m: x += h v + h^2 a/2, v += h
/// a; clears the forces.
void integrate(ParticleSystem& particles, const Vec3& gravity, double h);

}  // namespace tumble
