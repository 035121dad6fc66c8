#pragma once
#include "engine/dynamics/forces/force.hpp"
#include "engine/scene/description/anchor.hpp"

#include <type_traits>
#include <variant>

namespace tumble {

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
  Varying stiffness = 100, damping = 1;
  std::optional<Varying> rest_length;
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

/// A force at one anchor.
template <class Def>
struct AnchoredDescription {
  static constexpr std::string_view type_name = Def::type_name;
  AnchorDescription anchor;
  Def force;
  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.object(d.anchor, {.name = "anchor", .required = true, .doc = "what is pulled"});
    v.part(d.force);
  }
  static void check(const AnchoredDescription& d, Complaints& complaints) {
    if constexpr (requires { d.force.fault(); }) {
      Def force = d.force;
      if (!d.anchor.body.empty())
        force.anchor.kind = Anchor::Kind::body;
      else if (!d.anchor.particles.empty())
        force.anchor.kind = Anchor::Kind::particle;
      if (const std::string fault = force.fault(); !fault.empty()) complaints.add("", fault);
    }
  }
};

/// A field and the names of what it acts on; a body with copies stands for all of them.
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

/// The description of a force: its definition, with names instead of ids.
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
template <class Def>
requires requires(Def d) {
  d.anchor;
}
struct DescribedForce<Def> {
  using type = AnchoredDescription<Def>;
};
/// Meshes of springs are described together with the particles that they connect (weave.hpp).
template <>
struct DescribedForce<SpringMeshDef> {
  using type = void;
};
/// The alternatives of `Described` and those of the forces that have a description of their own.
template <class Described, class... Defs>
struct DescribedForces {
  using type = Described;
};
template <class... Described, class Def, class... Defs>
struct DescribedForces<std::variant<Described...>, Def, Defs...> {
  using own = typename DescribedForce<Def>::type;
  using more =
      typename std::conditional_t<std::is_void_v<own>,
                                  std::type_identity<std::variant<Described...>>,
                                  std::type_identity<std::variant<Described..., own>>>::type;
  using type = typename DescribedForces<more, Defs...>::type;
};
template <class Defs>
struct ForceKinds;
template <class... Defs>
struct ForceKinds<std::variant<Defs...>> {
  using type = typename DescribedForces<std::variant<>, Defs...>::type;
};

using ForceKind = ForceKinds<ForceDef>::type;

struct ForceDescription {
  ForceKind kind;

  static constexpr std::string_view schema_name = "force";
  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.one_of(d.kind, {.name = "type", .required = true, .doc = "kind of force"});
  }
};

}  // namespace tumble
