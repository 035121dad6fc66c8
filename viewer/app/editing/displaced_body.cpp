#include "viewer/app/editing/displaced_body.hpp"

#include "engine/collision/shape.hpp"
#include "engine/geometry/triangle_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <utility>

#include <fmt/format.h>

namespace tumble {
namespace {

std::shared_ptr<const TriangleMesh> grown_mesh(const TriangleMesh& mesh, double factor) {
  auto grown = std::make_shared<TriangleMesh>(mesh);
  for (Vec3& x : grown->vertices) x *= factor;
  return grown;
}

/// Scales lengths that belong to the mesh's collision representation.
void grow_mesh(ShapeDef& shape, double factor) {
  shape.mesh = grown_mesh(*shape.mesh, factor);
  shape.field = nullptr;
  shape.cell *= factor;
}

/// Scales the source meshes of shapes, each once. A mesh stretched along one axis has no source any
/// more.
void grow_sources(BodyDef& def, const Displacement& way) {
  const double factor = way.scale;
  std::map<std::shared_ptr<const MeshSource>, std::shared_ptr<const MeshSource>> grown;
  for (BodyShapeDef& part : def.shapes) {
    if (way.scale_axis) part.source = nullptr;
    if (!part.source) continue;
    auto& now = grown[part.source];
    if (!now) {
      MeshSource source = *part.source;
      source.mesh = grown_mesh(*source.mesh, factor);
      source.pose.x *= factor;
      source.how.concavity *= factor;
      source.how.cell *= factor;
      now = std::make_shared<const MeshSource>(std::move(source));
    }
    part.source = now;
  }
}

void grow(ShapeDef& shape, double factor) {
  if (shape.mesh) return grow_mesh(shape, factor);
  for (const ShapeParameter& p : shape_entry(shape.type).parameters) {
    if (p.number) shape.*p.number *= factor;
    if (p.vector) shape.*p.vector *= factor;
  }
}

/// Scales along an axis of the shape's frame.
void stretch(ShapeDef& shape, double factor, int axis) {
  const auto& parameters = shape_entry(shape.type).parameters;
  const bool has_height = std::ranges::any_of(
      parameters, [](const ShapeParameter& p) { return p.number == &ShapeDef::height; });
  for (const ShapeParameter& p : parameters) {
    if (p.vector) (shape.*p.vector)[axis] *= factor;
    // The axis of round shapes is y; a shape without a height is a ball.
    if (!p.number) continue;
    const bool is_height = p.number == &ShapeDef::height;
    if (!has_height || is_height == (axis == 1)) shape.*p.number *= factor;
  }
}

int nearest_axis(const Pose& frame, const Vec3& axis_world) {
  int best = 0;
  frame.inverse_direction(axis_world).cwiseAbs().maxCoeff(&best);
  return best;
}

/// The pose at which a course begins that has led from the pose `begin` to `now`, where it is to
/// lead to `wanted` instead.
Pose begin_moved(const Pose& begin, const Pose& now, const Pose& wanted) {
  Pose out = begin;
  if (!(wanted.x == now.x)) out.x += wanted.x - now.x;
  if (!(wanted.q.coeffs() == now.q.coeffs())) out.q = begin.q * now.q.conjugate() * wanted.q;
  return out;
}

}  // namespace

Result<BodyDef> displaced(const BodyDef& def, const Displacement& way) {
  BodyDef out = def;
  out.pose = way.moved(def.pose);
  if (way.scale == 1) return out;
  const auto refuse = [&](const char* why) {
    return Error{ErrorCode::invalid_argument,
                 fmt::format("'{}' cannot grow along one axis: {}; take the handle in the middle",
                             def.name, why),
                 {},
                 {}};
  };
  if (way.scale_axis && (def.inertia || def.products))
    return refuse("its inertia is given as numbers");
  const Vec3 axis = way.scale_axis ? def.pose.inverse_direction(*way.scale_axis) : Vec3::Zero();
  const auto grow_part = [&](ShapeDef& shape, Pose& pose) -> bool {
    if (!way.scale_axis) {
      grow(shape, way.scale);
      pose.x *= way.scale;
      return true;
    }
    if (shape.mesh) return false;
    stretch(shape, way.scale, nearest_axis(def.pose * pose, *way.scale_axis));
    pose.x += (way.scale - 1) * axis.dot(pose.x) * axis;
    return true;
  };
  for (BodyShapeDef& part : out.shapes)
    if (!grow_part(part.shape, part.pose)) return refuse("it is made of a mesh");
  for (DrawnShapeDef& part : out.drawn)
    if (!grow_part(part.shape, part.pose)) return refuse("it is drawn by a mesh");
  grow_sources(out, way);
  if (out.inertia) *out.inertia *= way.scale * way.scale;
  if (out.products) *out.products *= way.scale * way.scale;
  if (out.centre) *out.centre *= way.scale;
  return out;
}

ChangedBody changed_at(const BodyDef& known, const Pose& now, BodyDef wanted, bool begun) {
  ChangedBody out{known.name, known, std::move(wanted), {}};
  BodyDef& after = out.after;
  if (!known.course || after.course != known.course) return out;
  const bool stays = after.pose.x == now.x && after.pose.q.coeffs() == now.q.coeffs() &&
                     after.velocity == known.velocity &&
                     after.angular_velocity == known.angular_velocity;
  if (stays) {
    after.pose = known.pose;
  } else if (begun) {
    out.before.pose = now;
    after.course = nullptr;
    out.written = {{"course", std::nullopt}};
  } else {
    after.pose = begin_moved(known.pose, now, after.pose);
    after.course = std::make_shared<const BodyCourse>(*known.course);  // which begins anew
  }
  return out;
}

}  // namespace tumble
