#include "engine/dynamics/forces/force.hpp"

#include "engine/dynamics/forces/anchor.hpp"
#include "engine/dynamics/forces/drag.hpp"
#include "engine/dynamics/forces/mouse_spring.hpp"
#include "engine/dynamics/forces/spring.hpp"

#include <cmath>

#include <fmt/format.h>

namespace tumble {
namespace {

/// Visits the declared parameters and keeps the first that is out of its range.
struct RangeCheck {
  std::optional<Error> fault;
  std::string_view force;

  void field(double value, const Parameter& p) {
    const bool inside = std::isfinite(value) &&
                        (p.exclusive_min ? value > p.min : value >= p.min) && value <= p.max;
    if (!inside && !fault)
      fault = Error{ErrorCode::invalid_argument,
                    fmt::format("{} must be a finite number {} {}, got {} {}", p.name,
                                p.exclusive_min ? ">" : ">=", p.min, value, p.unit),
                    std::string(force),
                    {}};
  }
  void field(const Vec3& value, const Parameter& p) {
    if (!value.allFinite() && !fault)
      fault = Error{ErrorCode::invalid_argument,
                    fmt::format("{} is not finite", p.name),
                    std::string(force),
                    {}};
  }
};

template <class Def>
constexpr bool has_potential = std::is_same_v<Def, SpringDef>;

}  // namespace

std::string_view type_name(const ForceDef& def) {
  return std::visit([](const auto& d) { return std::decay_t<decltype(d)>::type_name; }, def);
}

std::vector<Anchor> anchors(const ForceDef& def) {
  if (const auto* s = std::get_if<SpringDef>(&def)) return {s->a, s->b};
  if (const auto* m = std::get_if<MouseSpringDef>(&def)) return {m->anchor};
  return {};
}

Status validate(const ForceDef& def, const ForceContext& context) {
  RangeCheck check{{}, type_name(def)};
  std::visit([&](const auto& d) { std::decay_t<decltype(d)>::parameters(check, d); }, def);
  if (check.fault) return *check.fault;
  for (const Anchor& a : anchors(def)) {
    const auto fault = [&](ErrorCode code, std::string message) {
      return Error{code, std::move(message), std::string(type_name(def)), {}};
    };
    if (!a.point.allFinite())
      return fault(ErrorCode::invalid_argument, "anchor point is not finite");
    if (a.kind == Anchor::Kind::body && !context.bodies.ids.contains(a.body))
      return fault(ErrorCode::not_found, "the body of an anchor does not exist");
    if (a.kind == Anchor::Kind::particle && !context.particle_ids.contains(a.particles))
      return fault(ErrorCode::not_found, "the particle system of an anchor does not exist");
  }
  return {};
}

void apply(const ForceDef& def, ForceContext& context) {
  std::visit([&](const auto& d) { apply(d, context); }, def);
}

double potential_energy(const ForceDef& def, const ForceContext& context) {
  return std::visit(
      [&](const auto& d) -> double {
        if constexpr (has_potential<std::decay_t<decltype(d)>>) return potential_energy(d, context);
        return 0;
      },
      def);
}

}  // namespace tumble
