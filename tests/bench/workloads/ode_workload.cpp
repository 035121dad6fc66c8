#include "engine/collision/shapes/convex_hull.hpp"
#include "engine/math/rotation.hpp"
#include "tests/bench/peer_values/ode.hpp"
#include "tests/bench/workloads/peers.hpp"

#include <cmath>
#include <map>

namespace tumble::test {
namespace {

/// The arrays of a hull, which ODE does not copy.
struct OdeHull {
  std::vector<dReal> planes, points;
  std::vector<unsigned> polygons;

  explicit OdeHull(const ConvexPolyhedron& hull) {
    for (const Vec3& v : hull.vertices) points.insert(points.end(), v.data(), v.data() + 3);
    for (size_t f = 0; f < hull.face_count(); ++f) {
      const Vec3& n = hull.planes[f].normal;
      planes.insert(planes.end(), n.data(), n.data() + 3);
      planes.push_back(n.dot(hull.vertices[hull.face(f)[0]]));
      polygons.push_back(unsigned(hull.face(f).size()));
      polygons.insert(polygons.end(), hull.face(f).begin(), hull.face(f).end());
    }
  }
};

/// The same of a mesh.
struct OdeMesh {
  std::vector<float> points;
  std::vector<dTriIndex> corners;
  dTriMeshDataID data = dGeomTriMeshDataCreate();

  explicit OdeMesh(const TriangleMesh& mesh) {
    for (const Vec3& v : mesh.vertices)
      for (int k = 0; k < 3; ++k) points.push_back(float(v[k]));
    for (const Triangle& t : mesh.triangles) corners.insert(corners.end(), t.begin(), t.end());
    dGeomTriMeshDataBuildSingle(data, points.data(), 3 * sizeof(float), int(mesh.vertices.size()),
                                corners.data(), int(corners.size()), 3 * sizeof(dTriIndex));
    dGeomTriMeshDataPreprocess2(data,
                                (1u << dTRIDATAPREPROCESS_BUILD_FACE_ANGLES) |
                                    (1u << dTRIDATAPREPROCESS_BUILD_CONCAVE_EDGES),
                                nullptr);
  }
  ~OdeMesh() { dGeomTriMeshDataDestroy(data); }
  OdeMesh(const OdeMesh&) = delete;
  OdeMesh& operator=(const OdeMesh&) = delete;
};

class OdeWorkload final : public WorkloadPeer {
 public:
  explicit OdeWorkload(const PeerScene& scene) : scene_(scene) {
    start_ode();
    world_ = dWorldCreate();
    space_ = dSweepAndPruneSpaceCreate(nullptr, dSAP_AXES_XZY);
    contacts_ = dJointGroupCreate(0);
    dWorldSetGravity(world_, 0, -9.81, 0);
    for (size_t i = 0; i < scene.bodies.size(); ++i) add(scene.bodies[i], i);
    for (const WorkloadJoint& j : scene.workload.joints) add(j);
  }
  ~OdeWorkload() override {
    dJointGroupDestroy(contacts_);
    dSpaceDestroy(space_);
    dWorldDestroy(world_);
  }
  void step() override {
    points_ = 0;
    dSpaceCollide(space_, this, &OdeWorkload::meet);
    dWorldQuickStep(world_, PeerScene::step);
    dJointGroupEmpty(contacts_);
  }
  void read(std::span<RigidBody> bodies) override {
    for (size_t i = 0; i < bodies.size(); ++i) {
      if (!bodies_[i]) continue;
      bodies[i].pose = {from_ode(dBodyGetPosition(bodies_[i])),
                        quat_from_ode(dBodyGetQuaternion(bodies_[i]))};
      bodies[i].v = from_ode(dBodyGetLinearVel(bodies_[i]));
      bodies[i].omega = from_ode(dBodyGetAngularVel(bodies_[i]));
    }
  }
  size_t contact_points() const override { return points_; }

 private:
  dBodyID make_body(const RigidBody& b) {
    const dBodyID body = dBodyCreate(world_);
    const Vec3 inertia = b.dynamic() ? Vec3(b.inertia_body.diagonal()) : Vec3::Ones();
    dMass m;
    dMassSetParameters(&m, b.dynamic() ? b.mass : 1, 0, 0, 0, inertia.x(), inertia.y(), inertia.z(),
                       0, 0, 0);
    dBodySetMass(body, &m);
    dBodySetPosition(body, b.pose.x.x(), b.pose.x.y(), b.pose.x.z());
    dBodySetQuaternion(body, to_ode(b.pose.q).data());
    dBodySetLinearVel(body, b.v.x(), b.v.y(), b.v.z());
    dBodySetAngularVel(body, b.omega.x(), b.omega.y(), b.omega.z());
    dBodySetAutoDisableFlag(body, 0);
    if (!b.dynamic()) dBodySetKinematic(body);
    return body;
  }
  dGeomID make_shape(const Shape& shape) {
    const ShapeDef& def = shape.def();
    if (def.type == ShapeType::sphere) return dCreateSphere(space_, def.radius);
    if (def.type == ShapeType::capsule) return dCreateCapsule(space_, def.radius, def.height);
    if (def.type == ShapeType::box) {
      const Vec3 size = 2 * def.half_extents;
      return dCreateBox(space_, size.x(), size.y(), size.z());
    }
    if (def.type == ShapeType::triangle_mesh) {
      const OdeMesh& mesh = meshes_.try_emplace(def.mesh.get(), *def.mesh).first->second;
      return dCreateTriMesh(space_, mesh.data, nullptr, nullptr, nullptr);
    }
    const auto& polyhedron = dynamic_cast<const ConvexHullShape&>(shape).polyhedron();
    OdeHull& hull = hulls_.try_emplace(def.mesh.get(), polyhedron).first->second;
    return dCreateConvex(space_, hull.planes.data(), unsigned(hull.planes.size() / 4),
                         hull.points.data(), unsigned(hull.points.size() / 3),
                         hull.polygons.data());
  }
  void add(const RigidBody& b, size_t index) {
    const dBodyID body = b.type == BodyType::fixed ? nullptr : make_body(b);
    bodies_.push_back(body);
    for (const BodyShape& s : b.shapes) {
      const dGeomID shape = make_shape(*s.shape);
      dGeomSetData(shape, reinterpret_cast<void*>(index));
      Pose local = s.pose;
      if (s.shape->type() == ShapeType::capsule)  // its capsules lie along z
        local.q = local.q * axis_angle(Vec3::UnitX(), M_PI / 2);
      const Pose at = body ? local : b.pose * local;
      if (body) {
        dGeomSetBody(shape, body);
        if (at.x.isZero(1e-12) && std::abs(at.q.w()) > 1 - 1e-12) continue;
        dGeomSetOffsetPosition(shape, at.x.x(), at.x.y(), at.x.z());
        dGeomSetOffsetQuaternion(shape, to_ode(at.q).data());
      } else {
        dGeomSetPosition(shape, at.x.x(), at.x.y(), at.x.z());
        dGeomSetQuaternion(shape, to_ode(at.q).data());
      }
    }
  }
  void add(const WorkloadJoint& j) {
    const dBodyID a = bodies_[j.a], b = bodies_[j.b];
    if (!a && !b) return;
    const Vec3& x = j.frame.x;
    if (j.kind == JointKind::spherical) {
      const dJointID ball = dJointCreateBall(world_, nullptr);
      dJointAttach(ball, a, b);
      dJointSetBallAnchor(ball, x.x(), x.y(), x.z());
      return;
    }
    const Vec3 axis = j.frame.direction(Vec3::UnitZ());
    const dJointID hinge = dJointCreateHinge(world_, nullptr);
    dJointAttach(hinge, a, b);
    dJointSetHingeAnchor(hinge, x.x(), x.y(), x.z());
    dJointSetHingeAxis(hinge, axis.x(), axis.y(), axis.z());
  }
  static void meet(void* data, dGeomID a, dGeomID b) {
    auto& self = *static_cast<OdeWorkload*>(data);
    const auto index_a = reinterpret_cast<size_t>(dGeomGetData(a));
    const auto index_b = reinterpret_cast<size_t>(dGeomGetData(b));
    const RigidBody &of_a = self.scene_.bodies[index_a], &of_b = self.scene_.bodies[index_b];
    if (index_a == index_b || !(of_a.dynamic() || of_b.dynamic())) return;
    if (of_a.group != 0 && of_a.group == of_b.group) return;
    dContact found[8];
    const int count = dCollide(a, b, 8, &found[0].geom, sizeof(dContact));
    for (int i = 0; i < count; ++i) {
      found[i].surface.mode = dContactApprox1;
      found[i].surface.mu = of_b.shapes.front().material.friction;  // the same everywhere
      dJointAttach(dJointCreateContact(self.world_, self.contacts_, &found[i]), dGeomGetBody(a),
                   dGeomGetBody(b));
    }
    self.points_ += size_t(count);
  }

  PeerScene scene_;
  dWorldID world_;
  dSpaceID space_;
  dJointGroupID contacts_;
  std::vector<dBodyID> bodies_;  ///< null: fixed
  std::map<const TriangleMesh*, OdeHull> hulls_;
  std::map<const TriangleMesh*, OdeMesh> meshes_;
  size_t points_ = 0;
};

}  // namespace

std::unique_ptr<WorkloadPeer> ode_workload(const PeerScene& scene) {
  return std::make_unique<OdeWorkload>(scene);
}

}  // namespace tumble::test
