#pragma once
#include "engine/dynamics/particles/particle_look.hpp"
#include "engine/scene/description/fluid.hpp"
#include "engine/scene/description/placement.hpp"
#include "engine/scene/description/repetition.hpp"
#include "engine/scene/description/weave.hpp"

#include <variant>

namespace tumble {

constexpr double max_particles = 2e6;  ///< of one system

/// Lattices, by their conventional cubic cells.
enum class Arrangement : uint8_t { cubic, body_centred, face_centred };
template <>
struct EnumNames<Arrangement> {
  static constexpr std::array<std::pair<std::string_view, Arrangement>, 3> values = {
      {{"cubic", Arrangement::cubic},
       {"body_centred", Arrangement::body_centred},
       {"face_centred", Arrangement::face_centred}}};
};

/// Particles on a lattice inside a box or a ball.
struct LatticeFill {
  static constexpr std::string_view type_name = "lattice";
  ScatterRegion region = ScatterRegion::box;
  Vec3 centre = Vec3::Zero();  ///< [m]
  Vec3 size{1, 1, 1};          ///< [m]
  double spacing = 0.1;        ///< [m]
  Arrangement arrangement = Arrangement::cubic;
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
                     .exclusive_min = true,
                     .required = true,
                     .doc = "full extents of the box, or diameters of the ball"});
    v.field(d.spacing, {.name = "spacing",
                        .unit = "m",
                        .min = 0,
                        .max = 1e6,
                        .exclusive_min = true,
                        .required = true,
                        .doc = "between nearest neighbours"});
    v.field(d.arrangement, {.name = "arrangement", .doc = "of the points in cubic cells"});
    v.field(d.speed, {.name = "speed",
                      .unit = "m/s",
                      .min = 0,
                      .max = 1e6,
                      .doc = "random velocities up to this, besides the common one"});
    v.field(d.seed, {.name = "seed", .doc = "instead of one made from the scene's seed"});
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

/// Particles on circular orbits about a mass, spread evenly over a ring.
struct DiscFill {
  static constexpr std::string_view type_name = "disc";
  Vec3 centre = Vec3::Zero();  ///< [m]
  Vec3 axis = Vec3::UnitY();
  double inner = 0.2, outer = 1;  ///< radii [m]
  double thickness = 0;           ///< [m]
  int count = 1;
  double mu = 0;         ///< [m3/s2]
  double softening = 0;  ///< [m]
  std::optional<uint64_t> seed;
  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.field(d.centre,
            {.name = "centre", .unit = "m", .min = -1e7, .max = 1e7, .doc = "middle of the ring"});
    v.field(d.axis, {.name = "axis", .doc = "about which they turn, by the right-hand rule"});
    v.field(d.inner,
            {.name = "inner", .unit = "m", .min = 0, .max = 1e6, .doc = "radius inside of it"});
    v.field(d.outer, {.name = "outer",
                      .unit = "m",
                      .min = 0,
                      .max = 1e6,
                      .exclusive_min = true,
                      .required = true,
                      .doc = "radius outside"});
    v.field(d.thickness,
            {.name = "thickness", .unit = "m", .min = 0, .max = 1e6, .doc = "along the axis"});
    v.field(d.count, {.name = "count",
                      .min = 1,
                      .max = max_particles,
                      .required = true,
                      .doc = "number of particles"});
    v.field(d.mu,
            {.name = "mu",
             .unit = "m3/s2",
             .min = 0,
             .doc = "gravitational constant times the mass in the centre: at radius r they move "
                    "with r sqrt(mu) / (r^2 + softening^2)^(3/4)"});
    v.field(d.softening, {.name = "softening", .unit = "m", .min = 0, .doc = "of that gravity"});
    v.field(d.seed, {.name = "seed", .doc = "instead of one made from the scene's seed"});
  }
  static void check(const DiscFill& d, Complaints& complaints) {
    if (!(d.inner < d.outer)) complaints.add("inner", "must be less than outer");
    if (!(d.axis.norm() > 0)) complaints.add("axis", "must not be zero");
  }
};

struct FillDescription {
  std::variant<LatticeFill, RandomFill, DiscFill> kind;
  static constexpr std::string_view schema_name = "fill";
  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.one_of(d.kind, {.name = "type", .required = true, .doc = "kind of fill"});
  }
};

/// One particle; values not given are those of the system.
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

/// Damped springs between all pairs of particles of a system that are near each other at the start,
/// which makes a net, a cloth or an elastic solid.
struct NeighbourSpringsDescription {
  double reach = 0.1;                   ///< [m]
  double stiffness = 100, damping = 1;  ///< [N/m], [N s/m]
  double rest = 1;                      ///< over the initial distance [-]
  double cable_radius = 0;              ///< as for a spring [m]

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

/// A periodic box for some particles: opposite faces are identified.
struct PeriodicBoxDescription {
  Vec3 centre = Vec3::Zero();  ///< [m]
  Vec3 size{1, 1, 1};          ///< [m]

  static constexpr std::string_view schema_name = "periodic_box";
  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.field(d.centre,
            {.name = "centre", .unit = "m", .min = -1e7, .max = 1e7, .doc = "its middle"});
    v.field(d.size, {.name = "size",
                     .unit = "m",
                     .min = 0,
                     .max = 1e6,
                     .required = true,
                     .doc = "lengths of its edges; 0 along axes that have no end"});
  }
};

/// Makes the particles rigid balls with rotation.
struct GrainsDescription {
  double rolling_friction = 0.05, torsional_friction = 0.05;
  int substeps = 0;

  static constexpr std::string_view schema_name = "grains";
  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.field(d.rolling_friction, {.name = "rolling_friction",
                                 .min = 0,
                                 .max = 1e6,
                                 .doc = "a contact that presses with N resists rolling by a torque "
                                        "of up to this times the radius times N"});
    v.field(d.torsional_friction, {.name = "torsional_friction",
                                   .min = 0,
                                   .max = 1e6,
                                   .doc = "likewise against turning about its normal"});
    v.field(d.substeps,
            {.name = "substeps",
             .min = 0,
             .max = 1000,
             .doc = "sub-steps of a tick, at least; 0: those of settings.realtime. Deep heaps that "
                    "flow or fall are stiffer with more of them"});
  }
};

template <>
struct EnumNames<ParticleStyle> {
  static constexpr std::array<std::pair<std::string_view, ParticleStyle>, 3> values = {
      {{"spheres", ParticleStyle::spheres},
       {"surface", ParticleStyle::surface},
       {"smoke", ParticleStyle::smoke}}};
};
template <>
struct EnumNames<ParticleQuantity> {
  static constexpr std::array<std::pair<std::string_view, ParticleQuantity>, 5> values = {
      {{"none", ParticleQuantity::none},
       {"speed", ParticleQuantity::speed},
       {"age", ParticleQuantity::age},
       {"density", ParticleQuantity::density},
       {"pressure", ParticleQuantity::pressure}}};
};

/// How particles are drawn. In a file a bare name stands for {"style": name}.
struct ParticleLookDescription {
  ParticleStyle style = ParticleStyle::spheres;
  ParticleQuantity colour_by = ParticleQuantity::none;
  std::vector<double> range;
  double clarity = 0;  ///< [m]
  double foam = 1, opacity = 0.4;
  double trail = 0;  ///< [s]

  static constexpr std::string_view schema_name = "particle_look";
  static constexpr std::string_view shorthand_key = "style";
  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.field(d.style, {.name = "style",
                      .doc = "spheres; surface: the smooth surface of a clear liquid, for systems "
                             "with \"fluid\"; smoke: soft puffs"});
    v.field(
        d.colour_by,
        {.name = "colour_by",
         .doc = "quantity that colours tell, with a legend; density and pressure are of fluids"});
    v.field(d.range, {.name = "range",
                      .doc = "values at the ends of the colour map, in SI units; unless given the "
                             "least and the greatest that there have been since the start"});
    v.field(d.clarity, {.name = "clarity",
                        .unit = "m",
                        .min = 0,
                        .max = 1e6,
                        .doc = "of a surface: the way through the liquid on which light takes on "
                               "its colour; 0: twenty radii of a particle"});
    v.field(
        d.foam,
        {.name = "foam", .min = 0, .max = 1, .doc = "of a surface: how white broken liquid is"});
    v.field(d.opacity,
            {.name = "opacity", .min = 0, .max = 1, .doc = "of smoke, in the middle of a puff"});
    v.field(d.trail, {.name = "trail",
                      .unit = "s",
                      .min = 0,
                      .max = 1e6,
                      .doc = "how far back in time the paths behind them reach; 0: none"});
  }
  static void check(const ParticleLookDescription& d, Complaints& complaints) {
    if (d.colour_by != ParticleQuantity::none && d.style != ParticleStyle::spheres)
      complaints.add("colour_by", "only spheres are coloured by a quantity");
    if (d.range.empty()) return;
    if (d.colour_by == ParticleQuantity::none) complaints.add("range", "goes with colour_by only");
    if (d.range.size() != 2)
      complaints.add("range", "must be two numbers, got " + std::to_string(d.range.size()));
    else if (!(d.range[0] < d.range[1]))
      complaints.add("range", "must rise from the first number to the second");
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
  double charge = 0;  ///< [C]
  std::optional<PeriodicBoxDescription> periodic_box;
  std::optional<FluidDescription> fluid;
  std::optional<double> life;  ///< [s]
  double glow = 0;
  ParticleLookDescription look;
  std::optional<GrainsDescription> grains;
  std::vector<ParticleDescription> list;
  std::vector<FillDescription> fill;
  std::optional<NeighbourSpringsDescription> springs;
  std::vector<ClothDescription> cloth;
  std::vector<NetDescription> net;
  std::vector<RopeDescription> rope;

  static constexpr std::string_view schema_name = "particle_system";
  static void check(const ParticleSystemDescription& d, Complaints& complaints) {
    const bool of_fluids = d.look.colour_by == ParticleQuantity::density ||
                           d.look.colour_by == ParticleQuantity::pressure;
    if (d.look.style == ParticleStyle::surface && !d.fluid)
      complaints.add("look.style", "a surface is of systems with \"fluid\"");
    if (of_fluids && !d.fluid)
      complaints.add("look.colour_by", "density and pressure are of systems with \"fluid\"");
  }
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
    v.field(d.charge,
            {.name = "charge", .unit = "C", .doc = "of each particle, for coulomb potentials"});
    v.object(
        d.periodic_box,
        {.name = "periodic_box",
         .doc = "particles that leave it come in on the other side, and those at one face feel "
                "pair potentials of those at the other"});
    v.object(d.fluid, {.name = "fluid",
                       .doc = "the particles are a fluid, which bodies contain and float on; they "
                              "do not collide as balls, and lattices give their mass and radius"});
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
    v.object(d.look, {.name = "look", .doc = "as what they are drawn"});
    v.object(d.grains, {.name = "grains",
                        .doc = "under realtime they are balls that spin, roll and come to rest in "
                               "heaps, solved all together; under event particles like others"});
    v.list(d.list, {.name = "list", .doc = "single particles, or just their positions"});
    v.list(d.fill, {.name = "fill", .doc = "regions full of particles"});
    v.object(d.springs, {.name = "springs", .doc = "join neighbours"});
    v.list(d.cloth,
           {.name = "cloth", .doc = "sheets of particles that resist stretch, shear and bending"});
    v.list(d.net, {.name = "net", .doc = "sheets of knotted threads"});
    v.list(d.rope, {.name = "rope", .doc = "ropes through places, bodies among them"});
  }
};

}  // namespace tumble
