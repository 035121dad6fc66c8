#include "tests/bench/accuracy/peers.hpp"
#include "tests/bench/peer_values/ode.hpp"

#include <algorithm>
#include <cmath>

namespace tumble::test {
namespace {

class OdeCase final : public CaseWorld {
 public:
  OdeCase(const CaseScene& scene, int hz, bool exact)
      : scene_(scene), step_(1.0 / hz), exact_(exact), forces_(scene.bodies.size(), Vec3::Zero()) {
    start_ode();
    world_ = dWorldCreate();
    space_ = dSweepAndPruneSpaceCreate(nullptr, dSAP_AXES_XZY);
    contacts_ = dJointGroupCreate(0);
    set_gravity(scene.gravity);
    for (size_t i = 0; i < scene.bodies.size(); ++i) add(scene.bodies[i], i);
    for (const CaseJoint& j : scene.joints) {
      const dJointID ball = dJointCreateBall(world_, nullptr);
      dJointAttach(ball, j.a < 0 ? nullptr : bodies_[size_t(j.a)], bodies_[size_t(j.b)]);
      dJointSetBallAnchor(ball, j.x_world.x(), j.x_world.y(), j.x_world.z());
    }
  }
  ~OdeCase() override {
    dJointGroupDestroy(contacts_);
    dSpaceDestroy(space_);
    dWorldDestroy(world_);
  }
  void step() override {
    for (size_t i = 0; i < bodies_.size(); ++i)
      if (!forces_[i].isZero())
        dBodyAddForce(bodies_[i], forces_[i].x(), forces_[i].y(), forces_[i].z());
    if (scene_.collide) dSpaceCollide(space_, this, &OdeCase::meet);
    if (exact_)
      dWorldStep(world_, step_);
    else
      dWorldQuickStep(world_, step_);
    dJointGroupEmpty(contacts_);
  }
  CaseState state(size_t i) override {
    CaseState s;
    if (!bodies_[i]) {
      s.pose = scene_.bodies[i].pose;
      return s;
    }
    s.pose = {from_ode(dBodyGetPosition(bodies_[i])),
              quat_from_ode(dBodyGetQuaternion(bodies_[i]))};
    s.v = from_ode(dBodyGetLinearVel(bodies_[i]));
    s.omega = from_ode(dBodyGetAngularVel(bodies_[i]));
    return s;
  }
  void set_force(size_t body, const Vec3& force) override { forces_[body] = force; }
  void set_gravity(const Vec3& g) override { dWorldSetGravity(world_, g.x(), g.y(), g.z()); }

 private:
  void add(const CaseBody& b, size_t index) {
    const auto q = to_ode(b.pose.q);
    const Vec3& x = b.pose.x;
    dBodyID body = nullptr;
    if (!b.fixed) {
      body = dBodyCreate(world_);
      dMass m;
      dMassSetParameters(&m, b.mass, 0, 0, 0, b.inertia.x(), b.inertia.y(), b.inertia.z(), 0, 0, 0);
      dBodySetMass(body, &m);
      dBodySetPosition(body, x.x(), x.y(), x.z());
      dBodySetQuaternion(body, q.data());
      dBodySetLinearVel(body, b.v.x(), b.v.y(), b.v.z());
      dBodySetAngularVel(body, b.omega.x(), b.omega.y(), b.omega.z());
    }
    bodies_.push_back(body);
    const dGeomID shape = b.radius > 0
                              ? dCreateSphere(space_, b.radius)
                              : dCreateBox(space_, 2 * b.half.x(), 2 * b.half.y(), 2 * b.half.z());
    dGeomSetData(shape, reinterpret_cast<void*>(index));
    dGeomSetBody(shape, body);
    if (body) return;
    dGeomSetPosition(shape, x.x(), x.y(), x.z());
    dGeomSetQuaternion(shape, q.data());
  }
  static void meet(void* data, dGeomID a, dGeomID b) {
    auto& self = *static_cast<OdeCase*>(data);
    const dBodyID body_a = dGeomGetBody(a), body_b = dGeomGetBody(b);
    if (!body_a && !body_b) return;
    const CaseBody& of_a = self.scene_.bodies[reinterpret_cast<size_t>(dGeomGetData(a))];
    const CaseBody& of_b = self.scene_.bodies[reinterpret_cast<size_t>(dGeomGetData(b))];
    dContact found[8];
    const int count = dCollide(a, b, 8, &found[0].geom, sizeof(dContact));
    for (int i = 0; i < count; ++i) {
      dSurfaceParameters& s = found[i].surface;
      s.mode = dContactApprox1;
      s.mu = std::sqrt(of_a.friction * of_b.friction);
      s.bounce = std::max(of_a.restitution, of_b.restitution);
      if (s.bounce > 0) s.mode |= dContactBounce;
      s.bounce_vel = self.scene_.elastic ? 1e-3 : 1;
      dJointAttach(dJointCreateContact(self.world_, self.contacts_, &found[i]), body_a, body_b);
    }
  }

  CaseScene scene_;
  double step_;
  bool exact_;
  std::vector<Vec3> forces_;
  dWorldID world_;
  dSpaceID space_;
  dJointGroupID contacts_;
  std::vector<dBodyID> bodies_;
};

}  // namespace

CaseMaker ode_maker(bool exact) {
  return [exact](const CaseScene& scene, int hz) {
    return std::make_unique<OdeCase>(scene, hz, exact);
  };
}

}  // namespace tumble::test
