#pragma once
#include "engine/dynamics/particles/emitter.hpp"
#include "engine/dynamics/particles/sink.hpp"
#include "engine/scene/description/placement.hpp"

#include <optional>
#include <string>
#include <type_traits>
#include <variant>
#include <vector>

namespace tumble {

template <>
struct EnumNames<RandomNumber::Kind> {
  static constexpr std::array<std::pair<std::string_view, RandomNumber::Kind>, 2> values = {
      {{"uniform", RandomNumber::Kind::uniform}, {"normal", RandomNumber::Kind::normal}}};
};
template <>
struct EnumNames<SpawnRule::On> {
  static constexpr std::array<std::pair<std::string_view, SpawnRule::On>, 5> values = {
      {{"birth", SpawnRule::On::birth},
       {"life", SpawnRule::On::life},
       {"death", SpawnRule::On::death},
       {"collision", SpawnRule::On::collision},
       {"sink", SpawnRule::On::sink}}};
};
/// Direction in which particles are emitted.
enum class EmissionDirection : uint8_t {
  axis,     ///< y of the emitter's frame
  outward,  ///< the normal of the shape where they leave
};
template <>
struct EnumNames<EmissionDirection> {
  static constexpr std::array<std::pair<std::string_view, EmissionDirection>, 2> values = {
      {{"axis", EmissionDirection::axis}, {"outward", EmissionDirection::outward}}};
};

/// A random number, drawn for each particle. In a file a bare number stands for {"mean": number}.
struct RandomNumberDescription {
  RandomNumber number;

  static constexpr std::string_view schema_name = "random_number";
  static constexpr std::string_view shorthand_key = "mean";
  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.field(d.number.mean,
            {.name = "mean", .min = -1e12, .max = 1e12, .required = true, .doc = "mean value"});
    v.field(d.number.spread, {.name = "spread",
                              .min = 0,
                              .max = 1e12,
                              .doc = "uniform: as far above and below the mean; normal: standard "
                                     "deviation, of which four are the most"});
    v.field(d.number.kind, {.name = "distribution", .doc = "how values are distributed"});
  }
};

/// An emission shape that is a mesh of the scene.
template <class Emission>
struct MeshEmissionDescription {
  static constexpr std::string_view type_name = Emission::type_name;
  std::string mesh;
  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.field(d.mesh, {.name = "mesh", .required = true, .doc = "name of a mesh"});
  }
};

/// The description of an emission shape: its definition, with a name instead if it has a mesh.
template <class Def>
using DescribedEmission = std::conditional_t<std::is_same_v<Def, MeshSurfaceEmission> ||
                                                 std::is_same_v<Def, MeshVolumeEmission>,
                                             MeshEmissionDescription<Def>, Def>;
template <class Defs>
struct DescribedEmissions;
template <class... Defs>
struct DescribedEmissions<std::variant<Defs...>> {
  using type = std::variant<DescribedEmission<Defs>...>;
};

struct EmissionShapeDescription {
  DescribedEmissions<EmissionShapeDef>::type kind;

  static constexpr std::string_view schema_name = "emission_shape";
  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.one_of(d.kind, {.name = "type", .required = true, .doc = "kind of shape to emit from"});
  }
  static void check(const EmissionShapeDescription& d, Complaints& complaints) {
    const auto* disc = std::get_if<DiscEmission>(&d.kind);
    if (disc && disc->inner_radius >= disc->radius)
      complaints.add("inner_radius", "must be less than the radius");
  }
};

struct BurstDescription {
  Burst burst;

  static constexpr std::string_view schema_name = "burst";
  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.field(d.burst.time,
            {.name = "time", .unit = "s", .min = 0, .max = 1e9, .doc = "of the first"});
    v.field(d.burst.count,
            {.name = "count", .min = 1, .max = 2e6, .required = true, .doc = "of each"});
    v.field(d.burst.times, {.name = "times", .min = 1, .max = 1e9, .doc = "how often"});
    v.field(d.burst.every, {.name = "every",
                            .unit = "s",
                            .min = 0,
                            .max = 1e9,
                            .exclusive_min = true,
                            .doc = "between one and the next"});
  }
};

/// Properties of what is emitted at a time; between keys they are interpolated linearly.
struct EmissionKeyDescription {
  double time = 0;  ///< [s]
  std::optional<double> rate, speed, spread, life, mass, radius, spin;
  std::optional<Colour> colour;

  static constexpr std::string_view schema_name = "emission_key";
  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.field(d.time, {.name = "time",
                     .unit = "s",
                     .min = 0,
                     .max = 1e9,
                     .required = true,
                     .doc = "after the emitter was made"});
    v.field(d.rate, {.name = "rate", .min = 0, .max = 1e6, .doc = "factor of it"});
    v.field(d.speed, {.name = "speed", .min = -1e6, .max = 1e6, .doc = "factor of it"});
    v.field(d.spread, {.name = "spread", .min = 0, .max = 1e6, .doc = "factor of spread_deg"});
    for_positive(d, [&v](auto& factor, std::string_view name) {
      v.field(factor,
              {.name = name, .min = 0, .max = 1e6, .exclusive_min = true, .doc = "factor of it"});
    });
    v.field(d.spin, {.name = "spin", .min = -1e6, .max = 1e6, .doc = "factor of it"});
    v.field(d.colour, {.name = "colour", .doc = "in place of colours"});
  }

 private:
  template <class Self, class F>
  static void for_positive(Self& d, const F& f) {
    f(d.life, "life");
    f(d.mass, "mass");
    f(d.radius, "radius");
  }
};

/// What the particles or bodies of an emitter emit when an event occurs.
struct EmitterEventDescription {
  SpawnRule::On event = SpawnRule::On::death;
  std::string emitter;
  int count = 1;
  double rate = 0;
  bool dies = false;

  static constexpr std::string_view schema_name = "emitter_event";
  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.field(d.event, {.name = "event", .required = true, .doc = "what happens to one of them"});
    v.field(d.emitter, {.name = "emitter",
                        .doc = "name of the emitter by which others are born, where the one is "
                               "then"});
    v.field(d.count, {.name = "count", .min = 1, .max = 1e6, .doc = "how many at once"});
    v.field(d.rate, {.name = "rate",
                     .unit = "1/s",
                     .min = 0,
                     .max = 1e6,
                     .doc = "how often, of the event 'life': all the time that it lives"});
    v.field(d.dies, {.name = "dies", .doc = "it dies of the event 'collision'"});
  }
  static void check(const EmitterEventDescription& d, Complaints& complaints) {
    const bool collision = d.event == SpawnRule::On::collision;
    if (d.dies && !collision) complaints.add("dies", "goes with the event 'collision' only");
    if (d.emitter.empty() && !(collision && d.dies))
      complaints.add("", "an event needs the name of an emitter");
    if ((d.event == SpawnRule::On::life) != (d.rate > 0))
      complaints.add("rate", "the event 'life' has a rate > 0, others have none");
  }
};

/// A source of particles, or of bodies.
struct EmitterDescription {
  std::string particles, body, carrier;
  Placement placement;
  std::optional<EmissionShapeDescription> shape;
  double rate = 0;            ///< [1/s]
  double start = 0;           ///< [s]
  std::optional<double> end;  ///< [s]
  std::vector<BurstDescription> bursts;
  std::optional<int> count, at_most;
  EmissionDirection direction = EmissionDirection::axis;
  double spread_deg = 0;  ///< [deg]
  RandomNumberDescription speed;
  double inherit = 1;
  std::optional<RandomNumberDescription> life, mass, radius;  ///< [s], [kg], [m]
  std::vector<Colour> colours;
  std::vector<double> size_over_life, mass_over_life;
  std::vector<Colour> colour_over_life;
  std::vector<double> opacity_over_life;
  std::vector<EmissionKeyDescription> over_time;
  bool random_orientation = false;
  RandomNumberDescription spin;  ///< [rad/s]
  std::vector<EmitterEventDescription> events;
  std::optional<uint64_t> seed;

  static constexpr std::string_view schema_name = "emitter";
  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.field(d.particles, {.name = "particles", .doc = "name of the particle system to fill"});
    v.field(d.body, {.name = "body", .doc = "instead: name of the body to make copies of"});
    v.field(d.carrier, {.name = "carrier", .doc = "name of a body that it moves along with"});
    v.part(d.placement);
    v.object(d.shape, {.name = "shape", .doc = "where they leave; a point unless given"});
    v.field(d.rate, {.name = "rate", .unit = "1/s", .min = 0, .max = 1e9, .doc = "how many"});
    v.field(d.start,
            {.name = "start", .unit = "s", .min = 0, .max = 1e9, .doc = "when the rate begins"});
    v.field(d.end, {.name = "end", .unit = "s", .min = 0, .max = 1e9, .doc = "when it ends"});
    v.list(d.bursts, {.name = "bursts", .doc = "many at once"});
    v.field(d.count,
            {.name = "count", .min = 1, .max = 2e9, .doc = "so many in all by rate and bursts"});
    v.field(d.at_most, {.name = "at_most",
                        .min = 1,
                        .max = 2e6,
                        .doc = "of its own at once: what would be more is left out"});
    v.field(d.direction, {.name = "direction", .doc = "about which way they leave"});
    v.field(d.spread_deg, {.name = "spread_deg",
                           .unit = "deg",
                           .min = 0,
                           .max = 180,
                           .doc = "half the opening of the cone of directions; 180: all"});
    v.object(d.speed, {.name = "speed", .doc = "along the direction [m/s]"});
    v.field(d.inherit, {.name = "inherit",
                        .min = -1000,
                        .max = 1000,
                        .doc = "how much of the velocity of the carrier there, or of the particle "
                               "whose event it is"});
    v.object(d.life, {.name = "life", .doc = "how long each lives [s]; for ever unless given"});
    v.object(d.mass, {.name = "mass", .doc = "of a particle instead of its system's [kg]"});
    v.object(d.radius, {.name = "radius", .doc = "of a particle instead of its system's [m]"});
    v.field(d.colours, {.name = "colours", .doc = "one of these for each"});
    v.field(d.size_over_life, {.name = "size_over_life",
                               .min = 0,
                               .max = 1000,
                               .exclusive_min = true,
                               .doc = "factors of the radius from birth to death, evenly spaced"});
    v.field(d.mass_over_life,
            {.name = "mass_over_life",
             .min = 0,
             .max = 1000,
             .exclusive_min = true,
             .doc = "factors of the mass from birth to death, evenly spaced; what "
                    "it loses leaves with its velocity"});
    v.field(d.colour_over_life,
            {.name = "colour_over_life", .doc = "colours from birth to death, evenly spaced"});
    v.field(d.opacity_over_life, {.name = "opacity_over_life",
                                  .min = 0,
                                  .max = 1,
                                  .doc = "of smoke: factors of its opacity from birth to death, "
                                         "evenly spaced"});
    v.list(d.over_time, {.name = "over_time",
                         .doc = "how rate, speed and the rest change with the emitter's time"});
    v.field(d.random_orientation,
            {.name = "random_orientation", .doc = "bodies: all orientations are as likely"});
    v.object(d.spin, {.name = "spin", .doc = "bodies and grains: about any axis [rad/s]"});
    v.list(d.events, {.name = "events", .doc = "what particles or bodies give birth to"});
    v.field(d.seed, {.name = "seed", .doc = "instead of one made from the scene's seed"});
  }
  static void check(const EmitterDescription& d, Complaints& complaints);
};

enum class SinkTakes : uint8_t { particles, bodies, both };
template <>
struct EnumNames<SinkTakes> {
  static constexpr std::array<std::pair<std::string_view, SinkTakes>, 3> values = {
      {{"particles", SinkTakes::particles},
       {"bodies", SinkTakes::bodies},
       {"both", SinkTakes::both}}};
};

/// A sink, which removes particles or bodies.
struct SinkDescription {
  SinkRegion region;
  Placement placement;
  bool outside = false;
  SinkTakes takes = SinkTakes::particles;
  std::vector<std::string> particles;

  static constexpr std::string_view schema_name = "sink";
  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.one_of(d.region, {.name = "type", .required = true, .doc = "kind of region"});
    v.part(d.placement);
    v.field(d.outside, {.name = "outside", .doc = "take what is not in the region"});
    v.field(d.takes, {.name = "takes", .doc = "what is removed; of bodies the dynamic ones"});
    v.field(d.particles,
            {.name = "particles", .doc = "only those of these systems; of all unless given"});
  }
};

}  // namespace tumble
