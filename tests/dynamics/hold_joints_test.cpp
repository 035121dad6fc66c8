// Joints as equations of accelerations, velocities and positions. References: the energy of the
// double pendulum (peers keep it to 8e-6 of its range at best) and the order of RK4; the force in a
// rod by statics and by centripetal acceleration; redundant joints against the same without them.
#include "engine/dynamics/bodies/free_motion.hpp"
#include "engine/dynamics/joints/articulation.hpp"
#include "engine/math/ode/integrator.hpp"
#include "engine/math/rotation.hpp"
#include "tests/dynamics/joint_world.hpp"

#include <cmath>
#include <numeric>

using namespace tumble;
using namespace tumble::test;

namespace {

constexpr double g = 9.81;

/// Bodies that only joints and gravity move, integrated by RK4 and projected after every step.
struct HeldBodies : BodyList {
  std::vector<Joint> joints;
  std::vector<uint32_t> slots;
  Articulation held;
  std::vector<double> pushes;

  void join(JointKind kind, uint32_t a, uint32_t b, const Pose& at) {
    joints.push_back(test::joint_at(kind, bodies, a, b, at));
  }
  /// Forces and torques of joints and gravity at the states.
  bool act(MotionForces& forces) {
    std::vector<DofBlock> blocks(bodies.size());
    for (size_t i = 0; i < bodies.size(); ++i) {
      RigidBody& b = bodies[i];
      b.pose = forces.bodies[i].pose;
      b.v = forces.bodies[i].v;
      b.omega = forces.bodies[i].omega;
      blocks[i].inverse_mass = b.inverse_mass;
      blocks[i].inverse_inertia = b.inverse_inertia_world();
      blocks[i].v = {0, -g, 0};
      blocks[i].omega = -blocks[i].inverse_inertia * b.omega.cross(b.inertia_world() * b.omega);
    }
    held.update(bodies, blocks);
    held.hold_accelerations(blocks, pushes);
    for (size_t i = 0; i < bodies.size(); ++i) {
      const Mat3 I = bodies[i].inertia_world();
      const Vec3& w = bodies[i].omega;
      forces.wrenches[i].force = bodies[i].mass * blocks[i].v;
      forces.wrenches[i].torque = I * blocks[i].omega + w.cross(I * w);
    }
    return true;
  }
  void run(double hz, double seconds) {
    std::vector<MotionConstants> constants;
    slots.clear();
    std::vector<uint32_t> which(joints.size());
    std::iota(which.begin(), which.end(), 0u);
    for (uint32_t i = 0; i < bodies.size(); ++i) {
      constants.push_back(MotionConstants::of(bodies[i]));
      slots.push_back(i);
    }
    held = Articulation({joints}, {which}, slots, bodies, bodies.size());
    pushes.resize(held.size());
    auto system = FreeMotion::make(constants, [this](MotionForces& f) { return act(f); });
    REQUIRE(system.ok());
    std::unique_ptr<ode::Integrator> rk4;
    for (const ode::IntegratorEntry& e : ode::all_integrators())
      if (e.name == "rk4") rk4 = e.make();
    std::vector<double> y(system->size());
    const int steps = int(seconds * hz + 0.5);
    for (int i = 0; i < steps; ++i) {
      for (uint32_t k = 0; k < bodies.size(); ++k)
        system->write(k, bodies[k].pose, bodies[k].v, bodies[k].omega, y);
      REQUIRE(rk4->advance(*system, i / hz, 1 / hz, y).ok());
      for (uint32_t k = 0; k < bodies.size(); ++k) {
        const MotionState s = system->read(k, y);
        bodies[k].pose = s.pose;
        bodies[k].v = s.v;
        bodies[k].omega = s.omega;
      }
      close_joints();
      gap = std::max(gap, held.error());
      std::vector<DofBlock> moving = blocks_of(bodies, slots);
      held.hold_velocities(moving, pushes);
      for (size_t k = 0; k < bodies.size(); ++k) {
        bodies[k].v = moving[k].v;
        bodies[k].omega = moving[k].omega;
      }
      worst = std::max(worst, std::fabs(energy() - start));
    }
  }
  /// Newton's method on the positions.
  void close_joints() {
    for (int k = 0; k < 4; ++k) {
      std::vector<DofBlock> moves = blocks_of(bodies, slots);
      held.update(bodies, moves);
      for (DofBlock& b : moves) b.v.setZero(), b.omega.setZero();
      held.close(moves, pushes);
      for (size_t i = 0; i < bodies.size(); ++i) {
        bodies[i].pose.x += moves[i].v;
        bodies[i].pose.q = integrate_rotation(bodies[i].pose.q, moves[i].omega, 1);
      }
    }
    held.update(bodies, blocks_of(bodies, slots));
  }
  double energy() const {
    double e = 0;
    for (const RigidBody& b : bodies) e += b.kinetic_energy() + b.mass * g * b.pose.x.y();
    return e;
  }

  double start = 0, worst = 0, gap = 0;
};

/// The rods of the published comparison, released horizontally.
HeldBodies double_pendulum(JointKind kind) {
  HeldBodies w;
  for (const double x : {0.5, 1.5}) {
    BodyDef d = body(box(0.5, 0.05, 0.05), {x, 0, 0});
    d.mass = 1;
    w.add(d);
  }
  w.join(kind, no_body, 0, {});
  w.join(kind, 0, 1, {{1, 0, 0}, Quat::Identity()});
  w.start = w.energy();
  return w;
}

double energy_error(double hz, double seconds) {
  HeldBodies w = double_pendulum(JointKind::spherical);
  w.run(hz, seconds);
  CHECK(w.gap < 1e-12);
  return w.worst / 19.62;
}

}  // namespace

TEST_CASE("a double pendulum by RK4 and projection keeps its energy for a minute" *
          doctest::test_suite("long")) {
  const double coarse = energy_error(240, 60);
  MESSAGE("energy error at 1/240: " << coarse);
  CHECK(coarse < 2e-5);
  const double fine = energy_error(480, 60);
  MESSAGE("energy error at 1/480: " << fine);
  CHECK(fine < 1e-6);
}

TEST_CASE("the double pendulum's motion converges with the fourth order") {
  const auto end = [](double hz) {
    HeldBodies w = double_pendulum(JointKind::revolute);
    w.run(hz, 2);
    return w.bodies[1].pose.x;
  };
  const Vec3 coarse = end(480), middle = end(960), fine = end(1920);
  const double order = std::log2((coarse - middle).norm() / (middle - fine).norm());
  MESSAGE("order " << order);
  CHECK(order > 3.7);
  CHECK(order < 4.4);
}

TEST_CASE("redundant joints change nothing") {
  HeldBodies one = double_pendulum(JointKind::revolute), many = one;
  many.joints.insert(many.joints.end(), one.joints.begin(), one.joints.end());
  many.join(JointKind::spherical, 0, 1, {{1, 0, 0.3}, Quat::Identity()});
  one.run(240, 1);
  many.run(240, 1);
  CHECK((one.bodies[1].pose.x - many.bodies[1].pose.x).norm() < 1e-9);
}
