#pragma once
#include "engine/core/parameters.hpp"
#include "engine/dynamics/particles/particle_system.hpp"
#include "engine/dynamics/rigid/body.hpp"

#include <cstdint>
#include <optional>
#include <string_view>
#include <variant>
#include <vector>

namespace tumble {

struct ForceTag;
using ForceId = Handle<ForceTag>;

/// Where a force takes hold: a point of the world, of a body, or a particle.
struct Anchor {
  enum class Kind : uint8_t { world, body, particle };
  Kind kind = Kind::world;
  BodyId body;
  ParticleSystemId particles;
  uint64_t particle = 0;  ///< ParticleSystem::id
  /// World: the point in world axes. Body: the point in the definition's body frame [m].
  Vec3 point = Vec3::Zero();
};

/// What forces see of a world: bodies and particles, not the World. `h` is the tick [s].
struct ForceContext {
  BodySet& bodies;
  HandlePool<ParticleSystemTag>& particle_ids;
  std::vector<ParticleSystem>& particles;
  double h;      ///< tick [s]
  Vec3 gravity;  ///< uniform acceleration, applied by the stepper [m/s2]
  /// Springs see what they hold this far ahead along its velocity [s]: h/2 for steppers that move
  /// by x += h v + h^2 a/2, which then is the leapfrog (drift, kick, drift): second order, no drift
  /// of energy.
  double lead = 0;
};

/// Viscous drag on every dynamic body and particle: F = -c m v, torque -c I omega, with a rate c
/// in 1/s so that it means the same for every mass. Integrated exactly in the limit of no other
/// force: the impulse is that of v exp(-c h), so any rate is stable.
struct LinearDragDef {
  static constexpr std::string_view type_name = "linear_drag";
  double rate = 0.1;          ///< [1/s]
  double angular_rate = 0.1;  ///< [1/s]

  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.field(d.rate, {.name = "rate", .unit = "1/s", .min = 0, .doc = "decay rate of velocity"});
    v.field(
        d.angular_rate,
        {.name = "angular_rate", .unit = "1/s", .min = 0, .doc = "decay rate of angular velocity"});
  }
};

/// Quadratic drag of a fluid at rest, or moving as `wind`: F = -1/2 rho Cd A |u| u with u = v -
/// wind and A the area of the disc of the bounding radius (particles: their radius). The impulse is
/// that of du/dt = -k |u| u, so that it never overshoots. Torque -1/2 rho Cd r^5 |omega| omega.
struct QuadraticDragDef {
  static constexpr std::string_view type_name = "quadratic_drag";
  double fluid_density = 1.2;  ///< [kg/m3]
  double coefficient = 0.47;   ///< Cd [-]
  Vec3 wind = Vec3::Zero();    ///< velocity of the fluid [m/s]

  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.field(d.fluid_density,
            {.name = "fluid_density", .unit = "kg/m3", .min = 0, .doc = "density of the fluid"});
    v.field(d.coefficient, {.name = "coefficient", .min = 0, .doc = "drag coefficient"});
    v.field(d.wind, {.name = "wind", .unit = "m/s", .doc = "velocity of the fluid"});
  }
};

/// Damped spring between two anchors: F = -(k (l - l0) + c dl/dt) along the line. The damping is
/// integrated implicitly; so is the stiffness where the frequency exceeds 0.4/h, which is the bound
/// of explicit integration here: such a spring stays stable, and loses energy to the step.
struct SpringDef {
  static constexpr std::string_view type_name = "spring";
  Anchor a, b;
  double stiffness = 100;   ///< [N/m]
  double damping = 1;       ///< [N s/m]
  double rest_length = 1;   ///< [m]
  double cable_radius = 0;  ///< drawn as a straight cable this thick, 0: as a coil [m]

  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.field(d.stiffness, {.name = "stiffness", .unit = "N/m", .min = 0, .doc = "spring constant"});
    v.field(d.damping, {.name = "damping", .unit = "N s/m", .min = 0, .doc = "damping constant"});
    v.field(d.rest_length, {.name = "rest_length", .unit = "m", .min = 0, .doc = "length at rest"});
    v.field(d.cable_radius, {.name = "cable_radius",
                             .unit = "m",
                             .min = 0,
                             .doc = "drawn as a straight cable this thick; 0: as a coil"});
  }
};

/// Pulls a point of a body (or a particle) to a target in the world: frequency and damping ratio
/// times the effective mass at the point, so that it feels the same on 1 g and on 10 t. The
/// frequency is bounded by 0.4/h, the force by `max_weights` times the weight, and torsional
/// damping of the same ratio keeps the body from spinning up.
struct MouseSpringDef {
  static constexpr std::string_view type_name = "mouse_spring";
  Anchor anchor;
  Vec3 target = Vec3::Zero();  ///< [m]
  double frequency = 4;        ///< [Hz]
  double damping_ratio = 1;    ///< [-]
  double max_weights = 50;     ///< [-]

  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.field(d.target, {.name = "target", .unit = "m", .doc = "point that it pulls to"});
    v.field(d.frequency, {.name = "frequency",
                          .unit = "Hz",
                          .min = 0,
                          .exclusive_min = true,
                          .doc = "undamped frequency"});
    v.field(d.damping_ratio, {.name = "damping_ratio", .min = 0, .doc = "1 is critical"});
    v.field(d.max_weights, {.name = "max_weights",
                            .min = 0,
                            .exclusive_min = true,
                            .doc = "cap of the force in multiples of the weight"});
  }
};

/// The list of force types; adding one is an alternative here, its header, source and test.
using ForceDef = std::variant<LinearDragDef, QuadraticDragDef, SpringDef, MouseSpringDef>;

/// Checks ranges and that the anchors exist and are movable where they must be.
Status validate(const ForceDef& def, const ForceContext& context);

/// Adds the force of this tick to the force and torque sums.
void apply(const ForceDef& def, ForceContext& context);

/// Potential energy stored [J]; 0 for dissipative forces.
double potential_energy(const ForceDef& def, const ForceContext& context);

/// The anchors of a force (two for springs), for drawing and for island links; may be empty.
std::vector<Anchor> anchors(const ForceDef& def);

/// Position and velocity of an anchor now; empty when what it was on is gone.
struct AnchorState {
  Vec3 x_world, v_world;
};
std::optional<AnchorState> locate(const Anchor& anchor, const ForceContext& context);

std::string_view type_name(const ForceDef& def);

}  // namespace tumble
