#pragma once
// A world of rigid bodies under the event stepper, with gravity only.
#include "engine/dynamics/event/event_stepper.hpp"
#include "tests/dynamics/joints_by_hand.hpp"
#include "tests/dynamics/rigid_world.hpp"
#include "tests/support/why_not.hpp"

#include <functional>
#include <optional>

namespace tumble::test {

class EventWorld : public BodyList {
 public:
  explicit EventWorld(double hz = 60, int threads = 1) : h(1 / hz), crew(threads) {}

  void step() {
    EventContext context;
    context.settings = settings;
    context.gravity = gravity.norm();
    const SmoothForces forces = [this](double, std::span<const uint32_t> slots) {
      for (const uint32_t s : slots) {
        RigidBody& b = bodies[s];
        b.force = b.mass * b.gravity_scale * gravity;
        b.torque.setZero();
        if (extra_force) extra_force(s, b);
      }
    };
    context.joints = joints;
    context.time_stepping = time_stepping;
    context.spring_rates = spring_rates;
    context.couplings = couplings;
    if (max_untied_bodies) context.max_untied_bodies = *max_untied_bodies;
    std::vector<BodyLink> links;
    for (uint32_t i = 0; i < joints.size(); ++i) {
      links.push_back({joints[i].a, joints[i].b, i});
      if (joints[i].a != no_body && !joints[i].collide) context.apart.add(joints[i].a, joints[i].b);
    }
    for (const JointCoupling& c : couplings) links.push_back({joints[c.a].b, joints[c.b].b});
    context.apart.sort();
    const Status done = stepper.step(bodies, *broad, links, forces, context, h, crew);
    REQUIRE_MESSAGE(done.ok(), test::why_not(done));
    deepest = std::max(deepest, stepper.stats.deepest);
    windows += stepper.stats.windows;
    events += stepper.stats.events;
    ++ticks;
  }
  void run(double seconds) {
    const int n = int(seconds / h + 0.5);
    for (int i = 0; i < n; ++i) step();
  }
  /// A joint at a frame in the world (z: main axis) between slots; no_body for the world.
  Joint& join(JointKind kind, uint32_t a, uint32_t b, const Pose& at, bool collide = false) {
    return joints.emplace_back(joint_at(kind, bodies, a, b, at, collide));
  }
  /// Greatest error of a joint's rows now [m, rad].
  double joint_error() const { return worst_error(joints, bodies); }
  double energy() const {
    double e = 0;
    for (const RigidBody& b : bodies)
      if (b.dynamic()) e += b.kinetic_energy() - b.mass * b.gravity_scale * gravity.dot(b.pose.x);
    return e;
  }
  Vec3 momentum() const {
    Vec3 p = Vec3::Zero();
    for (const RigidBody& b : bodies) p += b.mass * b.v;
    return p;
  }

  double h;
  Vec3 gravity{0, -9.81, 0};
  std::vector<Joint> joints;
  std::vector<JointCoupling> couplings;
  EventSettings settings;
  std::function<void(uint32_t, RigidBody&)> extra_force;
  std::optional<size_t> max_untied_bodies;  ///< of EventContext, where it is not as usual
  TimeStepping* time_stepping = nullptr;    ///< none: groups that need it are errors
  std::span<const double> spring_rates;     ///< of EventContext
  EventStepper stepper;
  std::unique_ptr<BroadPhase> broad = all_broad_phases().front().make();
  Crew crew;
  double deepest = 0;
  int ticks = 0;
  uint64_t windows = 0;  ///< in which clusters moved by themselves
  uint64_t events = 0;
};

}  // namespace tumble::test
