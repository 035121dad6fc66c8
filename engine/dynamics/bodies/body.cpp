#include "engine/dynamics/bodies/body.hpp"

#include "engine/dynamics/bodies/inner_radius.hpp"
#include "engine/dynamics/bodies/tolerances.hpp"
#include "engine/geometry/hull/convex_hull.hpp"
#include "engine/geometry/mass_properties/principal_axes.hpp"
#include "engine/math/unit_quaternion.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

namespace tumble {

namespace {

Error invalid(std::string message, std::string place = {}) {
  return {ErrorCode::invalid_argument, std::move(message), std::move(place), {}};
}

Status check_pose(const Pose& pose, std::string_view place) {
  if (!pose.x.allFinite()) return invalid("position is not finite", std::string(place));
  const double length = pose.q.norm();
  if (!(std::abs(length - 1) < tolerances::quaternion_length)) {
    return invalid(fmt::format("orientation must be a unit quaternion, its length is {}", length),
                   std::string(place));
  }
  return {};
}

Status check_material(const Material& m, const std::string& place) {
  if (!(m.friction >= 0 && std::isfinite(m.friction))) {
    return invalid(fmt::format("friction must be >= 0, got {}", m.friction), place);
  }
  if (!(m.restitution >= 0 && m.restitution <= 1)) {
    return invalid(fmt::format("restitution must be in 0..1, got {}", m.restitution), place);
  }
  if (!(m.density >= 0 && std::isfinite(m.density))) {
    return invalid(fmt::format("density must be >= 0, got {} kg/m3", m.density), place);
  }
  for (const auto& [name, arm] : {std::pair("rolling_friction", m.rolling_arm()),
                                  std::pair("torsional_friction", m.torsional_arm())}) {
    if (!(arm >= 0 && std::isfinite(arm)))
      return invalid(fmt::format("{} must be >= 0, got {} m", name, arm), place);
  }
  if (!m.surface_velocity.allFinite()) return invalid("surface_velocity is not finite", place);
  return {};
}

/// The inertia tensor that a definition gives, about the centre of mass.
Mat3 given_inertia(const BodyDef& def) {
  Mat3 out = def.inertia->asDiagonal();
  if (def.products) {
    const Vec3& p = *def.products;
    out(0, 1) = out(1, 0) = p.x();
    out(0, 2) = out(2, 0) = p.y();
    out(1, 2) = out(2, 1) = p.z();
  }
  return out;
}

Status check_inertia(const BodyDef& def) {
  if (!def.inertia) {
    if (def.products) return invalid("products of inertia need moments of inertia");
    if (def.centre) return invalid("a centre of mass needs moments of inertia about it");
    return {};
  }
  const Mat3 tensor = given_inertia(def);
  if (def.centre && !def.centre->allFinite()) return invalid("centre of mass is not finite");
  const Vec3 I = tensor.allFinite() && def.products ? principal_axes(tensor).moments : *def.inertia;
  const bool possible = tensor.allFinite() && I.minCoeff() > 0 &&
                        2 * I.maxCoeff() <= I.sum() * (1 + tolerances::principal_moments);
  if (possible) return {};
  return invalid(
      fmt::format("moments of inertia must be > 0 and none above the sum of the others, got "
                  "{}, {}, {} kg m2",
                  I.x(), I.y(), I.z()));
}

Status check_def(const BodyDef& def) {
  if (Status s = check_pose(def.pose, "pose"); !s) return s;
  if (!def.velocity.allFinite()) return invalid("velocity is not finite");
  if (!def.angular_velocity.allFinite()) return invalid("angular_velocity is not finite");
  if (!std::isfinite(def.gravity_scale)) return invalid("gravity_scale is not finite");
  if (!(def.fluid_friction >= 0 && def.fluid_friction <= 1))
    return invalid(fmt::format("fluid_friction must be in [0, 1], got {}", def.fluid_friction));
  if (def.mass && !(*def.mass > 0 && std::isfinite(*def.mass))) {
    return invalid(fmt::format("mass must be > 0, got {} kg", *def.mass));
  }
  if (Status s = check_inertia(def); !s) return s;
  for (size_t i = 0; i < def.shapes.size(); ++i) {
    const std::string place = fmt::format("shapes[{}]", i);
    if (Status s = check_pose(def.shapes[i].pose, place); !s) return s;
    if (Status s = check_material(def.shapes[i].material, place); !s) return s;
    if (!(def.shapes[i].filled > 0 && std::isfinite(def.shapes[i].filled)))
      return invalid(fmt::format("{}: filled must be > 0, got {}", place, def.shapes[i].filled));
    if (def.shapes[i].source && !def.shapes[i].source->mesh)
      return invalid(place + ": what it was made of has no mesh");
  }
  if (def.course && def.type != BodyType::kinematic)
    return invalid("only a kinematic body can have a course");
  if (def.course && !(def.course->axis.allFinite() && def.course->axis.norm() > 0))
    return invalid("the axis of a course must be finite and not zero");
  for (size_t i = 0; i < def.drawn.size(); ++i)
    if (Status s = check_pose(def.drawn[i].pose, fmt::format("drawn[{}]", i)); !s) return s;
  if (def.shapes.empty() && def.type == BodyType::dynamic && !(def.mass && def.inertia)) {
    return invalid(
        "a dynamic body needs at least one shape, which gives it mass and inertia, or both of "
        "these themselves");
  }
  return {};
}

Result<MassProperties> unit_mass(const Shape& shape, bool hull_mass, const std::string& place) {
  Result<MassProperties> own = shape.mass_properties();
  if (own) return own;
  Error error = own.error();
  if (error.place.empty()) error.place = place;
  if (!shape.is_mesh() || !hull_mass) {
    if (shape.is_mesh()) {
      error.cure += "; for a body: make it fixed, or set hull_mass to take mass from the hull";
    }
    return error;
  }
  Result<ConvexHull> hull = convex_hull(shape.def().mesh->vertices);
  if (!hull) {
    Error e = hull.error();
    e.place = place;
    return e;
  }
  return polyhedron_mass(hull->polyhedron);
}

/// Sum of the shapes' mass properties in the definition's body frame.
Result<MassProperties> mass_of_shapes(const BodyDef& def, const std::vector<BodyShape>& shapes) {
  double densities = 0;
  for (const BodyShape& s : shapes) densities += s.material.density;
  // If a total mass is given, shapes of zero density still determine its distribution.
  const bool even = !(densities > 0) && def.mass;
  std::vector<MassProperties> parts;
  for (size_t i = 0; i < shapes.size(); ++i) {
    Result<MassProperties> unit =
        unit_mass(*shapes[i].shape, def.hull_mass, fmt::format("shapes[{}]", i));
    if (!unit) return unit;
    parts.push_back(moved(unit->times(even ? 1 : shapes[i].material.density), shapes[i].pose));
  }
  MassProperties total = compound(parts);
  if (!(total.mass > 0 && std::isfinite(total.mass))) {
    return invalid(
        fmt::format("a dynamic body needs mass > 0, its shapes sum up to {} kg", total.mass));
  }
  return def.mass ? total.times(*def.mass / total.mass) : total;
}

/// Mass properties from the definition, the rest from the shapes.
Result<MassProperties> total_mass(const BodyDef& def, const std::vector<BodyShape>& shapes) {
  const bool given = def.mass && def.inertia && (def.centre || shapes.empty());
  Result<MassProperties> out =
      given ? MassProperties{*def.mass, Vec3::Zero(), Mat3::Zero()} : mass_of_shapes(def, shapes);
  if (!out) return out;
  if (def.inertia) out->inertia = given_inertia(def);
  if (def.centre) out->centre = *def.centre;
  return out;
}

Status set_mass(RigidBody& body, const MassProperties& m) {
  body.mass = m.mass;
  body.inverse_mass = 1 / m.mass;
  body.centre_body = m.centre;
  body.inertia_body = 0.5 * (m.inertia + m.inertia.transpose());
  body.inverse_inertia_body = body.inertia_body.inverse();
  const bool usable = std::isfinite(body.inverse_mass) && body.inertia_body.determinant() > 0 &&
                      body.inverse_inertia_body.allFinite();
  if (!usable) {
    return invalid(
        fmt::format("mass {} kg with moments of inertia {}, {}, {} kg m2 cannot be "
                    "inverted: the body is too thin or too small",
                    m.mass, m.inertia(0, 0), m.inertia(1, 1), m.inertia(2, 2)));
  }
  return {};
}

Result<std::shared_ptr<const Shape>> make_at(const ShapeDef& def, ShapeFactory make,
                                             const std::string& place) {
  Result<std::shared_ptr<const Shape>> shape = make(def);
  if (shape) return shape;
  Error error = shape.error();
  error.place = error.place.empty() ? place : place + " " + error.place;
  return error;
}

/// The drawn shapes, relative to the centre of mass.
Result<std::shared_ptr<const std::vector<DrawnShape>>> drawn_shapes(const BodyDef& def,
                                                                    const Vec3& centre,
                                                                    ShapeFactory make) {
  auto out = std::make_shared<std::vector<DrawnShape>>();
  for (size_t i = 0; i < def.drawn.size(); ++i) {
    const DrawnShapeDef& s = def.drawn[i];
    auto shape = make_at(s.shape, make, fmt::format("drawn[{}]", i));
    if (!shape) return shape.error();
    out->push_back({{*shape, {s.pose.x - centre, s.pose.q.normalized()}, {}}, s.colour});
  }
  return std::shared_ptr<const std::vector<DrawnShape>>(std::move(out));
}

std::shared_ptr<const BoundsTree> tree_of(std::span<const BodyShape> shapes) {
  std::vector<Aabb> bounds;
  for (const BodyShape& s : shapes) bounds.push_back(s.shape->bounds(s.pose));
  return std::make_shared<const BoundsTree>(bounds);
}

}  // namespace

Result<RigidBody> make_body(const BodyDef& def, ShapeFactory make) {
  if (Status s = check_def(def); !s) return s.error();
  RigidBody body;
  body.type = def.type;
  body.group = def.group;
  body.gravity_scale = def.gravity_scale;
  body.fluid_friction = def.fluid_friction;
  body.can_sleep = def.can_sleep;
  body.precise = def.precise;
  body.asleep = def.starts_asleep && def.can_sleep && def.type == BodyType::dynamic;
  if (def.type != BodyType::fixed) {
    body.v = def.velocity;
    body.omega = def.angular_velocity;
  }
  for (size_t i = 0; i < def.shapes.size(); ++i) {
    const BodyShapeDef& s = def.shapes[i];
    auto shape = make_at(s.shape, make, fmt::format("shapes[{}]", i));
    if (!shape) return shape.error();
    body.shapes.push_back({*shape, {s.pose.x, s.pose.q.normalized()}, s.material});
  }
  if (body.dynamic()) {
    Result<MassProperties> mass = total_mass(def, body.shapes);
    if (!mass) return mass.error();
    if (Status s = set_mass(body, *mass); !s) return s.error();
  }
  if (!def.drawn.empty()) {
    auto drawn = drawn_shapes(def, body.centre_body, make);
    if (!drawn) return drawn.error();
    body.drawn = std::move(*drawn);
  }
  for (BodyShape& s : body.shapes) {
    s.pose.x -= body.centre_body;
    body.bounding_radius =
        std::max(body.bounding_radius, s.pose.x.norm() + s.shape->bounding_radius());
  }
  if (body.dynamic() && body.shapes.size() > 1) body.tree = tree_of(body.shapes);
  if (body.type != BodyType::fixed) body.inner_radius = inner_radius_of(body.shapes);
  const Quat q = unit(def.pose.q);
  body.pose = {def.pose.x + q * body.centre_body, q};
  return body;
}

Result<RigidBody> make_body(const BodyDef& def) {
  return make_body(def, make_shape);
}

}  // namespace tumble
