#include "tests/support/accuracy/tumble_case.hpp"

#include <cmath>

namespace tumble::test {
namespace {

/// A box has the tensor of any body: (b^2 + c^2) m / 3 about a, and so on.
Vec3 box_with_inertia(const CaseBody& b) {
  return (1.5 / b.mass * (Vec3::Constant(b.inertia.sum()) - 2 * b.inertia)).cwiseSqrt();
}

BodyDef definition_of(const CaseBody& b, bool collide) {
  BodyDef def;
  def.type = b.fixed ? BodyType::fixed : BodyType::dynamic;
  def.pose = b.pose;
  def.velocity = b.v;
  def.angular_velocity = b.omega;
  def.mass = b.mass;
  def.can_sleep = false;
  BodyShapeDef& s = def.shapes.emplace_back();
  s.shape.type = b.radius > 0 && collide ? ShapeType::sphere : ShapeType::box;
  s.shape.radius = b.radius;
  s.shape.half_extents = collide ? b.half : box_with_inertia(b);
  s.material.friction = b.friction;
  s.material.restitution = b.restitution;
  s.material.rolling_friction = s.material.torsional_friction = 0;  // the cases roll ideally
  return def;
}

}  // namespace

TumbleCase::TumbleCase(const CaseScene& scene, WorldSettings settings, Watch watch)
    : watch_(std::move(watch)) {
  WorldDef def;
  settings.gravity = scene.gravity;
  def.settings = settings;
  def.threads = 1;
  def.log = [this](LogLevel level, std::string_view message) {
    if (level >= LogLevel::warning) watch_.complain(std::string(message));
  };
  auto made = World::create(std::move(def));
  if (!made) {
    watch_.complain(made.error().text());
    return;
  }
  world_ = std::move(*made);
  for (const CaseBody& b : scene.bodies) {
    BodyDef def = definition_of(b, scene.collide);
    if (watch_.change) watch_.change(def);
    const auto id = world_->create_body(def);
    if (!id) watch_.complain(id.error().text());
    ids_.push_back(id ? *id : BodyId{});
  }
  for (const CaseJoint& j : scene.joints) {
    JointDef joint;
    joint.kind = JointKind::spherical;
    if (j.a >= 0) joint.a = ids_[size_t(j.a)];
    joint.b = ids_[size_t(j.b)];
    joint.frame_a.x = j.a < 0 ? j.x_world : scene.bodies[size_t(j.a)].pose.inverse_point(j.x_world);
    joint.frame_b.x = scene.bodies[size_t(j.b)].pose.inverse_point(j.x_world);
    if (const auto id = world_->create_joint(joint); !id) watch_.complain(id.error().text());
  }
  check(world_->apply_commands());
}

void TumbleCase::check(const Status& done) const {
  if (!done) watch_.complain(done.error().text());
}

void TumbleCase::step() {
  const auto done = world_->step();
  if (!done) watch_.complain(done.error().text());
  if (watch_.after_step) watch_.after_step(*world_);
}

CaseState TumbleCase::state(size_t body) {
  const RigidBody* b = world_->body(ids_[body]);
  return {b->pose, b->v, b->omega};
}

/// A wind so strong and so thin that what it blows at never feels its own speed.
void TumbleCase::set_force(size_t body, const Vec3& force) {
  WindDef wind;
  wind.targets.bodies = {ids_[body]};
  wind.grip.rate = 1e-13;
  wind.velocity = force / (wind.grip.rate * world_->body(ids_[body])->mass);
  const auto id = world_->create_force(wind);
  if (!id) watch_.complain(id.error().text());
}

void TumbleCase::set_gravity(const Vec3& gravity) {
  WorldSettings s = world_->settings();
  s.gravity = gravity;
  check(world_->set_settings(s));
}

CaseMaker tumble_maker(const WorldSettings& settings, TumbleCase::Watch watch) {
  return [settings, watch](const CaseScene& scene, int hz) {
    WorldSettings s = settings;
    s.tick = {hz, 1};
    return std::make_unique<TumbleCase>(scene, s, watch);
  };
}

}  // namespace tumble::test
