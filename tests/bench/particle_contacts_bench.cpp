// Contacts of 10^5 particles: pairs that touch beside FCL's dynamic tree over the same balls, pairs
// that meet within a tick, and what a terrain of 20 000 triangles and 1000 boxes are touched or met
// by, beside asking every shape whose bounds the particle's reach. Answers are counts of contacts.
#include "engine/collision/particle_contacts/particle_contacts.hpp"
#include "engine/collision/shape_near.hpp"
#include "engine/core/random.hpp"
#include "engine/geometry/make_mesh.hpp"
#include "tests/bench/contest.hpp"

#include <cmath>
#include <memory>

#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/geometry/shape/sphere.h>

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

/// One object per ball; boxes inserted anew in each round, as all have moved.
class FclBalls {
 public:
  explicit FclBalls(const Cloud& c) : cloud_(c) {
    for (size_t i = 0; i < c.x.size(); ++i) {
      const auto ball = std::make_shared<fcl::Sphered>(c.radius[i]);
      objects_.push_back(std::make_unique<fcl::CollisionObjectd>(ball));
      objects_.back()->setTranslation(c.x[i]);
      objects_.back()->setUserData(reinterpret_cast<void*>(i));
      objects_.back()->computeAABB();
      all_.push_back(objects_.back().get());
    }
    manager_.registerObjects(all_);
    manager_.setup();
  }
  double pairs() {
    manager_.update();
    struct Count {
      const Cloud* cloud;
      double pairs = 0;
    } count{&cloud_};
    manager_.collide(&count, [](fcl::CollisionObjectd* a, fcl::CollisionObjectd* b, void* data) {
      auto& c = *static_cast<Count*>(data);
      const auto i = reinterpret_cast<size_t>(a->getUserData());
      const auto j = reinterpret_cast<size_t>(b->getUserData());
      const double r = c.cloud->radius[i] + c.cloud->radius[j];
      c.pairs += (c.cloud->x[i] - c.cloud->x[j]).squaredNorm() <= r * r;
      return false;
    });
    return count.pairs;
  }

 private:
  const Cloud& cloud_;
  std::vector<std::unique_ptr<fcl::CollisionObjectd>> objects_;
  std::vector<fcl::CollisionObjectd*> all_;
  fcl::DynamicAABBTreeCollisionManagerd manager_;
};

}  // namespace

int main() {
  const Cloud cloud = make_cloud(100'000, 5);
  const ParticleBalls balls{cloud.x, cloud.radius};
  const ParticlePaths paths{balls, cloud.v, 1.0 / 60};
  ParticleContactFinder finder;
  {
    FclBalls peer(cloud);
    std::vector<ParticlePairContact> touch;
    std::vector<ParticlePairMeeting> meet;
    report("100000 particles, pairs", {{"FCL dynamic tree", [&] { return peer.pairs(); }},
                                       {"touching_pairs",
                                        [&] {
                                          (void)finder.touching_pairs(balls, 0, touch);
                                          return double(touch.size());
                                        }},
                                       {"meeting_pairs", [&] {
                                          (void)finder.meeting_pairs(paths, meet);
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
  std::printf("  processor time: %.2f us a particle to touch, %.2f to meet\n", t[1].cpu / 100,
              t[2].cpu / 100);
}
