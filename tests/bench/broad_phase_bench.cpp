// Broad phases beside FCL's dynamic tree: boxes of half-extents U(.25,.75) per axis fly about in a
// cube of side 2 cbrt(n/3) with speed v, reflected at its walls, dt 1/60; a step is the update of
// all bounds and the list of all overlapping pairs. All candidates see the same boxes in the same
// step, and must find as many pairs. Then the same count of boxes with sizes from 1 to 10^4 against
// equal boxes with as many pairs.
#include "engine/collision/broad_phase.hpp"
#include "engine/core/random.hpp"
#include "engine/math/dense.hpp"
#include "engine/math/det/det.hpp"
#include "tests/bench/contest.hpp"

#include <cmath>

#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/geometry/shape/box.h>

using namespace tumble;
using namespace tumble::bench;

namespace {

struct FlyingBoxes {
  FlyingBoxes(size_t n, double speed) : limit(std::cbrt(double(n) / 3)) {
    Random r(5);
    for (size_t i = 0; i < n; ++i) {
      half.push_back({r.uniform(.25, .75), r.uniform(.25, .75), r.uniform(.25, .75)});
      centre.push_back(
          {r.uniform(-limit, limit), r.uniform(-limit, limit), r.uniform(-limit, limit)});
      Vec3 d;
      do {
        d = {r.uniform(-1, 1), r.uniform(-1, 1), r.uniform(-1, 1)};
      } while (d.squaredNorm() > 1 || d.squaredNorm() < 1e-4);
      velocity.push_back(speed * d.normalized());
    }
  }
  void move() {
    for (size_t i = 0; i < centre.size(); ++i) {
      centre[i] += velocity[i] / 60;
      for (int k = 0; k < 3; ++k)
        if (std::abs(centre[i][k]) > limit) {
          velocity[i][k] = -velocity[i][k];
          centre[i][k] = std::clamp(centre[i][k], -limit, limit);
        }
    }
  }

  double limit;
  std::vector<Vec3> half, centre, velocity;
};

/// FCL's dynamic tree with an object per box. Of its ways to follow them it gets the faster: boxes
/// refitted and then balanced by a few rotations, whose tree decays when all of them move, or every
/// leaf taken out and inserted anew.
class FclTree {
 public:
  FclTree(const FlyingBoxes& boxes, bool reinsert) : reinsert_(reinsert) {
    for (const Vec3& h : boxes.half) {
      const auto shape = std::make_shared<fcl::Boxd>(fcl::Vector3d(2 * dense(h)));
      objects_.push_back(std::make_unique<fcl::CollisionObjectd>(shape));
    }
    place(boxes);
    for (const auto& o : objects_) all_.push_back(o.get());
    manager_.registerObjects(all_);
    manager_.setup();
  }
  double step(const FlyingBoxes& boxes) {
    place(boxes);
    if (reinsert_)
      manager_.update(all_);
    else
      manager_.update();
    uint64_t pairs = 0;
    manager_.collide(&pairs, [](fcl::CollisionObjectd* a, fcl::CollisionObjectd* b, void* data) {
      *static_cast<uint64_t*>(data) += a->getAABB().overlap(b->getAABB());
      return false;
    });
    return double(pairs);
  }

 private:
  void place(const FlyingBoxes& boxes) {
    for (size_t i = 0; i < objects_.size(); ++i) {
      objects_[i]->setTranslation(dense(boxes.centre[i]));
      objects_[i]->computeAABB();
    }
  }
  bool reinsert_;
  std::vector<std::unique_ptr<fcl::CollisionObjectd>> objects_;
  std::vector<fcl::CollisionObjectd*> all_;
  fcl::DynamicAABBTreeCollisionManagerd manager_;
};

/// One of ours, with what it needs from step to step.
struct Ours {
  std::unique_ptr<BroadPhase> phase;
  std::vector<BroadPhaseProxy> proxies;
  std::vector<ProxyPair> pairs;

  double step(const FlyingBoxes& boxes) {
    proxies.resize(boxes.centre.size());
    for (size_t i = 0; i < proxies.size(); ++i)
      proxies[i] = {{boxes.centre[i] - boxes.half[i], boxes.centre[i] + boxes.half[i]}, true};
    phase->find_pairs(proxies, pairs);
    return double(pairs.size());
  }
};

void flying(size_t n, double speed, int rounds) {
  FlyingBoxes boxes(n, speed);
  FclTree refitted(boxes, false), reinserted(boxes, true);
  std::vector<Ours> ours, threaded;
  Crew two_threads(2);
  boxes.move();
  std::vector<Candidate> candidates{
      {"FCL dynamic tree, reinserted", [&] { return reinserted.step(boxes); }},
      {"FCL dynamic tree, refitted", [&] { return refitted.step(boxes); }}};
  for (const BroadPhaseEntry& e : all_broad_phases())
    if (e.name != "brute_force") {
      ours.push_back({e.make(), {}, {}});
      threaded.push_back({e.make(), {}, {}});
      threaded.back().phase->use_threads(&two_threads);
    }
  size_t next = 0;
  for (const BroadPhaseEntry& e : all_broad_phases())
    if (e.name != "brute_force") {
      candidates.push_back({std::string(e.name), [&, k = next] { return ours[k].step(boxes); }});
      candidates.push_back({std::string(e.name) + ", 2 threads",
                            [&, k = next++] { return threaded[k].step(boxes); }});
    }
  candidates.push_back({"(moving the boxes)", [&] {
                          boxes.move();
                          return 0.0;
                        }});
  const auto t =
      report(std::to_string(n) + " boxes, v = " + std::to_string(int(speed)), candidates, rounds);
  for (size_t k = 2; k + 2 < t.size(); k += 2) {
    std::printf("  %-28s two threads %.2f x one\n", candidates[k].name.c_str(),
                t[k + 1].milliseconds / t[k].milliseconds);
  }
}

/// Boxes with sizes log-uniform in [1, ratio], in a cube of side `side`.
std::vector<BroadPhaseProxy> sizes(size_t n, double ratio, double side) {
  Random r(9);
  std::vector<BroadPhaseProxy> proxies;
  for (size_t i = 0; i < n; ++i) {
    const double h = 0.5 * det::exp(r.uniform(0, std::log(ratio)));
    const Vec3 c(r.uniform(0, side), r.uniform(0, side), r.uniform(0, side));
    proxies.push_back({{c.array() - h, c.array() + h}, true});
  }
  return proxies;
}

/// The side of the cube in which these boxes have `pairs` pairs: the chance of a pair is the
/// product of summed extents over the volume, which leaves out only the walls; then corrected by
/// counting.
double side_for(size_t n, double ratio, double pairs) {
  double mean = 0;
  const auto drawn = sizes(n, ratio, 0);
  for (size_t i = 1; i < n; ++i) {
    const double sum = drawn[i - 1].bounds.extent().x() + drawn[i].bounds.extent().x();
    mean += sum * sum * sum / double(n - 1);
  }
  double side = std::cbrt(0.5 * double(n) * double(n) * mean / pairs);
  const auto phase = all_broad_phases().back().make();
  std::vector<ProxyPair> found;
  for (int i = 0; i < 4; ++i) {
    phase->find_pairs(sizes(n, ratio, side), found);
    side *= std::cbrt(double(found.size()) / pairs);
  }
  return side;
}

void size_ratio(size_t n, int rounds) {
  const double pairs = 1.5 * double(n);
  const auto equal = sizes(n, 1, side_for(n, 1, pairs));
  const auto mixed = sizes(n, 1e4, side_for(n, 1e4, pairs));
  const auto& list = all_broad_phases();
  const auto it = std::find_if(list.begin(), list.end(),
                               [](const auto& e) { return e.name == "multi_level_grid"; });
  std::vector<ProxyPair> a, b;
  const auto phase_a = it->make(), phase_b = it->make();
  report(std::to_string(n) + " boxes, equal and with sizes 1 to 10^4, multi_level_grid",
         {{"equal sizes",
           [&] {
             phase_a->find_pairs(equal, a);
             return double(a.size());
           }},
          {"sizes 1 to 10^4",
           [&] {
             phase_b->find_pairs(mixed, b);
             return double(b.size());
           }}},
         rounds);
  std::printf("  tested: %zu and %zu\n", size_t(phase_a->stats().tested),
              size_t(phase_b->stats().tested));
}

}  // namespace

int main() {
  for (const double v : {2.0, 20.0}) {
    flying(10'000, v, 101);
    flying(100'000, v, 21);
  }
  size_ratio(10'000, 101);
  size_ratio(100'000, 21);
}
