#include "engine/dynamics/event/event_system.hpp"
#include "engine/math/dense.hpp"
#include "engine/math/rotation.hpp"
#include "engine/world/world.hpp"
#include "tests/bench/trees/tree.hpp"

#include <cmath>
#include <numeric>
#include <stdexcept>

namespace tumble::bench {
namespace {

Pose pose(const Eigen::Isometry3d& t) {
  return {small_vector(t.translation()), Quat(small_matrix(t.linear()))};
}

/// Equations of motion of a tree, and the same tree in a world for steps.
class TumbleTree final : public TreePeer {
 public:
  explicit TumbleTree(const TreeScene& scene) : scene_(scene) {
    make_world();
    slots_.resize(bodies_.size());
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
    for (size_t i = 0; i < scene_.links.size(); ++i) {
      const TreeLink& link = scene_.links[i];
      if (link.free) continue;
      const Vec3 before = link.parent < 0 ? Vec3::Zero() : a[size_t(link.parent)].omega;
      const Vec3 axis = bodies_[i].pose.q * small_vector(link.axis);
      sum += std::fabs(axis.dot(a[i].omega - before));
    }
    return sum;
  }

  double step() override {
    const auto done = world_->step();
    if (!done) throw std::runtime_error(done.error().text());
    return scene_.height(dense(world_->body(tip_)->pose.x));
  }

 private:
  /// Where a link is, and how it moves.
  struct Place {
    Eigen::Isometry3d frame = Eigen::Isometry3d::Identity();
    Vec3 v = Vec3::Zero(), omega = Vec3::Zero();  ///< of its origin
    BodyId id;
  };

  void make_world() {
    WorldDef def;
    def.settings.stepper = "event";
    def.settings.tick = TickRate{uint32_t(std::lround(1 / scene_.step)), 1};
    def.settings.gravity = small_vector(scene_.gravity);
    def.threads = 1;
    world_ = std::move(*World::create(std::move(def)));
    std::vector<Place> places;
    for (const TreeLink& link : scene_.links) {
      const Place parent = link.parent < 0 ? Place{} : places[size_t(link.parent)];
      Place& now = places.emplace_back();
      now.frame = parent.frame * link.moved();
      const Vec3 arm = small_vector(now.frame.translation() - parent.frame.translation());
      now.v = parent.v + parent.omega.cross(arm);
      now.omega = parent.omega + small_vector(now.frame.linear() * (link.rate * link.axis));
      now.id = add_body(link, now);
      if (!link.free) add_hinge(link, parent.id, now.id);
    }
    tip_ = places.back().id;
  }
  /// Bodies have their origins in their centres of mass.
  BodyId add_body(const TreeLink& link, const Place& at) {
    const Mat3 m = small_matrix(link.inertia);
    BodyDef body;
    body.mass = link.mass;
    body.inertia = m.diagonal();
    body.products = Vec3(m(0, 1), m(0, 2), m(1, 2));
    const Vec3 arm = small_vector(at.frame.linear() * link.centre);
    body.pose = pose(at.frame);
    body.pose.x += arm;
    body.velocity = at.v + at.omega.cross(arm);
    body.angular_velocity = at.omega;
    bodies_.push_back(*make_body(body));
    return *world_->create_body(body);
  }
  void add_hinge(const TreeLink& link, BodyId parent, BodyId child) {
    const Quat hinge = rotation_between(Vec3::UnitZ(), small_vector(link.axis).normalized());
    const Vec3 centre =
        link.parent < 0 ? Vec3::Zero() : small_vector(scene_.links[size_t(link.parent)].centre);
    JointDef joint;
    joint.kind = JointKind::revolute;
    joint.a = parent;
    joint.b = child;
    const Pose before = pose(link.in_parent);
    joint.frame_a = {before.x - centre, before.q * hinge};
    joint.frame_b = {-small_vector(link.centre), hinge};
    (void)*world_->create_joint(joint);
    Joint& j = joints_.emplace_back();
    j.kind = joint.kind;
    j.a = link.parent < 0 ? no_body : uint32_t(link.parent);
    j.b = uint32_t(bodies_.size() - 1);
    j.frame_a = joint.frame_a;
    j.frame_b = joint.frame_b;
  }

  TreeScene scene_;
  std::unique_ptr<World> world_;
  BodyId tip_;
  std::vector<RigidBody> bodies_;
  std::vector<Joint> joints_;
  std::vector<uint32_t> slots_, held_;
  ContactForceMethod method_;
  SmoothForces forces_ = [this](double, std::span<const uint32_t> slots) {
    for (const uint32_t s : slots) {
      bodies_[s].force = bodies_[s].mass * small_vector(scene_.gravity);
      bodies_[s].torque.setZero();
    }
  };
  std::unique_ptr<EventSystem> system_;
  std::vector<double> state_, rates_;
};

}  // namespace

std::unique_ptr<TreePeer> tumble_tree(const TreeScene& scene) {
  return std::make_unique<TumbleTree>(scene);
}

}  // namespace tumble::bench
