#include "engine/dynamics/forces/force.hpp"

#include "engine/dynamics/forces/anchor.hpp"

#include <cmath>
#include <utility>

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
  void field(int value, const Parameter& p) { field(double(value), p); }
  void field(uint64_t, const Parameter&) {}
  void field(bool, const Parameter&) {}
  void field(Truncation, const Parameter&) {}
  void field(const std::vector<double>&, const Parameter&) {}  // fault() looks at them
  void field(const Varying& number, const Parameter& p) { field(number.value, p); }
  void field(const VaryingVec3& vector, const Parameter& p) { field(vector.now(), p); }
  void field(const Vec3& value, const Parameter& p) {
    if (!value.allFinite() && !fault)
      fault = Error{ErrorCode::invalid_argument,
                    fmt::format("{} is not finite", p.name),
                    std::string(force),
                    {}};
  }
};

/// Visits the declared parameters, and says whether any follows a course.
struct CourseSearch {
  bool found = false;

  template <class T>
  void field(const T& value, const Parameter&) {
    if constexpr (requires { value.varies(); }) found |= value.varies();
  }
};

/// Likewise, whether any is something else at a time.
struct DifferenceSearch {
  double t;
  bool found = false;

  template <class T>
  void field(const T& value, const Parameter&) {
    if constexpr (requires { value.differs_at(t); }) found |= value.differs_at(t);
  }
};

/// Puts what follows a course to a time.
struct CourseSetter {
  double t;

  template <class T>
  void field(T& value, const Parameter&) {
    if constexpr (requires { value.go_to(t); }) value.go_to(t);
  }
};

template <class Def>
constexpr bool stores_energy = PotentialField<Def> || PairForce<Def> ||
                               std::is_same_v<Def, SpringDef> || std::is_same_v<Def, SpringMeshDef>;

Error force_fault(const ForceDef& def, ErrorCode code, std::string message) {
  return {code, std::move(message), std::string(type_name(def)), {}};
}

Status check_targets(const ForceDef& def, const ForceContext& context) {
  const FieldTargets* targets = field_targets(def);
  if (!targets) return {};
  for (const BodyId id : targets->bodies)
    if (!context.bodies.ids.contains(id))
      return force_fault(def, ErrorCode::not_found, "a body that it acts on does not exist");
  for (const ParticleSystemId id : targets->particles)
    if (!context.particle_ids.contains(id))
      return force_fault(def, ErrorCode::not_found,
                         "a particle system that it acts on does not exist");
  return {};
}

Status check_pairs(const ForceDef& def, const ForceContext& context) {
  const std::vector<ParticleSystemId>* systems = paired_systems(def);
  if (!systems) return {};
  for (const ParticleSystemId id : *systems)
    if (!context.particle_ids.contains(id))
      return force_fault(def, ErrorCode::not_found,
                         "a particle system that it acts between does not exist");
  const std::string fault = std::visit(
      [&]<class Def>(const Def& d) {
        if constexpr (PairForce<Def>) return pair_fault(d.law(), d.between, context);
        return std::string();
      },
      def);
  if (!fault.empty()) return force_fault(def, ErrorCode::invalid_argument, fault);
  return {};
}

}  // namespace

std::string_view type_name(const ForceDef& def) {
  return std::visit([](const auto& d) { return std::decay_t<decltype(d)>::type_name; }, def);
}

Anchors anchors(const ForceDef& def) {
  if (const auto* s = std::get_if<SpringDef>(&def)) return {{s->a, s->b}, 2};
  if (const auto* m = std::get_if<MouseSpringDef>(&def)) return {{m->anchor}, 1};
  if (const auto* l = std::get_if<LoadDef>(&def)) return {{l->anchor}, 1};
  if (const auto* m = std::get_if<SpringMeshDef>(&def); m && m->mesh)
    return {{}, 0, m->mesh->nodes};
  return {};
}

const FieldTargets* field_targets(const ForceDef& def) {
  return std::visit(
      [](const auto& d) -> const FieldTargets* {
        if constexpr (requires { d.targets; })
          return &d.targets;
        else
          return nullptr;
      },
      def);
}

const std::vector<ParticleSystemId>* paired_systems(const ForceDef& def) {
  return std::visit(
      []<class Def>(const Def& d) -> const std::vector<ParticleSystemId>* {
        if constexpr (PairForce<Def>)
          return &d.between;
        else
          return nullptr;
      },
      def);
}

bool varies_in_time(const ForceDef& def) {
  return std::visit(
      [](const auto& d) {
        if constexpr (requires { d.varies_in_time(); })
          return d.varies_in_time();
        else
          return false;
      },
      def);
}

bool follows_courses(const ForceDef& def) {
  CourseSearch search;
  std::visit([&](const auto& d) { std::decay_t<decltype(d)>::parameters(search, d); }, def);
  return search.found;
}

bool differs_at(const ForceDef& def, double t) {
  DifferenceSearch search{t};
  std::visit([&](const auto& d) { std::decay_t<decltype(d)>::parameters(search, d); }, def);
  return search.found;
}

void go_to(ForceDef& def, double t) {
  CourseSetter setter{t};
  std::visit([&](auto& d) { std::decay_t<decltype(d)>::parameters(setter, d); }, def);
}

std::optional<FieldSample> sample_field(const ForceDef& def, const Vec3& x_world, double t) {
  return std::visit(
      [&]<class Def>(const Def& d) -> std::optional<FieldSample> {
        if constexpr (PotentialField<Def>)
          return FieldSample{d.acceleration(x_world), false};
        else if constexpr (FlowField<Def>)
          return FieldSample{d.at(t)(x_world), true};
        else
          return std::nullopt;
      },
      def);
}

Status check_ranges(const ForceDef& def) {
  RangeCheck check{{}, type_name(def)};
  std::visit([&](const auto& d) { std::decay_t<decltype(d)>::parameters(check, d); }, def);
  if (check.fault) return *check.fault;
  return {};
}

Status validate(const ForceDef& def, const ForceContext& context) {
  if (Status fine = check_ranges(def); !fine) return fine;
  const std::string own = std::visit(
      [](const auto& d) {
        if constexpr (requires { d.fault(); })
          return d.fault();
        else
          return std::string();
      },
      def);
  if (!own.empty()) return force_fault(def, ErrorCode::invalid_argument, own);
  for (const Anchor& a : anchors(def)) {
    if (!a.point.allFinite())
      return force_fault(def, ErrorCode::invalid_argument, "anchor point is not finite");
    if (a.kind == Anchor::Kind::body && !context.bodies.ids.contains(a.body))
      return force_fault(def, ErrorCode::not_found, "the body of an anchor does not exist");
    if (a.kind == Anchor::Kind::particle && !context.particle_ids.contains(a.particles))
      return force_fault(def, ErrorCode::not_found,
                         "the particle system of an anchor does not exist");
  }
  if (Status fine = check_targets(def, context); !fine) return fine;
  return check_pairs(def, context);
}

void apply(const ForceDef& def, ForceContext& context) {
  std::visit([&](const auto& d) { apply(d, context); }, def);
}

bool has_potential(const ForceDef& def) {
  return std::visit([]<class Def>(const Def&) { return stores_energy<Def>; }, def);
}

double potential_energy(const ForceDef& def, const ForceContext& context) {
  return std::visit(
      [&]<class Def>(const Def& d) -> double {
        if constexpr (stores_energy<Def>) return potential_energy(d, context);
        return 0;
      },
      def);
}

}  // namespace tumble
