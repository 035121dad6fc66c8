#include "engine/collision/shapes/convex_hull.hpp"
#include "tests/bench/peer_values/bullet.hpp"
#include "tests/bench/workloads/peers.hpp"

#include <cmath>
#include <map>

#include <BulletCollision/Gimpact/btGImpactCollisionAlgorithm.h>
#include <BulletCollision/Gimpact/btGImpactShape.h>
#include <btBulletDynamicsCommon.h>

namespace tumble::test {
namespace {

/// Bodies of one group, by Bullet's user index, do not collide.
struct GroupFilter final : btOverlapFilterCallback {
  bool needBroadphaseCollision(btBroadphaseProxy* a, btBroadphaseProxy* b) const override {
    if (!(a->m_collisionFilterGroup & b->m_collisionFilterMask) ||
        !(b->m_collisionFilterGroup & a->m_collisionFilterMask))
      return false;
    const auto group = [](btBroadphaseProxy* p) {
      return static_cast<btCollisionObject*>(p->m_clientObject)->getUserIndex();
    };
    return group(a) == 0 || group(a) != group(b);
  }
};

/// Bullet's shapes of ours; equal ones are one.
class BulletShapes {
 public:
  btCollisionShape* of(const RigidBody& body) {
    const BodyShape& first = body.shapes.front();
    const bool plain = body.shapes.size() == 1 && first.pose.x.isZero(1e-12) &&
                       std::abs(first.pose.q.w()) > 1 - 1e-12;
    if (plain) return single(*first.shape, body.dynamic());
    auto compound = std::make_unique<btCompoundShape>(true, int(body.shapes.size()));
    for (const BodyShape& s : body.shapes)
      compound->addChildShape(to_bullet(s.pose), single(*s.shape, body.dynamic()));
    return keep(std::move(compound));
  }

 private:
  btCollisionShape* keep(std::unique_ptr<btCollisionShape> shape) {
    all_.push_back(std::move(shape));
    return all_.back().get();
  }
  /// Hulls and meshes are shared by what they were made from.
  btCollisionShape* single(const Shape& shape, bool moves) {
    const ShapeDef& def = shape.def();
    const auto r = btScalar(def.radius);
    if (def.type == ShapeType::sphere) return keep(std::make_unique<btSphereShape>(r));
    if (def.type == ShapeType::box)
      return keep(std::make_unique<btBoxShape>(to_bullet(def.half_extents)));
    if (def.type == ShapeType::capsule)
      return keep(std::make_unique<btCapsuleShape>(r, btScalar(def.height)));
    btCollisionShape*& known = shared_[def.mesh.get()];
    if (!known) known = def.type == ShapeType::convex_hull ? hull(shape) : mesh(*def.mesh, moves);
    return known;
  }
  btCollisionShape* hull(const Shape& shape) {
    auto out = std::make_unique<btConvexHullShape>();
    for (const Vec3& v : dynamic_cast<const ConvexHullShape&>(shape).polyhedron().vertices)
      out->addPoint(to_bullet(v), false);
    out->recalcLocalAabb();
    return keep(std::move(out));
  }
  btCollisionShape* mesh(const TriangleMesh& mesh, bool moves) {
    auto triangles = std::make_unique<btTriangleMesh>(true, false);
    for (const Vec3& v : mesh.vertices) triangles->findOrAddVertex(to_bullet(v), false);
    for (const Triangle& t : mesh.triangles)
      triangles->addTriangleIndices(int(t[0]), int(t[1]), int(t[2]));
    meshes_.push_back(std::move(triangles));
    if (!moves) return keep(std::make_unique<btBvhTriangleMeshShape>(meshes_.back().get(), true));
    auto out = std::make_unique<btGImpactMeshShape>(meshes_.back().get());
    out->updateBound();
    return keep(std::move(out));
  }

  std::vector<std::unique_ptr<btTriangleMesh>> meshes_;
  std::vector<std::unique_ptr<btCollisionShape>> all_;
  std::map<const TriangleMesh*, btCollisionShape*> shared_;
};

class BulletWorkload final : public WorkloadPeer {
 public:
  explicit BulletWorkload(const PeerScene& scene)
      : dispatcher_(&configuration_),
        world_(&dispatcher_, &broad_phase_, &solver_, &configuration_) {
    world_.setGravity(btVector3(0, btScalar(-9.81), 0));
    btGImpactCollisionAlgorithm::registerAlgorithm(&dispatcher_);
    world_.getPairCache()->setOverlapFilterCallback(&filter_);
    for (const RigidBody& b : scene.bodies) add(b);
    for (const WorkloadJoint& j : scene.workload.joints) add(j, scene.bodies);
  }
  ~BulletWorkload() override {
    for (auto& j : joints_) world_.removeConstraint(j.get());
    for (auto& b : bodies_) world_.removeRigidBody(b.get());
  }
  void step() override {
    for (const auto& [body, turn] : turning_) {
      btTransform t = body->getWorldTransform();
      t.setRotation(turn * t.getRotation());
      body->setWorldTransform(t);  // from which it takes the velocity
    }
    world_.stepSimulation(btScalar(PeerScene::step), 0);
  }
  void read(std::span<RigidBody> bodies) override {
    for (size_t i = 0; i < bodies.size(); ++i) {
      bodies[i].pose = from_bullet(bodies_[i]->getWorldTransform());
      bodies[i].v = from_bullet(bodies_[i]->getLinearVelocity());
      bodies[i].omega = from_bullet(bodies_[i]->getAngularVelocity());
    }
  }
  size_t contact_points() const override {
    int n = 0;
    for (int i = 0; i < dispatcher_.getNumManifolds(); ++i)
      n += const_cast<btCollisionDispatcher&>(dispatcher_)
               .getManifoldByIndexInternal(i)
               ->getNumContacts();
    return size_t(n);
  }

 private:
  void add(const RigidBody& b) {
    const bool moves = b.dynamic();
    btRigidBody::btRigidBodyConstructionInfo info(
        btScalar(moves ? b.mass : 0), nullptr, shapes_.of(b),
        to_bullet(moves ? Vec3(b.inertia_body.diagonal()) : Vec3(0, 0, 0)));
    info.m_startWorldTransform = to_bullet(b.pose);
    info.m_friction = btScalar(std::sqrt(b.shapes.front().material.friction));  // multiplied
    bodies_.push_back(std::make_unique<btRigidBody>(info));
    btRigidBody& body = *bodies_.back();
    body.setUserIndex(int(b.group));
    body.setActivationState(DISABLE_DEACTIVATION);
    if (b.type == BodyType::kinematic) {
      body.setCollisionFlags(body.getCollisionFlags() | btCollisionObject::CF_KINEMATIC_OBJECT);
      const btScalar angle = btScalar(b.omega.norm() * PeerScene::step);
      turning_.push_back({&body, btQuaternion(to_bullet(b.omega.normalized()), angle)});
    }
    world_.addRigidBody(&body, moves ? 1 : 2, moves ? 3 : 1);
  }
  void add(const WorkloadJoint& j, std::span<const RigidBody> bodies) {
    btRigidBody &a = *bodies_[j.a], &b = *bodies_[j.b];
    const auto point = [&](size_t i) { return to_bullet(bodies[i].pose.inverse_point(j.frame.x)); };
    const auto axis = [&](size_t i) {
      return to_bullet(bodies[i].pose.inverse_direction(j.frame.direction(Vec3::UnitZ())));
    };
    if (j.kind == JointKind::spherical)
      joints_.push_back(std::make_unique<btPoint2PointConstraint>(a, b, point(j.a), point(j.b)));
    else
      joints_.push_back(
          std::make_unique<btHingeConstraint>(a, b, point(j.a), point(j.b), axis(j.a), axis(j.b)));
    world_.addConstraint(joints_.back().get(), true);
  }

  BulletShapes shapes_;
  GroupFilter filter_;
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_;
  btDbvtBroadphase broad_phase_;
  btSequentialImpulseConstraintSolver solver_;
  btDiscreteDynamicsWorld world_;
  std::vector<std::unique_ptr<btRigidBody>> bodies_;
  std::vector<std::unique_ptr<btTypedConstraint>> joints_;
  std::vector<std::pair<btRigidBody*, btQuaternion>> turning_;  ///< kinematic; by how much a step
};

}  // namespace

std::unique_ptr<WorkloadPeer> bullet_workload(const PeerScene& scene) {
  return std::make_unique<BulletWorkload>(scene);
}

}  // namespace tumble::test
