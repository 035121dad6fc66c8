#include "viewer/app/editing/builder.hpp"

#include "engine/math/rotation.hpp"
#include "engine/scene/description/material.hpp"
#include "engine/world/world.hpp"
#include "viewer/app/editing/new_name.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

namespace tumble {
namespace {

/// Size of new bodies over the distance from which they are viewed [-].
constexpr double size_in_view = 0.1;
/// Used in turn, so that neighbouring new bodies can be told apart; linear.
const std::array<Vec3f, 6> colours_of_new = {
    Vec3f(0.02f, 0.22f, 0.20f), Vec3f(0.66f, 0.13f, 0.07f), Vec3f(0.75f, 0.42f, 0.03f),
    Vec3f(0.07f, 0.25f, 0.55f), Vec3f(0.45f, 0.30f, 0.17f), Vec3f(0.30f, 0.32f, 0.35f)};
/// Natural frequency of new springs with the lighter of their bodies [Hz], and their damping ratio
/// [-].
constexpr double spring_frequency = 2, spring_damping = 0.1;

/// Speed of new motors: a turn in four seconds, which is easy to see [rad/s].
constexpr double motor_rate = 0.5 * std::numbers::pi;

/// Rounds to 1, 2 or 5 times a power of ten.
double round_length(double length) {
  const double decade = std::pow(10.0, std::floor(std::log10(length)));
  const double share = length / decade;
  return decade * (share < 1.5 ? 1 : share < 3.5 ? 2 : share < 7.5 ? 5 : 10);
}

/// The frame of the body's definition, in which anchors are given.
Pose definition_frame(const Frame& frame, uint32_t slot) {
  const Pose& centre = frame.body(slot).pose;
  return {centre.x - centre.direction(frame.info(slot).centre_body), centre.q};
}

std::string name_of(const Frame& frame, BodyId id) {
  const auto slot = find_slot(frame, id);
  if (!slot) return "the world";
  const std::string& name = frame.info(*slot).name;
  return name.empty() ? fmt::format("body {}", id.index) : name;
}

/// The body's name in scene files; "" for the world.
std::string file_name_of(const Frame& frame, BodyId id) {
  const auto slot = find_slot(frame, id);
  return slot ? frame.info(*slot).name : std::string();
}

Result<Added> add_joint(World& world, JointDef joint, const std::string& a, const std::string& b) {
  for (int n = 1; joint.name.empty() || !world.find_joint(joint.name).is_null(); ++n)
    joint.name = fmt::format("{}_{}", entry_of(joint.kind).name, n);
  if (const auto made = world.create_joint(joint); !made) return made.error();
  return Added{AddedJoint{std::move(joint), a, b}, {}};
}

/// Distance by which a box extends from the origin in the direction opposite to `normal` [m].
double reach_below(const Aabb& box, const Vec3& normal) {
  double reach = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 x(corner & 1 ? box.max.x() : box.min.x(), corner & 2 ? box.max.y() : box.min.y(),
                 corner & 4 ? box.max.z() : box.min.z());
    reach = std::max(reach, -normal.dot(x));
  }
  return reach;
}

double reach_below(const ShapeDef& def, const Vec3& normal) {
  const auto shape = make_shape(def);
  return shape ? reach_below((*shape)->bounds(Pose{}), normal) : 0;
}

/// Gives the new body an unused name and a colour.
Addition addition_of(const BodyDef& def, const std::shared_ptr<const MeshOfBody>& mesh) {
  return {"Add " + def.name, [def, mesh](World& world) -> Result<Added> {
            BodyDef named = def;
            named.name = new_body_name(world, def.name);
            named.look.colour = colours_of_new[world.frame()->body_slots() % colours_of_new.size()];
            const auto made = world.create_body(named);
            if (!made) return made.error();
            return Added{AddedBody{std::move(named), mesh}, *made};
          }};
}

/// The mass of the lighter movable body; if both are fixed the spring has nothing to pull.
double lighter_mass(const Frame& frame, BodyId a, BodyId b) {
  double mass = 0;
  for (const BodyId id : {a, b})
    if (const auto slot = find_slot(frame, id)) {
      const double m = frame.info(*slot).mass;
      if (m > 0) mass = mass > 0 ? std::min(mass, m) : m;
    }
  return mass > 0 ? mass : 1;
}

}  // namespace

double Builder::usual_size(double view) {
  return round_length(size_in_view * view);
}

Addition Builder::body(const BuildChoice& choice, const Vec3& at, const Vec3& normal,
                       double view) const {
  const ShapeEntry& entry = all_shapes()[std::get<NewBody>(choice.what).shape];
  const double size = usual_size(view);
  BodyShapeDef part;
  part.shape.type = entry.type;
  for (const ShapeParameter& p : entry.parameters) {
    if (p.number) part.shape.*p.number *= size;
    if (p.vector) part.shape.*p.vector *= size;
  }
  // An ellipsoid with half axes of 1/2 is a ball.
  part.material = built_in_materials()[choice.material].second;
  BodyDef def;
  def.name = entry.name;
  def.type = choice.type;
  def.pose.x = at + reach_below(part.shape, normal) * normal;
  def.shapes.push_back(part);
  return addition_of(def, nullptr);
}

Addition Builder::mesh_body(const BuildChoice& choice, const PaletteMesh& mesh, const Vec3& at,
                            const Vec3& normal) {
  BodyShapeDef whole;
  whole.material = built_in_materials()[choice.material].second;
  BodyDef def;
  def.name = name_after(mesh.chosen.file);
  def.type = choice.type;
  append_mesh_parts(def.shapes, whole, mesh.mesh, mesh.parts);
  def.pose.x = at + reach_below(bounds(*mesh.mesh), normal) * normal;
  return addition_of(def, std::make_shared<const MeshOfBody>(MeshOfBody{
                              mesh.chosen.file, mesh.scale, mesh.chosen.mode, whole.material}));
}

std::optional<Addition> Builder::connection(const BuildChoice& choice, const Frame& frame,
                                            const std::optional<Pick>& hit, const Vec3& at) const {
  const BodyId other = hit ? hit->body : BodyId{};
  const auto slot = find_slot(frame, first_->body);
  if (!slot || other == first_->body) return std::nullopt;
  const Pose anchor = definition_frame(frame, *slot) * first_->frame_body;
  const auto other_slot = find_slot(frame, other);
  const Pose other_frame = other_slot ? definition_frame(frame, *other_slot) : Pose{};
  const std::string ends =
      fmt::format("{} and {}", name_of(frame, first_->body), name_of(frame, other));
  if (std::holds_alternative<NewSpring>(choice.what)) {
    SpringDef spring;
    spring.a.kind = Anchor::Kind::body;
    spring.a.body = first_->body;
    spring.a.point = first_->frame_body.x;
    spring.b.kind = other_slot ? Anchor::Kind::body : Anchor::Kind::world;
    spring.b.body = other;
    spring.b.point = other_frame.inverse_point(at);
    const double w = 2 * std::numbers::pi * spring_frequency;
    const double mass = lighter_mass(frame, first_->body, other);
    spring.stiffness = mass * w * w;
    spring.damping = 2 * spring_damping * mass * w;
    spring.rest_length = (at - anchor.x).norm();
    const std::string a = file_name_of(frame, first_->body), b = file_name_of(frame, other);
    return Addition{"Spring between " + ends, [spring, a, b](World& world) -> Result<Added> {
                      const auto made = world.create_force(spring);
                      if (!made) return made.error();
                      return Added{AddedSpring{spring, {}, a, b, *made}, {}};
                    }};
  }
  JointDef joint;
  joint.kind = std::get<NewJoint>(choice.what).kind;
  const bool apart = joint.kind == JointKind::distance || joint.kind == JointKind::free;
  joint.a = first_->body;
  joint.b = other;
  joint.frame_a = first_->frame_body;
  joint.frame_b = other_frame.inverse() * Pose{apart ? at : anchor.x, anchor.q};
  if (apart) joint.length = (at - anchor.x).norm();
  if (std::get<NewJoint>(choice.what).motor) {
    joint.drives[0].motor.kind = MotorKind::velocity;
    joint.drives[0].motor.target = motor_rate;
  }
  if (!other_slot) {  // the world is given first
    std::swap(joint.a, joint.b);
    std::swap(joint.frame_a, joint.frame_b);
  }
  const std::string a = file_name_of(frame, joint.a), b = file_name_of(frame, joint.b);
  return Addition{fmt::format("Join {}", ends),
                  [joint, a, b](World& world) { return add_joint(world, joint, a, b); }};
}

std::optional<Addition> Builder::click(const BuildChoice& choice, const Frame& frame,
                                       const Ray& ray, const std::optional<Pick>& hit,
                                       double view) {
  const Vec3 at = hit ? hit->x_world : ray.origin + view * ray.direction;
  if (std::holds_alternative<NewBody>(choice.what))
    return body(choice, at, hit ? hit->normal : Vec3::UnitY(), hit ? hit->distance : view);
  if (!first_) {
    if (!hit) return std::nullopt;
    const auto slot = find_slot(frame, hit->body);
    if (!slot) return std::nullopt;
    const Pose anchor{hit->x_world, rotation_between(Vec3::UnitZ(), hit->normal)};
    first_ = End{hit->body, definition_frame(frame, *slot).inverse() * anchor};
    return std::nullopt;
  }
  auto made = connection(choice, frame, hit, at);
  if (made) first_.reset();
  return made;
}

void Builder::draw(const BuildChoice& choice, const Frame& frame, RenderScene& picture) const {
  if (!first_) return;
  const auto slot = find_slot(frame, first_->body);
  if (!slot) return;
  const Pose anchor = definition_frame(frame, *slot) * first_->frame_body;
  const Vec4f dark(0.01f, 0.01f, 0.012f, 0.8f), bright(1, 0.45f, 0.05f, 1);
  PointMark mark;
  mark.x = anchor.x.cast<float>();
  mark.occlusion = Occlusion::none;
  for (const auto& [size, colour] : {std::pair(16.0f, dark), std::pair(11.0f, bright)}) {
    mark.size = size;
    mark.colour = colour;
    picture.points.push_back(mark);
  }
  const auto* joint = std::get_if<NewJoint>(&choice.what);
  if (!joint || !entry_of(joint->kind).uses_axes) return;
  const double length =
      frame.info(*slot).shapes.empty() ? 1 : body_bounds(frame, *slot).extent().norm();
  const Vec3 half = 0.5 * std::clamp(length, 0.05, 100.0) * anchor.direction(Vec3::UnitZ());
  LineSegment axis;
  axis.a = (anchor.x - half).cast<float>();
  axis.b = (anchor.x + half).cast<float>();
  axis.colour = bright;
  axis.width = 3;
  picture.lines.push_back(axis);
}

}  // namespace tumble
