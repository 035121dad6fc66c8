#pragma once
#include "engine/dynamics/forces/force.hpp"
#include "engine/scene/description/values.hpp"

#include <variant>

namespace tumble {

/// Where a force takes hold: a point of a body (in its own frame), a particle, or of the world.
struct AnchorDescription {
  std::string body;
  std::string particles;
  int index = 0;
  Vec3 point = Vec3::Zero();  ///< [m]

  static constexpr std::string_view schema_name = "anchor";
  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.field(d.body, {.name = "body", .doc = "name of a body, or of a copy: \"brick[3]\""});
    v.field(d.particles, {.name = "particles", .doc = "instead: name of a particle system"});
    v.field(d.index, {.name = "index", .min = 0, .max = 1e7, .doc = "number of the particle"});
    v.field(d.point, {.name = "point",
                      .unit = "m",
                      .min = -1e7,
                      .max = 1e7,
                      .doc = "in the body's frame; without body or particles in the world"});
  }
  static void check(const AnchorDescription& d, Complaints& complaints) {
    if (!d.body.empty() && !d.particles.empty())
      complaints.add("", "give body or particles, not both");
  }
};

template <>
struct EnumNames<Truncation> {
  static constexpr std::array<std::pair<std::string_view, Truncation>, 3> values = {
      {{"truncated", Truncation::truncated},
       {"shifted", Truncation::shifted},
       {"smoothed", Truncation::smoothed}}};
};

struct SpringDescription {
  static constexpr std::string_view type_name = SpringDef::type_name;
  AnchorDescription a, b;
  double stiffness = 100, damping = 1;
  std::optional<double> rest_length;
  double cable_radius = 0;
  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.object(d.a, {.name = "a", .required = true, .doc = "one end"});
    v.object(d.b, {.name = "b", .required = true, .doc = "other end"});
    v.field(d.stiffness,
            {.name = "stiffness", .unit = "N/m", .min = 0, .max = 1e12, .doc = "spring constant"});
    v.field(d.damping,
            {.name = "damping", .unit = "N s/m", .min = 0, .max = 1e12, .doc = "damping constant"});
    v.field(d.rest_length, {.name = "rest_length",
                            .unit = "m",
                            .min = 0,
                            .max = 1e6,
                            .doc = "length at rest; the initial distance unless given"});
    v.field(d.cable_radius, {.name = "cable_radius",
                             .unit = "m",
                             .min = 0,
                             .max = 1e3,
                             .doc = "drawn as a straight cable this thick; 0: as a coil"});
  }
};

/// Pulls a point of a body to a place, as the mouse does.
struct MouseSpringDescription {
  static constexpr std::string_view type_name = MouseSpringDef::type_name;
  AnchorDescription anchor;
  MouseSpringDef spring;
  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.object(d.anchor, {.name = "anchor", .required = true, .doc = "what is pulled"});
    v.part(d.spring);
  }
};

/// A field and the names of what it acts on: a body with copies means all of them.
template <class Def>
struct FieldDescription {
  static constexpr std::string_view type_name = Def::type_name;
  Def field;
  std::vector<std::string> bodies, particles;
  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.part(d.field);
    v.field(d.bodies, {.name = "bodies",
                       .doc = "names of the bodies that it acts on, all copies or \"brick[3]\"; "
                              "without bodies and particles it acts on everything"});
    v.field(d.particles, {.name = "particles", .doc = "particle systems that it acts on"});
  }
  static void check(const FieldDescription& d, Complaints& complaints) {
    if constexpr (requires { d.field.fault(); })
      if (const std::string fault = d.field.fault(); !fault.empty()) complaints.add("", fault);
  }
};

/// A pair potential and the names of the particle systems between whose particles it acts.
template <class Def>
struct PairDescription {
  static constexpr std::string_view type_name = Def::type_name;
  Def force;
  std::vector<std::string> between;
  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.part(d.force);
    v.field(d.between,
            {.name = "between",
             .doc = "names of the particle systems between whose particles it acts, each "
                    "with each, within a system too; without it all"});
  }
  static void check(const PairDescription& d, Complaints& complaints) {
    if (const std::string fault = d.force.fault(); !fault.empty()) complaints.add("", fault);
  }
};

/// How a scene describes a force: its definition, with names where that has ids.
template <class Def>
struct DescribedForce {
  using type = Def;
};
template <class Def>
requires requires(Def d) {
  d.targets;
}
struct DescribedForce<Def> {
  using type = FieldDescription<Def>;
};
template <PairForce Def>
struct DescribedForce<Def> {
  using type = PairDescription<Def>;
};
template <>
struct DescribedForce<SpringDef> {
  using type = SpringDescription;
};
template <>
struct DescribedForce<MouseSpringDef> {
  using type = MouseSpringDescription;
};
template <class Defs>
struct DescribedForces;
template <class... Defs>
struct DescribedForces<std::variant<Defs...>> {
  using type = std::variant<typename DescribedForce<Defs>::type...>;
};

using ForceKind = DescribedForces<ForceDef>::type;

struct ForceDescription {
  ForceKind kind;

  static constexpr std::string_view schema_name = "force";
  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.one_of(d.kind, {.name = "type", .required = true, .doc = "kind of force"});
  }
};

}  // namespace tumble
