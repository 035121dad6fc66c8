// Questions to a world of 10^4 balls, boxes and hulls of 20 points beside Bullet (its dynamic tree;
// single precision, as Debian builds it by default): the first hit and all hits of rays, the first
// contact of a ball and a box that are cast, what a ball overlaps; and what it costs to make the
// tree anew when all bodies have moved. Answers are compared as sums over the same questions.
#include "engine/core/random.hpp"
#include "engine/world/queries/query_scene.hpp"
#include "engine/world/world.hpp"
#include "tests/bench/contest.hpp"

#include <cmath>
#include <cstdlib>
#include <memory>

#include <btBulletCollisionCommon.h>

using namespace tumble;
using namespace tumble::bench;

namespace {

struct Question {
  Vec3 from, way;
};

Vec3 draw(Random& r, double a, double b) {
  const double x = r.uniform(a, b), y = r.uniform(a, b), z = r.uniform(a, b);
  return {x, y, z};
}

btVector3 bt(const Vec3& v) {
  return {btScalar(v.x()), btScalar(v.y()), btScalar(v.z())};
}

btTransform bt(const Pose& p) {
  const btQuaternion q(btScalar(p.q.x()), btScalar(p.q.y()), btScalar(p.q.z()), btScalar(p.q.w()));
  return btTransform(q, bt(p.x));
}

BodyDef one_body(Random& r, double limit, size_t k) {
  BodyDef def;
  def.pose = {draw(r, -limit, limit), Quat(r.uniform(), r.uniform(), r.uniform(), r.uniform())};
  def.pose.q.normalize();
  ShapeDef shape;
  shape.type = std::array{ShapeType::sphere, ShapeType::box, ShapeType::convex_hull}[k % 3];
  shape.radius = r.uniform(.25, .75);
  shape.half_extents = draw(r, .25, .75);
  if (shape.type == ShapeType::convex_hull) {
    auto points = std::make_shared<TriangleMesh>();
    for (int i = 0; i < 20; ++i) {
      Vec3 p;
      do p = draw(r, -1, 1);
      while (p.squaredNorm() > 1 || p.squaredNorm() < 0.01);
      points->vertices.push_back(p.normalized().cwiseProduct(shape.half_extents));
    }
    shape.mesh = points;
  }
  def.shapes.push_back({shape, {}, {}});
  return def;
}

/// The same bodies in Bullet.
class BulletWorld {
 public:
  explicit BulletWorld(const Frame& frame) {
    for (size_t slot = 0; slot < frame.body_slots(); ++slot) {
      const ShapeDef& def = frame.info(slot).shapes[0].shape->def();
      if (def.type == ShapeType::sphere) {
        shapes_.push_back(std::make_unique<btSphereShape>(btScalar(def.radius)));
      } else if (def.type == ShapeType::box) {
        shapes_.push_back(std::make_unique<btBoxShape>(bt(def.half_extents)));
      } else {
        auto hull = std::make_unique<btConvexHullShape>();
        for (const Vec3& p : def.mesh->vertices) hull->addPoint(bt(p), false);
        hull->setMargin(0);
        hull->recalcLocalAabb();
        shapes_.push_back(std::move(hull));
      }
      objects_.push_back(std::make_unique<btCollisionObject>());
      objects_.back()->setCollisionShape(shapes_.back().get());
      objects_.back()->setWorldTransform(
          bt(frame.body(slot).pose * frame.info(slot).shapes[0].pose));
      world_.addCollisionObject(objects_.back().get());
    }
    update();
  }
  void update() { world_.updateAabbs(); }
  void move(double x) {
    for (const auto& o : objects_) {
      btTransform at = o->getWorldTransform();
      at.getOrigin().setX(at.getOrigin().x() + btScalar(x));
      o->setWorldTransform(at);
    }
    update();
  }
  btCollisionWorld& operator*() { return world_; }

 private:
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  btDbvtBroadphase broad_phase_;
  btCollisionWorld world_{&dispatcher_, &broad_phase_, &configuration_};
  std::vector<std::unique_ptr<btCollisionShape>> shapes_;
  std::vector<std::unique_ptr<btCollisionObject>> objects_;
};

struct CountContacts : btCollisionWorld::ContactResultCallback {
  const btCollisionObject* asking = nullptr;
  std::vector<const btCollisionObject*> met;
  btScalar addSingleResult(btManifoldPoint& point, const btCollisionObjectWrapper* a, int, int,
                           const btCollisionObjectWrapper* b, int, int) override {
    if (point.getDistance() > 0) return 0;
    const btCollisionObject* one = a->getCollisionObject();
    const btCollisionObject* other = one == asking ? b->getCollisionObject() : one;
    if (met.empty() || met.back() != other) met.push_back(other);
    return 0;
  }
};

class Questions {
 public:
  Questions(std::shared_ptr<const QueryScene> scene, BulletWorld& bullet, double limit)
      : scene_(std::move(scene)), bullet_(bullet) {
    Random r(4);
    const auto room = *make_shape({.type = ShapeType::sphere, .radius = 0.6});
    while (across_.size() < 2000) {
      const Vec3 a = draw(r, -limit, limit), b = draw(r, -limit, limit);
      // Who starts inside is treated differently.
      if (*scene_->overlaps_any(*room, {a, Quat::Identity()})) continue;
      across_.push_back({a, 3 * (b - a)});
      near_.push_back({a, 4 * (b - a).normalized()});
    }
  }

  void first_hits() {
    first_hits("first hit of a long ray", across_);
    first_hits("first hit of a ray of 4 m", near_);
  }
  void all_hits() {
    report("all hits of a long ray", {{"Bullet rayTest",
                                       [&] {
                                         double count = 0;
                                         for (const Question& q : across_) {
                                           const btVector3 a = bt(q.from), b = bt(q.from + q.way);
                                           btCollisionWorld::AllHitsRayResultCallback hits(a, b);
                                           (*bullet_).rayTest(a, b, hits);
                                           count += hits.m_collisionObjects.size();
                                         }
                                         return count;
                                       }},
                                      {"ray_all", [&] {
                                         double count = 0;
                                         for (const Question& q : across_) {
                                           const RayQuery ray{q.from, q.way, q.way.norm()};
                                           count += double((*scene_->ray_all(ray)).size());
                                         }
                                         return count;
                                       }}});
  }
  void casts(const char* name, const ShapeDef& def, const btConvexShape& peer) {
    const auto shape = *make_shape(def);
    report(name, {{"Bullet convexSweepTest",
                   [&] {
                     double sum = 0;
                     for (const Question& q : near_) {
                       const btTransform a = bt(Pose{q.from, Quat::Identity()});
                       const btTransform b = bt(Pose{q.from + q.way, Quat::Identity()});
                       btCollisionWorld::ClosestConvexResultCallback hit(a.getOrigin(),
                                                                         b.getOrigin());
                       (*bullet_).convexSweepTest(&peer, a, b, hit);
                       sum += hit.hasHit() ? double(hit.m_closestHitFraction) : 1;
                     }
                     return sum;
                   }},
                  {"cast", [&] {
                     double sum = 0;
                     for (const Question& q : near_) {
                       CastQuery cast;
                       cast.start.x = q.from;
                       cast.translation = q.way;
                       cast.tolerance = 1e-3;  // Bullet's
                       const auto hit = scene_->cast(*shape, cast);
                       sum += *hit ? (*hit)->fraction : 1;
                     }
                     return sum;
                   }}});
  }
  void overlaps() {
    const auto ball = *make_shape({.type = ShapeType::sphere, .radius = 0.5});
    btSphereShape peer(btScalar(0.5));
    btCollisionObject object;
    object.setCollisionShape(&peer);
    report("what a ball overlaps",
           {{"Bullet contactTest",
             [&] {
               double count = 0;
               for (const Question& q : near_) {
                 object.setWorldTransform(bt(Pose{q.from + 0.2 * q.way, Quat::Identity()}));
                 CountContacts contacts;
                 contacts.asking = &object;
                 (*bullet_).contactTest(&object, contacts);
                 count += double(contacts.met.size());
               }
               return count;
             }},
            {"overlaps", [&] {
               double count = 0;
               for (const Question& q : near_)
                 count += double(
                     (*scene_->overlaps(*ball, {q.from + 0.2 * q.way, Quat::Identity()})).size());
               return count;
             }}});
  }
  void making() {
    double away = 0.1;
    report("the tree after all have moved", {{"Bullet updateAabbs",
                                              [&] {
                                                bullet_.move(away = -away);
                                                return 0.0;
                                              }},
                                             {"QueryScene", [&] {
                                                const auto frame =
                                                    std::make_shared<Frame>(scene_->frame());
                                                const QueryScene fresh(frame);
                                                return 0.0;
                                              }}});
  }

 private:
  void first_hits(const char* name, const std::vector<Question>& list) {
    const auto peer = [&] {
      double sum = 0;
      for (const Question& q : list) {
        const btVector3 a = bt(q.from), b = bt(q.from + q.way);
        btCollisionWorld::ClosestRayResultCallback hit(a, b);
        (*bullet_).rayTest(a, b, hit);
        if (hit.hasHit()) sum += double(hit.m_closestHitFraction) * q.way.norm();
      }
      return sum;
    };
    const auto ours = [&] {
      double sum = 0;
      for (const Question& q : list)
        if (const auto hit = scene_->ray({q.from, q.way, q.way.norm()}); *hit)
          sum += (*hit)->distance;
      return sum;
    };
    const auto t = report(name, {{"Bullet rayTest", peer}, {"ray", ours}});
    std::printf("  processor time: %.2f us a ray\n", 1e3 * t[1].cpu / double(list.size()));
  }

  std::shared_ptr<const QueryScene> scene_;
  BulletWorld& bullet_;
  std::vector<Question> across_, near_;
};

}  // namespace

int main() {
  constexpr size_t n = 10'000;
  const double limit = std::cbrt(double(n) / 3);
  const auto made = World::create();
  if (!made) return 1;
  World& world = **made;
  Random r(5);
  for (size_t k = 0; k < n; ++k)
    if (!world.create_body(one_body(r, limit, k))) return 1;
  if (!world.apply_commands()) return 1;
  BulletWorld bullet(*world.frame());
  Questions questions(world.queries(), bullet, limit);
  std::printf("2000 questions each to %zu bodies\n", n);
  questions.first_hits();
  questions.all_hits();
  questions.casts("a ball of 0.2 m cast over 4 m", {.type = ShapeType::sphere, .radius = 0.2},
                  btSphereShape(btScalar(0.2)));
  questions.casts("a box of 0.3 m cast over 4 m",
                  {.type = ShapeType::box, .half_extents = {0.3, 0.3, 0.3}},
                  btBoxShape(btVector3(btScalar(0.3), btScalar(0.3), btScalar(0.3))));
  questions.overlaps();
  questions.making();
}
