// Contacts of 10^5 particles: pairs that touch beside FCL's dynamic tree over the same balls, pairs
// that meet within a tick beside the same tree over the boxes that they sweep, and what a terrain
// of 20 000 triangles and 1000 boxes are touched by, beside asking every shape whose bounds the
// particle's reach, or met by, beside Bullet's sweeps of spheres (in single precision, the first
// shape only, and of shapes at rest). Answers are counts of contacts.
#include "engine/collision/particle_contacts/particle_contacts.hpp"
#include "engine/collision/shape_near.hpp"
#include "engine/core/random.hpp"
#include "engine/geometry/make_mesh.hpp"
#include "engine/math/dense.hpp"
#include "tests/bench/contest.hpp"

#include <cmath>
#include <memory>

#include <btBulletCollisionCommon.h>
#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/geometry/shape/box.h>

using namespace tumble;
using namespace tumble::bench;

namespace {

struct Cloud {
  std::vector<Vec3> x, v;
  std::vector<double> radius;
};

/// Balls of 2 cm at about the density of a loose heap, within a cube standing on y = 0.
Cloud make_cloud(size_t n, double speed) {
  Random r(6);
  Cloud c;
  const double side = std::cbrt(double(n)) * 0.05;
  const auto draw = [&](double a, double b) {
    const double x = r.uniform(a, b), y = r.uniform(a, b), z = r.uniform(a, b);
    return Vec3(x, y, z);
  };
  for (size_t i = 0; i < n; ++i) {
    c.x.push_back(draw(-side / 2, side / 2) + Vec3(0, side / 2, 0));
    c.v.push_back(speed * draw(-1, 1));
    c.radius.push_back(r.uniform(0.01, 0.02));
  }
  return c;
}

/// FCL's tree over the boxes that balls sweep within h seconds, which are refitted in each round,
/// as all have moved. Pairs whose centres come within both radii of each other on the way are
/// counted.
class FclBalls {
 public:
  FclBalls(const Cloud& c, double h) : cloud_(c), h_(h) {
    for (size_t i = 0; i < c.x.size(); ++i) {
      const Vec3 way = h * c.v[i];
      const Vec3 extents = way.cwiseAbs() + Vec3::Constant(2 * c.radius[i]);
      objects_.push_back(
          std::make_unique<fcl::CollisionObjectd>(std::make_shared<fcl::Boxd>(dense(extents))));
      objects_.back()->setTranslation(dense(c.x[i] + 0.5 * way));
      objects_.back()->setUserData(reinterpret_cast<void*>(i));
      objects_.back()->computeAABB();
      all_.push_back(objects_.back().get());
    }
    manager_.registerObjects(all_);
    manager_.setup();
  }
  double pairs() {
    manager_.update();
    count_ = 0;
    manager_.collide(this, [](fcl::CollisionObjectd* a, fcl::CollisionObjectd* b, void* data) {
      auto& self = *static_cast<FclBalls*>(data);
      self.count_ += self.meet(reinterpret_cast<size_t>(a->getUserData()),
                               reinterpret_cast<size_t>(b->getUserData()));
      return false;
    });
    return count_;
  }

 private:
  bool meet(size_t i, size_t j) const {
    const Vec3 apart = cloud_.x[i] - cloud_.x[j], way = h_ * (cloud_.v[i] - cloud_.v[j]);
    const double length2 = way.squaredNorm(), r = cloud_.radius[i] + cloud_.radius[j];
    const double t = length2 > 0 ? std::clamp(-apart.dot(way) / length2, 0.0, 1.0) : 0;
    return (apart + t * way).squaredNorm() <= r * r;
  }

  const Cloud& cloud_;
  double h_, count_ = 0;
  std::vector<std::unique_ptr<fcl::CollisionObjectd>> objects_;
  std::vector<fcl::CollisionObjectd*> all_;
  fcl::DynamicAABBTreeCollisionManagerd manager_;
};

btVector3 bt(const Vec3& v) {
  return {btScalar(v.x()), btScalar(v.y()), btScalar(v.z())};
}

/// A terrain and boxes at rest, and spheres swept through them. Compared one by one, Bullet finds
/// 93 in 100 of the particles that we find, and 2 that we do not; and it counts what a particle
/// meets after it has moved out of what it overlapped, where we leave that particle out.
class BulletGround {
 public:
  BulletGround(const TriangleMesh& terrain, const Vec3& half_extents,
               std::span<const StillShape> shapes)
      : box_(bt(half_extents)) {
    for (size_t i = 0; i < terrain.triangles.size(); ++i)
      triangles_.addTriangle(bt(terrain.corner(i, 0)), bt(terrain.corner(i, 1)),
                             bt(terrain.corner(i, 2)));
    terrain_ = std::make_unique<btBvhTriangleMeshShape>(&triangles_, true);
    box_.setMargin(0);
    terrain_->setMargin(0);
    for (const StillShape& s : shapes) {
      const auto& q = s.pose.q;
      const btQuaternion turn(btScalar(q.x()), btScalar(q.y()), btScalar(q.z()), btScalar(q.w()));
      objects_.push_back(std::make_unique<btCollisionObject>());
      const bool is_box = s.shape->type() == ShapeType::box;
      objects_.back()->setCollisionShape(is_box ? static_cast<btCollisionShape*>(&box_)
                                                : terrain_.get());
      objects_.back()->setWorldTransform(btTransform(turn, bt(s.pose.x)));
      world_.addCollisionObject(objects_.back().get());
    }
  }
  /// How many particles meet something on their way, and not from the start.
  double meetings(const Cloud& cloud, double h) const {
    double count = 0;
    for (size_t i = 0; i < cloud.x.size(); ++i) {
      const btSphereShape ball(btScalar(cloud.radius[i]));
      const btVector3 from = bt(cloud.x[i]), to = bt(cloud.x[i] + h * cloud.v[i]);
      btCollisionWorld::ClosestConvexResultCallback hit(from, to);
      const btQuaternion unturned = btQuaternion::getIdentity();
      world_.convexSweepTest(&ball, btTransform(unturned, from), btTransform(unturned, to), hit);
      count += hit.hasHit() && hit.m_closestHitFraction > 0;
    }
    return count;
  }

 private:
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  btDbvtBroadphase broad_phase_;
  btCollisionWorld world_{&dispatcher_, &broad_phase_, &configuration_};
  btTriangleMesh triangles_;
  std::unique_ptr<btBvhTriangleMeshShape> terrain_;
  btBoxShape box_;
  std::vector<std::unique_ptr<btCollisionObject>> objects_;
};

/// The particles among these meetings that meet nothing from the start.
double particles_of(const std::vector<ParticleShapeMeeting>& all) {
  double count = 0;
  for (size_t i = 0, next = 0; i < all.size(); i = next) {
    bool later = true;
    for (; next < all.size() && all[next].particle == all[i].particle; ++next)
      later = later && all[next].time > 0;
    count += later;
  }
  return count;
}

}  // namespace

int main() {
  const Cloud cloud = make_cloud(100'000, 5);
  const ParticleBalls balls{cloud.x, cloud.radius};
  const ParticlePaths paths{balls, cloud.v, 1.0 / 60};
  ParticleContactFinder finder;
  {
    FclBalls still(cloud, 0), moving(cloud, paths.h);
    std::vector<ParticlePairContact> touch;
    std::vector<ParticlePairMeeting> meet;
    report("100000 particles, pairs that touch",
           {{"FCL dynamic tree", [&] { return still.pairs(); }}, {"touching_pairs", [&] {
                                                                    (void)finder.touching_pairs(
                                                                        balls, 0, touch);
                                                                    return double(touch.size());
                                                                  }}});
    report("100000 particles, pairs that meet",
           {{"FCL dynamic tree", [&] { return moving.pairs(); }}, {"meeting_pairs", [&] {
                                                                     (void)finder.meeting_pairs(
                                                                         paths, meet);
                                                                     return double(meet.size());
                                                                   }}});
  }
  ShapeDef ground;
  ground.type = ShapeType::triangle_mesh;
  ground.mesh = std::make_shared<const TriangleMesh>(
      make_mesh::terrain(4, 100, [](double x, double z) { return 0.3 + 0.1 * (x * x - z * z); }));
  ShapeDef brick;
  brick.type = ShapeType::box;
  brick.half_extents = {0.05, 0.03, 0.1};
  const auto terrain = make_shape(ground), box = make_shape(brick);
  if (!terrain || !box) return 1;
  std::vector<StillShape> still{{terrain->get(), {}}};
  Random r(7);
  for (int i = 0; i < 1000; ++i) {
    const double x = r.uniform(-1.2, 1.2), y = r.uniform(0.4, 2.3), z = r.uniform(-1.2, 1.2);
    const Quat q(r.uniform(), r.uniform(), r.uniform(), r.uniform());
    still.push_back({box->get(), {Vec3(x, y, z), q.normalized()}});
  }
  std::vector<MovingShape> moving;
  for (const StillShape& s : still) {
    moving.push_back({s.shape, Motion::at_rest(s.pose, 0, paths.h)});
    if (s.shape == box->get()) {
      moving.back().motion.velocity = {r.uniform(-3, 3), r.uniform(-3, 3), r.uniform(-3, 3)};
      moving.back().motion.omega = {r.uniform(-9, 9), r.uniform(-9, 9), r.uniform(-9, 9)};
    }
  }
  std::vector<ParticleShapeContact> touch;
  std::vector<ParticleShapeMeeting> meet;
  const auto t = report("100000 particles, a terrain and 1000 boxes",
                        {{"every particle and shape",
                          [&] {
                            double count = 0;
                            std::vector<Aabb> bounds;
                            for (const StillShape& s : still)
                              bounds.push_back(s.shape->bounds(s.pose));
                            for (size_t i = 0; i < cloud.x.size(); ++i) {
                              const Aabb b = Aabb{cloud.x[i], cloud.x[i]}.inflated(cloud.radius[i]);
                              for (size_t k = 0; k < still.size(); ++k)
                                if (bounds[k].overlaps(b))
                                  count += near_shape(*still[k].shape, still[k].pose, cloud.x[i],
                                                      cloud.radius[i])
                                               .has_value();
                            }
                            return count;
                          }},
                         {"touching_shapes",
                          [&] {
                            (void)finder.touching_shapes(balls, still, 0, touch);
                            return double(touch.size());
                          }},
                         {"meeting_shapes",
                          [&] {
                            (void)finder.meeting_shapes(paths, moving, 1e-6, meet);
                            return double(meet.size());
                          }}},
                        5);
  std::vector<MovingShape> at_rest;
  for (const StillShape& k : still)
    at_rest.push_back({k.shape, Motion::at_rest(k.pose, 0, paths.h)});
  const BulletGround bullet(*ground.mesh, brick.half_extents, still);
  report("100000 particles that meet the same at rest",
         {{"Bullet convexSweepTest", [&] { return bullet.meetings(cloud, paths.h); }},
          {"meeting_shapes",
           [&] {
             (void)finder.meeting_shapes(paths, at_rest, 1e-6, meet);
             return particles_of(meet);
           }}},
         5);
  std::printf("  processor time: %.2f us a particle to touch, %.2f to meet\n", t[1].cpu / 100,
              t[2].cpu / 100);
}
