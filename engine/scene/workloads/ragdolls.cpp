#include "engine/math/rotation.hpp"
#include "engine/scene/workloads/definitions.hpp"
#include "engine/scene/workloads/draws.hpp"
#include "engine/scene/workloads/parts.hpp"

namespace tumble {
namespace {

/// Parts of a ragdoll in the order of its bodies; a limb's lower part follows its upper one.
enum RagdollPart : size_t {
  pelvis,
  torso,
  head,
  right_arm,
  left_arm = 5,
  right_leg = 7,
  left_leg = 9
};

/// A ragdoll in a T pose in its own frame, whose origin is the centre of the pelvis.
class RagdollMaker {
 public:
  RagdollMaker(Workload& w, const Pose& pose, uint32_t group)
      : w_(w), pose_(pose), first_(w.bodies.size()), group_(group) {}

  void make() {
    add(box_body(Vec3::Zero(), {0.15, 0.10, 0.10}));
    add(box_body({0, 0.32, 0}, {0.18, 0.20, 0.10}));
    add(sphere_body({0, 0.68, 0}, 0.13));
    for (const double side : {1.0, -1.0}) {
      add(arm(0.36 * side, 0.06));
      add(arm(0.70 * side, 0.05));
    }
    for (const double side : {1.0, -1.0}) {
      add(capsule_body({0.10 * side, -0.32, 0}, 0.08, 0.16));
      add(capsule_body({0.10 * side, -0.76, 0}, 0.07, 0.16));
    }
    ball(pelvis, torso, {0, 0.11, 0});
    ball(torso, head, {0, 0.54, 0});
    const Quat z_to_y = axis_angle(Vec3::UnitX(), -0.5 * det::pi);
    const Quat z_to_x = axis_angle(Vec3::UnitY(), 0.5 * det::pi);
    for (const auto& [upper, side] : {std::pair{right_arm, 1.0}, {left_arm, -1.0}}) {
      ball(torso, upper, {0.18 * side, 0.44, 0});
      hinge(upper, {0.54 * side, 0.44, 0}, z_to_y);
    }
    for (const auto& [upper, side] : {std::pair{right_leg, 1.0}, {left_leg, -1.0}}) {
      ball(pelvis, upper, {0.10 * side, -0.10, 0});
      hinge(upper, {0.10 * side, -0.54, 0}, z_to_x);
    }
  }

 private:
  static BodyDef arm(double x, double radius) {
    BodyDef def = capsule_body({x, 0.44, 0}, radius, 0.12);
    def.pose.q = axis_angle(Vec3::UnitZ(), 0.5 * det::pi);
    return def;
  }
  void add(BodyDef def) {
    def.pose = pose_ * def.pose;
    def.group = group_;
    w_.bodies.push_back(std::move(def));
  }
  void join(JointKind kind, size_t a, size_t b, const Pose& frame) {
    w_.joints.push_back({kind, first_ + a, first_ + b, pose_ * frame});
  }
  void ball(size_t a, size_t b, const Vec3& x) {
    join(JointKind::spherical, a, b, {x, Quat::Identity()});
  }
  /// An elbow or a knee, between the upper part and the one after it.
  void hinge(size_t upper, const Vec3& x, const Quat& axis_frame) {
    join(JointKind::revolute, upper, upper + 1, {x, axis_frame});
  }

  Workload& w_;
  Pose pose_;
  size_t first_;
  uint32_t group_;
};

}  // namespace

/// W6: ragdolls of two boxes, a ball and eight capsules, six ball joints and four hinges each.
/// Parts of one do not collide with each other.
Workload ragdolls_workload(bool small) {
  const int side = small ? 2 : 5, count = small ? 12 : 100;
  const double middle = (side - 1) / 2.0;
  Workload w;
  w.steps = 600;
  add_bin(w, 1.1 * side, 30);
  WorkloadDraws draws(4242);
  for (int i = 0; i < count; ++i) {
    const int layer = i / (side * side), place = i % (side * side);
    const Vec3 x((place % side - middle) * 2.1, 1.5 + 2.2 * layer, (place / side - middle) * 2.1);
    RagdollMaker(w, {x, draws.orientation()}, uint32_t(i) + 1).make();
  }
  return w;
}

}  // namespace tumble
