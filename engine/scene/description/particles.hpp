#pragma once
#include "engine/scene/description/placement.hpp"
#include "engine/scene/description/repetition.hpp"

#include <variant>

namespace tumble {

constexpr double max_particles = 2e6;  ///< of one system

/// Particles on a lattice inside a box or a ball.
struct LatticeFill {
  static constexpr std::string_view type_name = "lattice";
  ScatterRegion region = ScatterRegion::box;
  Vec3 centre = Vec3::Zero();  ///< [m]
  Vec3 size{1, 1, 1};          ///< [m]
  double spacing = 0.1;        ///< [m]
  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.field(d.region, {.name = "region", .doc = "shape of the region"});
    v.field(
        d.centre,
        {.name = "centre", .unit = "m", .min = -1e7, .max = 1e7, .doc = "middle of the region"});
    v.field(d.size, {.name = "size",
                     .unit = "m",
                     .min = 0,
                     .max = 1e6,
                     .exclusive_min = true,
                     .required = true,
                     .doc = "full extents of the box, or diameters of the ball"});
    v.field(d.spacing, {.name = "spacing",
                        .unit = "m",
                        .min = 0,
                        .max = 1e6,
                        .exclusive_min = true,
                        .required = true,
                        .doc = "between neighbours"});
  }
};

/// Particles at random places inside a box or a ball.
struct RandomFill {
  static constexpr std::string_view type_name = "random";
  ScatterRegion region = ScatterRegion::box;
  Vec3 centre = Vec3::Zero();  ///< [m]
  Vec3 size{1, 1, 1};          ///< [m]
  int count = 1;
  double speed = 0;  ///< [m/s]
  std::optional<uint64_t> seed;
  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.field(d.region, {.name = "region", .doc = "shape of the region"});
    v.field(
        d.centre,
        {.name = "centre", .unit = "m", .min = -1e7, .max = 1e7, .doc = "middle of the region"});
    v.field(d.size, {.name = "size",
                     .unit = "m",
                     .min = 0,
                     .max = 1e6,
                     .required = true,
                     .doc = "full extents of the box, or diameters of the ball"});
    v.field(d.count, {.name = "count",
                      .min = 1,
                      .max = max_particles,
                      .required = true,
                      .doc = "number of particles"});
    v.field(d.speed, {.name = "speed",
                      .unit = "m/s",
                      .min = 0,
                      .max = 1e6,
                      .doc = "random velocities up to this, besides the common one"});
    v.field(d.seed, {.name = "seed", .doc = "instead of one made from the scene's seed"});
  }
};

struct FillDescription {
  std::variant<LatticeFill, RandomFill> kind;
  static constexpr std::string_view schema_name = "fill";
  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.one_of(d.kind, {.name = "type", .required = true, .doc = "kind of fill"});
  }
};

/// One particle; what is not given is the system's.
struct ParticleDescription {
  Vec3 position = Vec3::Zero();  ///< [m]
  std::optional<Vec3> velocity;  ///< [m/s]
  std::optional<double> mass;    ///< [kg]
  std::optional<double> radius;  ///< [m]
  std::optional<Colour> colour;

  static constexpr std::string_view schema_name = "particle";
  static constexpr std::string_view shorthand_key = "position";
  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.field(d.position, {.name = "position",
                         .unit = "m",
                         .min = -1e7,
                         .max = 1e7,
                         .required = true,
                         .doc = "position"});
    v.field(d.velocity,
            {.name = "velocity", .unit = "m/s", .min = -1e6, .max = 1e6, .doc = "velocity"});
    v.field(d.mass, {.name = "mass",
                     .unit = "kg",
                     .min = 0,
                     .max = 1e12,
                     .exclusive_min = true,
                     .doc = "mass"});
    v.field(d.radius, {.name = "radius",
                       .unit = "m",
                       .min = 0,
                       .max = 1e6,
                       .exclusive_min = true,
                       .doc = "radius"});
    v.field(d.colour, {.name = "colour", .doc = "colour"});
  }
};

/// Damped springs between each two particles of a system that are near each other at the start: a
/// net, a cloth, a jelly.
struct NeighbourSpringsDescription {
  double reach = 0.1;                   ///< [m]
  double stiffness = 100, damping = 1;  ///< [N/m], [N s/m]
  double rest = 1;                      ///< of the distance at the start [-]
  double cable_radius = 0;              ///< as of a spring [m]

  static constexpr std::string_view schema_name = "neighbour_springs";
  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.field(d.reach, {.name = "reach",
                      .unit = "m",
                      .min = 0,
                      .max = 1e6,
                      .exclusive_min = true,
                      .required = true,
                      .doc = "particles at most this far apart are joined"});
    v.field(d.stiffness,
            {.name = "stiffness", .unit = "N/m", .min = 0, .max = 1e12, .doc = "of each spring"});
    v.field(d.damping,
            {.name = "damping", .unit = "N s/m", .min = 0, .max = 1e12, .doc = "of each spring"});
    v.field(d.rest, {.name = "rest",
                     .min = 0,
                     .max = 100,
                     .doc = "length at rest, as a fraction of the distance at the start"});
    v.field(d.cable_radius, {.name = "cable_radius",
                             .unit = "m",
                             .min = 0,
                             .max = 1e3,
                             .doc = "drawn as straight cables this thick; 0: as coils"});
  }
};

/// A particle system: those listed, then those of the fills.
struct ParticleSystemDescription {
  double mass = 0.001;           ///< [kg]
  double radius = 0.02;          ///< [m]
  Vec3 velocity = Vec3::Zero();  ///< [m/s]
  Colour colour{0.95, 0.8, 0.5};
  double gravity_scale = 1;
  double friction = 0.5;
  double restitution = 0;
  bool collide = true;
  bool fast = false;
  bool detect = false;
  std::optional<double> life;  ///< [s]
  double glow = 0;
  std::vector<ParticleDescription> list;
  std::vector<FillDescription> fill;
  std::optional<NeighbourSpringsDescription> springs;

  static constexpr std::string_view schema_name = "particle_system";
  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.field(d.mass, {.name = "mass",
                     .unit = "kg",
                     .min = 0,
                     .max = 1e12,
                     .exclusive_min = true,
                     .doc = "of each particle"});
    v.field(d.radius, {.name = "radius",
                       .unit = "m",
                       .min = 0,
                       .max = 1e6,
                       .exclusive_min = true,
                       .doc = "of each particle"});
    v.field(
        d.velocity,
        {.name = "velocity", .unit = "m/s", .min = -1e6, .max = 1e6, .doc = "of each particle"});
    v.field(d.colour, {.name = "colour", .doc = "of each particle"});
    v.field(d.gravity_scale,
            {.name = "gravity_scale", .min = -1e6, .max = 1e6, .doc = "factor of gravity"});
    v.field(d.friction, {.name = "friction",
                         .min = 0,
                         .max = 1e6,
                         .doc = "coefficient, combined with that of what is touched"});
    v.field(d.restitution, {.name = "restitution", .min = 0, .max = 1, .doc = "of collisions"});
    v.field(d.collide, {.name = "collide",
                        .doc = "push, and be pushed by, bodies and particles that collide"});
    v.field(d.fast,
            {.name = "fast",
             .doc = "moved once a tick, and exchanging impulses with bodies then; not with each "
                    "other"});
    v.field(d.detect, {.name = "detect",
                       .doc = "find contacts with bodies and other detecting systems, for the "
                              "overlay of contacts; this alone pushes nothing"});
    v.field(d.life, {.name = "life",
                     .unit = "s",
                     .min = 0,
                     .max = 1e9,
                     .exclusive_min = true,
                     .doc = "how long each lives; for ever unless given"});
    v.field(d.glow, {.name = "glow",
                     .min = 0,
                     .max = 1000,
                     .doc = "light that they give off by themselves, in units of their colour"});
    v.list(d.list, {.name = "list", .doc = "single particles, or just their positions"});
    v.list(d.fill, {.name = "fill", .doc = "regions full of particles"});
    v.object(d.springs, {.name = "springs", .doc = "join neighbours"});
  }
};

}  // namespace tumble
