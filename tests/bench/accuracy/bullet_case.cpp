#include "tests/bench/accuracy/peers.hpp"
#include "tests/bench/peer_values/bullet.hpp"

#include <cmath>

#include <btBulletDynamicsCommon.h>

namespace tumble::test {
namespace {

class BulletCase final : public CaseWorld {
 public:
  BulletCase(const CaseScene& scene, int hz)
      : dispatcher_(&configuration_),
        world_(&dispatcher_, &broad_phase_, &solver_, &configuration_),
        step_(btScalar(1.0 / hz)),
        forces_(scene.bodies.size(), btVector3(0, 0, 0)) {
    world_.setGravity(to_bullet(scene.gravity));
    if (scene.elastic) world_.getSolverInfo().m_restitutionVelocityThreshold = btScalar(1e-3);
    for (const CaseBody& b : scene.bodies) add(b, scene.collide);
    for (const CaseJoint& j : scene.joints) add(j, scene);
  }
  ~BulletCase() override {
    for (auto& j : joints_) world_.removeConstraint(j.get());
    for (auto& b : bodies_) world_.removeRigidBody(b.get());
  }
  void step() override {
    for (size_t i = 0; i < bodies_.size(); ++i) bodies_[i]->applyCentralForce(forces_[i]);
    world_.stepSimulation(step_, 0);
  }
  CaseState state(size_t i) override {
    CaseState s;
    s.pose = from_bullet(bodies_[i]->getWorldTransform());
    s.v = from_bullet(bodies_[i]->getLinearVelocity());
    s.omega = from_bullet(bodies_[i]->getAngularVelocity());
    return s;
  }
  void set_force(size_t body, const Vec3& force) override { forces_[body] = to_bullet(force); }
  void set_gravity(const Vec3& gravity) override {
    world_.setGravity(to_bullet(gravity));
    for (auto& b : bodies_)
      if (!b->isStaticObject()) b->setGravity(to_bullet(gravity));
  }

 private:
  void add(const CaseBody& b, bool collide) {
    if (b.radius > 0)
      shapes_.push_back(std::make_unique<btSphereShape>(btScalar(b.radius)));
    else
      shapes_.push_back(std::make_unique<btBoxShape>(to_bullet(b.half)));
    btRigidBody::btRigidBodyConstructionInfo info(
        b.fixed ? 0 : btScalar(b.mass), nullptr, shapes_.back().get(),
        b.fixed ? btVector3(0, 0, 0) : to_bullet(b.inertia));
    info.m_startWorldTransform = to_bullet(b.pose);
    info.m_friction = btScalar(std::sqrt(b.friction));  // it multiplies the two
    info.m_restitution = btScalar(b.restitution);
    bodies_.push_back(std::make_unique<btRigidBody>(info));
    bodies_.back()->setLinearVelocity(to_bullet(b.v));
    bodies_.back()->setAngularVelocity(to_bullet(b.omega));
    bodies_.back()->setActivationState(DISABLE_DEACTIVATION);
    world_.addRigidBody(bodies_.back().get(), 1, collide ? 1 : 0);
  }
  void add(const CaseJoint& j, const CaseScene& scene) {
    const auto local = [&](int i) {
      return to_bullet(i < 0 ? j.x_world : scene.bodies[size_t(i)].pose.inverse_point(j.x_world));
    };
    btRigidBody& a = j.a < 0 ? btTypedConstraint::getFixedBody() : *bodies_[size_t(j.a)];
    joints_.push_back(std::make_unique<btPoint2PointConstraint>(a, *bodies_[size_t(j.b)],
                                                                local(j.a), local(j.b)));
    world_.addConstraint(joints_.back().get(), true);
  }

  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_;
  btDbvtBroadphase broad_phase_;
  btSequentialImpulseConstraintSolver solver_;
  btDiscreteDynamicsWorld world_;
  btScalar step_;
  std::vector<std::unique_ptr<btCollisionShape>> shapes_;
  std::vector<std::unique_ptr<btRigidBody>> bodies_;
  std::vector<std::unique_ptr<btPoint2PointConstraint>> joints_;
  std::vector<btVector3> forces_;
};

}  // namespace

CaseMaker bullet_maker() {
  return [](const CaseScene& scene, int hz) { return std::make_unique<BulletCase>(scene, hz); };
}

}  // namespace tumble::test
