#include "engine/dynamics/event/event_system.hpp"
#include "engine/math/rotation.hpp"
#include "engine/world/world.hpp"
#include "tests/bench/chains/chain.hpp"

#include <numeric>
#include <stdexcept>

namespace tumble::bench {
namespace {

Vec3 vector(const Axis& v) {
  return {v[0], v[1], v[2]};
}

/// Equations of motion of a chain, and the same chain in a world for steps.
class TumbleChain final : public ChainPeer {
 public:
  explicit TumbleChain(const ChainScene& scene) : scene_(scene) {
    make_world();
    const auto n = size_t(scene.links);
    slots_.resize(n);
    held_.resize(joints_.size());
    std::iota(slots_.begin(), slots_.end(), 0u);
    std::iota(held_.begin(), held_.end(), 0u);
    system_ = std::make_unique<EventSystem>(bodies_, slots_, slots_, forces_, method_);
    system_->set_joints({joints_}, {held_});
    state_ = system_->read(0);
    rates_.resize(state_.size());
  }

  double evaluate() override {
    if (!system_->derivative(0, state_, rates_)) throw std::runtime_error("no accelerations");
    const auto a = system_->accelerations();
    double sum = 0;
    for (int i = 0; i < scene_.links; ++i) {
      const Vec3 before = i == 0 ? Vec3::Zero() : a[size_t(i - 1)].omega;
      const Vec3 own = a[size_t(i)].omega - before;
      const Vec3 axis = bodies_[size_t(i)].pose.q * vector(scene_.axis(i));
      sum += scene_.closed ? own.norm() : std::fabs(axis.dot(own));
    }
    return sum;
  }

  double step() override {
    const auto done = world_->step();
    if (!done) throw std::runtime_error(done.error().text());
    return world_->body(tip_)->pose.x.y();
  }

 private:
  void make_world() {
    WorldDef def;
    def.settings.stepper = "event";
    def.settings.tick = TickRate{1000, 1};
    def.threads = 1;
    world_ = std::move(*World::create(std::move(def)));
    Pose end;
    Vec3 end_v = Vec3::Zero(), omega = Vec3::Zero();
    BodyId before;
    for (int i = 0; i < scene_.links; ++i) {
      JointDef joint;
      joint.kind = scene_.closed ? JointKind::spherical : JointKind::revolute;
      joint.a = before;
      const Quat hinge = rotation_between(Vec3::UnitZ(), vector(scene_.axis(i)).normalized());
      joint.frame_a = {before.is_null() ? Vec3::Zero() : Vec3(rod_length / 2, 0, 0), hinge};
      joint.frame_b = {Vec3(-rod_length / 2, 0, 0), hinge};
      end.q = end.q * axis_angle(vector(scene_.axis(i)), scene_.angle(i));
      omega += end.q * (scene_.rate(i) * vector(scene_.axis(i)));
      const Vec3 half = end.q * Vec3(rod_length / 2, 0, 0);
      BodyDef rod;
      rod.mass = rod_mass;
      rod.inertia = vector(ChainScene::inertia());
      rod.pose = {end.x + half, end.q};
      rod.velocity = end_v + omega.cross(half);
      rod.angular_velocity = omega;
      end.x += 2 * half;
      end_v += omega.cross(2 * half);
      bodies_.push_back(*make_body(rod));
      tip_ = before = *world_->create_body(rod);
      joint.b = before;
      add(joint);
    }
    if (!scene_.closed) return;
    JointDef last;
    last.kind = JointKind::spherical;
    last.b = before;
    last.frame_b.x = {rod_length / 2, 0, 0};
    add(last);
  }
  void add(const JointDef& def) {
    (void)*world_->create_joint(def);
    Joint j;
    j.kind = def.kind;
    j.a = def.a.is_null() ? no_body : def.a.index;
    j.b = def.b.index;
    j.frame_a = def.frame_a;
    j.frame_b = def.frame_b;
    joints_.push_back(j);
  }

  ChainScene scene_;
  std::unique_ptr<World> world_;
  BodyId tip_;
  std::vector<RigidBody> bodies_;
  std::vector<Joint> joints_;
  std::vector<uint32_t> slots_, held_;
  ContactForceMethod method_;
  SmoothForces forces_ = [this](double, std::span<const uint32_t> slots) {
    for (const uint32_t s : slots) {
      bodies_[s].force = {0, -rod_mass * gravity, 0};
      bodies_[s].torque.setZero();
    }
  };
  std::unique_ptr<EventSystem> system_;
  std::vector<double> state_, rates_;
};

}  // namespace

std::unique_ptr<ChainPeer> tumble_chain(const ChainScene& scene) {
  return std::make_unique<TumbleChain>(scene);
}

}  // namespace tumble::bench
