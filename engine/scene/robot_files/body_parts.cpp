#include "engine/scene/robot_files/body_parts.hpp"

#include "engine/collision/shapes/validation.hpp"
#include "engine/geometry/mass_properties/principal_axes.hpp"
#include "engine/scene/mesh_import.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace tumble {
namespace {

/// Colour of robots whose file gives none.
constexpr Colour robot_grey{0.72, 0.73, 0.75};

std::string mesh_named(const RobotGeometry& g, const std::string& prefix,
                       NamedList<MeshDescription>& meshes) {
  MeshDescription made;
  made.file = std::filesystem::absolute(g.mesh).string();
  if (g.scale != Vec3(1, 1, 1)) made.stretch = g.scale;
  for (const auto& item : meshes.items)
    if (item.value.file == made.file && item.value.stretch == made.stretch) return item.name;
  std::string name = prefix + "mesh_";
  for (const char c : g.mesh.stem().string().substr(0, 30))
    name += std::isalnum(static_cast<unsigned char>(c)) ? c : '_';
  const std::string base = name;
  for (int n = 2; meshes.find(name); ++n) name = fmt::format("{}_{}", base, n);
  meshes.add(name, made);
  return name;
}

Placement placed(const Pose& pose) {
  Placement out;
  out.position = pose.x;
  out.orientation = pose.q.normalized();
  return out;
}

bool same_geometry(const RobotGeometry& a, const RobotGeometry& b) {
  return a.at.line == b.at.line && a.at.file == b.at.file && a.pose.x == b.pose.x &&
         a.mesh == b.mesh;
}

/// Whether the drawn geometry is equal to the colliding one, in one colour.
bool drawn_as_it_collides(const RobotBody& body) {
  const auto one_colour = [&](const RobotGeometry& g) {
    const auto &a = g.colour, &b = body.drawn.front().colour;
    return a.has_value() == b.has_value() && (!a || (a->r == b->r && a->g == b->g && a->b == b->b));
  };
  const auto is_mesh = [](const RobotGeometry& g) { return !g.mesh.empty(); };
  return std::equal(body.collides.begin(), body.collides.end(), body.drawn.begin(),
                    body.drawn.end(), same_geometry) &&
         std::all_of(body.drawn.begin(), body.drawn.end(), one_colour) &&
         std::none_of(body.drawn.begin(), body.drawn.end(), is_mesh);
}

/// The box with the mass properties of a body.
DrawnDescription inertia_box(const MassProperties& m) {
  const PrincipalAxes axes = principal_axes(m.inertia);
  const Vec3 second = (0.5 * axes.moments.sum() - axes.moments.array()).max(0) / m.mass;
  const Vec3 half = (3 * second.array()).sqrt().max(2 * min_shape_size);
  DrawnDescription out;
  out.kind = shape_kind(robot_box(half));
  out.placement = placed({m.centre, axes.rotation});
  return out;
}

void add_mass(const MassProperties& m, BodyDescription& out) {
  out.mass = m.mass;
  out.inertia = m.inertia.diagonal();
  const Vec3 products(m.inertia(0, 1), m.inertia(0, 2), m.inertia(1, 2));
  if (!products.isZero(0)) out.products = products;
  out.centre = m.centre;
}

}  // namespace

const std::vector<RobotGeometry>& seen_of(const RobotBody& body) {
  return body.drawn.empty() ? body.collides : body.drawn;
}

bool is_plane(const RobotGeometry& g) {
  if (!g.mesh.empty()) return false;
  const auto shape = make_shape(g.shape);
  return shape && (*shape)->is_half_space();
}

Aabb bounds_of(const RobotGeometry& g, const Pose& body) {
  Aabb out;
  const Pose pose = body * g.pose;
  if (g.mesh.empty()) {
    const auto shape = make_shape(g.shape);
    if (shape && !(*shape)->is_half_space()) out = (*shape)->bounds(pose);
  } else if (const auto read = import_mesh(g.mesh, {.stretch = g.scale})) {
    for (const Vec3& v : read->mesh.vertices) out.include(pose.point(v));
  }
  return out;
}

BodyDescription body_of(const RobotBody& body, const std::string& prefix,
                        NamedList<MeshDescription>& meshes, RobotLog& log) {
  BodyDescription out;
  if (body.mass.mass > 0 && !body.fixed) add_mass(body.mass, out);
  for (const RobotGeometry& g : body.collides) {
    ShapeDescription shape;
    if (g.mesh.empty())
      shape.kind = shape_kind(g.shape);
    else
      shape.kind = ConvexHullShapeDescription{{}, mesh_named(g, prefix, meshes)};
    shape.placement = placed(g.pose);
    if (g.friction) shape.material.emplace().friction = g.friction;
    out.shapes.push_back(std::move(shape));
  }
  out.colour = robot_grey;
  const auto& seen = seen_of(body);
  if (!seen.empty() && seen.front().colour) out.colour = seen.front().colour;
  if (!body.drawn.empty() && !drawn_as_it_collides(body))
    for (const RobotGeometry& g : body.drawn) {
      DrawnDescription drawn;
      if (g.mesh.empty())
        drawn.kind = shape_kind(g.shape);
      else
        drawn.kind = TriangleMeshShapeDescription{mesh_named(g, prefix, meshes)};
      drawn.placement = placed(g.pose);
      drawn.colour = g.colour.value_or(robot_grey);
      out.drawn.push_back(std::move(drawn));
    }
  const bool bare = body.collides.empty() && body.drawn.empty();
  if (bare && out.mass) {
    out.drawn.push_back(inertia_box(body.mass));
    log.warn(body.at,
             "what has no geometry, or none that was found, is drawn as the box of equal "
             "inertia and does not collide");
  } else if (body.collides.empty()) {
    log.warn(body.at, fmt::format("'{}' is only drawn: nothing of it collides", body.name));
  }
  return out;
}

}  // namespace tumble
