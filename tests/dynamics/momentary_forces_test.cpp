// Forces at one moment. References: their definitions; for the mouse spring, whose definition is
// its implicit step, the limit of that step as the tick goes to zero.
#include "engine/dynamics/forces/force.hpp"
#include "engine/math/rotation.hpp"
#include "tests/dynamics/rigid_world.hpp"

#include <cmath>

using namespace tumble;
using namespace tumble::test;

namespace {

/// Two boxes, turned and moving; a particle.
struct Pulled {
  BodySet set;
  HandlePool<ParticleSystemTag> particle_ids;
  std::vector<ParticleSystem> particles;
  std::vector<uint32_t> all{0, 1};

  Pulled() {
    for (int i = 0; i < 2; ++i) {
      BodyDef d = body(box(0.5, 0.2, 0.3), {3.0 * i, 1, -1.0 * i});
      d.pose.q = axis_angle(Vec3(1, 2, 3).normalized(), 0.7);
      d.velocity = {1, -2, 0.5 + i};
      d.angular_velocity = {0.3, 1, -2};
      auto made = make_body(d);
      REQUIRE(made.ok());
      set.ids.allocate();
      set.bodies.push_back(std::move(*made));
    }
    particle_ids.allocate();
    ParticleSystemDef system;
    system.particles.resize(1);
    system.particles[0].v = {1, 0, 0};
    particles.push_back(make_particle_system(system));
  }
  ForceContext context(double h, bool momentary) {
    for (RigidBody& b : set.bodies) b.force.setZero(), b.torque.setZero();
    return {set, particle_ids, particles, h, {0, -9.81, 0}, 0.5 * h, 0, momentary, all};
  }
  Anchor on(uint32_t slot, const Vec3& point) const {
    Anchor a;
    a.kind = Anchor::Kind::body;
    a.body = set.ids.at(slot);
    a.point = point;
    return a;
  }
};

}  // namespace

TEST_CASE("drag at one moment is what its definition says, on the bodies asked for only") {
  Pulled p;
  p.all = {1};
  ForceContext context = p.context(1.0 / 60, true);
  apply(LinearDragDef{300, 200}, context);
  const RigidBody& b = p.set.bodies[1];
  CHECK((b.force + 300 * b.mass * b.v).norm() < 1e-12 * b.force.norm());
  CHECK((b.torque + 200 * (b.inertia_world() * b.omega)).norm() < 1e-12 * b.torque.norm());
  CHECK(p.set.bodies[0].force.isZero(0));
  CHECK(p.particles[0].force[0].isZero(0));

  ForceContext again = p.context(1.0 / 60, true);
  QuadraticDragDef drag;
  drag.wind = {0, 0, 4};
  apply(drag, again);
  const Vec3 u = b.v - drag.wind.now();
  const double area = 3.14159265358979323846 * b.bounding_radius * b.bounding_radius;
  CHECK((b.force + 0.5 * 1.2 * 0.47 * area * u.norm() * u).norm() < 1e-12 * b.force.norm());
}

TEST_CASE("a flow is asked once about what cannot turn, whose force is the same") {
  Pulled p;
  p.all = {1};
  const ForceContext context = p.context(1.0 / 60, true);
  int asked = 0;
  const auto flow = [&](const Vec3& x) {
    ++asked;
    return Vec3(1 - x.z(), 2, 3 * x.x());
  };
  const RigidBody ball = p.set.bodies[1];
  RigidBody turns = ball, point = ball;
  point.inertia_body = point.inverse_inertia_body = Mat3::Zero();
  carry_along(flow, FlowGrip{2, 1.2}, context, turns);
  CHECK(asked == 7);  // and twice along each axis about how it turns
  CHECK_FALSE(turns.torque.isZero(0));
  asked = 0;
  carry_along(flow, FlowGrip{2, 1.2}, context, point);
  CHECK(asked == 1);
  CHECK(point.force == turns.force);
  CHECK(point.torque.isZero(0));
}

TEST_CASE("a spring at one moment pulls with k (l - l0) + c dl/dt at both its ends") {
  Pulled p;
  SpringDef spring;
  spring.a = p.on(0, {0.5, 0.2, 0.3});
  spring.b = p.on(1, {-0.5, 0.2, -0.3});
  spring.stiffness = 1e6;
  spring.damping = 40;
  ForceContext context = p.context(1.0 / 60, true);
  apply(spring, context);
  const RigidBody &a = p.set.bodies[0], &b = p.set.bodies[1];
  const Vec3 xa = a.pose.point(spring.a.point), xb = b.pose.point(spring.b.point);
  const Vec3 n = (xb - xa).normalized();
  const double tension =
      1e6 * ((xb - xa).norm() - 1) + 40 * n.dot(b.velocity_at(xb) - a.velocity_at(xa));
  CHECK((a.force - tension * n).norm() < 1e-12 * tension);
  CHECK((b.force + tension * n).norm() < 1e-12 * tension);
  CHECK((b.torque + (xb - b.pose.x).cross(tension * n)).norm() < 1e-12 * tension);
}

TEST_CASE("the mouse spring at one moment is the limit of its implicit step") {
  Pulled p;
  MouseSpringDef mouse;
  mouse.anchor = p.on(0, {0.5, 0.2, 0.3});
  mouse.target = {0.2, 1.4, 0.1};
  ForceContext context = p.context(1e-9, false);
  apply(mouse, context);
  const Vec3 force = p.set.bodies[0].force, torque = p.set.bodies[0].torque;
  ForceContext now = p.context(1.0 / 60, true);  // which is far above 4 Hz: no bound acts
  apply(mouse, now);
  CHECK((p.set.bodies[0].force - force).norm() < 1e-6 * force.norm());
  CHECK((p.set.bodies[0].torque - torque).norm() < 1e-6 * torque.norm());
}
