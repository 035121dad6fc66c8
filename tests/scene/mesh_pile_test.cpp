// Piles with meshes at 60 Hz. References: the speed of free fall from the highest start; overlap
// measured apart from the narrow phase, by rays and distances of points spread over the surfaces
// (tests/support/mesh_overlap.hpp; spacing a twentieth of the radius).
#include "engine/collision/broad_phase.hpp"
#include "engine/geometry/hierarchy/hierarchy.hpp"
#include "engine/scene/build.hpp"
#include "engine/scene/reader.hpp"
#include "engine/world/world.hpp"
#include "tests/support/mesh_overlap.hpp"
#include "tests/support/scale.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include <doctest/doctest.h>

using namespace tumble;
using namespace tumble::test;

namespace {

/// `layers`: how many of a pile's; those higher are left out.
BuiltScene built(const std::string& file, int layers = 1000) {
  SceneRead read = load_scene(std::string(TUMBLE_SOURCE_DIR) + "/" + file, {});
  for (const Fault& f : read.faults) MESSAGE(f.text());
  REQUIRE(read.ok());
  std::erase_if(read.scene.bodies.items, [&](const auto& body) {
    return !body.value.repeat.empty() && body.value.placement.position.y() > 0.75 * layers;
  });
  auto made = build_world(read.scene);
  REQUIRE(made.ok());
  return std::move(*made);
}

std::vector<RigidBody> moving(const BuiltScene& scene) {
  std::vector<RigidBody> out;
  for (const auto& [name, id] : scene.bodies)
    if (const RigidBody* b = scene.world->body(id); b && b->dynamic()) out.push_back(*b);
  return out;
}

/// Probes by mesh, made once.
class MeshProbes {
 public:
  const OverlapProbe* of(const RigidBody& b) {
    const ShapeDef& def = b.shapes[0].shape->def();
    if (def.type != ShapeType::triangle_mesh) return nullptr;
    auto& p = probes_[def.mesh.get()];
    if (!p) p = std::make_unique<OverlapProbe>(*def.mesh, 0.05 * b.bounding_radius);
    return p.get();
  }
  /// Greatest overlap of two bodies of one mesh each [m].
  double worst(const std::vector<RigidBody>& bodies) {
    double deepest = 0;
    for (size_t i = 0; i < bodies.size(); ++i)
      for (size_t j = 0; j < i; ++j) {
        const RigidBody &a = bodies[i], &b = bodies[j];
        const OverlapProbe *pa = of(a), *pb = of(b);
        if (!pa || !pb) continue;
        if ((a.pose.x - b.pose.x).norm() > a.bounding_radius + b.bounding_radius) continue;
        deepest = std::max(deepest,
                           overlap(*pa, a.pose * a.shapes[0].pose, *pb, b.pose * b.shapes[0].pose));
      }
    return deepest;
  }

 private:
  std::map<const TriangleMesh*, std::unique_ptr<OverlapProbe>> probes_;
};

struct PileRun {
  double slept = -1;    ///< when all slept [s]
  double excess = 0;    ///< greatest speed over that of free fall from the highest start [-]
  double outside = 0;   ///< greatest horizontal distance from the middle [m]
  double lowest = 1e9;  ///< [m]
};

PileRun settle(BuiltScene& s, double seconds) {
  PileRun run;
  double top = 0;
  for (const RigidBody& b : moving(s)) top = std::max(top, b.pose.x.y());
  const double fall = std::sqrt(2 * 9.81 * top);
  const double h = s.world->settings().tick.tick();
  for (int k = 1; k * h < seconds && run.slept < 0; ++k) {
    REQUIRE(s.world->step().ok());
    bool asleep = true;
    for (const RigidBody& b : moving(s)) {
      asleep = asleep && b.asleep;
      run.excess = std::max(run.excess, b.v.norm() / fall);
    }
    if (asleep) run.slept = k * h;
  }
  for (const RigidBody& b : moving(s)) {
    run.outside = std::max({run.outside, std::abs(b.pose.x.x()), std::abs(b.pose.x.z())});
    run.lowest = std::min(run.lowest, b.pose.x.y());
  }
  return run;
}

void check_still(BuiltScene& s) {
  const std::vector<RigidBody> before = moving(s);
  for (int k = 0; k < 60; ++k) REQUIRE(s.world->step().ok());
  const std::vector<RigidBody> after = moving(s);
  for (size_t i = 0; i < before.size(); ++i) CHECK(before[i].pose.x == after[i].pose.x);
}

}  // namespace

TEST_CASE("mesh_pile: thin parts settle in their tray at 60 Hz") {
  BuiltScene s = built("scenes/mesh_pile.json");
  CHECK(s.world->settings().tick == TickRate{});
  const PileRun run = settle(s, 12);
  CHECK(run.slept > 0);
  CHECK(run.excess < 1.1);
  CHECK(run.outside < 1.5);
  CHECK(run.lowest > 0);
  MeshProbes probes;
  CHECK(probes.worst(moving(s)) < 0.003);
  check_still(s);
}

TEST_CASE("mesh_pile: switching hierarchy and broad phase while it runs changes no bit") {
  BuiltScene still = built("scenes/mesh_pile.json"), switched = built("scenes/mesh_pile.json");
  const auto& kinds = all_hierarchies();
  const auto& phases = all_broad_phases();
  for (size_t tick = 0; tick < 48; ++tick) {
    WorldSettings settings = switched.world->settings();
    settings.hierarchy = kinds[tick / 3 % (kinds.size() - 1)].name;  // without brute force
    settings.broad_phase = phases[tick / 5 % phases.size()].name;
    REQUIRE(switched.world->set_settings(settings).ok());
    REQUIRE(still.world->step().ok());
    REQUIRE(switched.world->step().ok());
    REQUIRE(switched.world->settings().hierarchy == settings.hierarchy);
    CHECK(still.world->state_hash() == switched.world->state_hash());
  }
}

// The gate has the four lowest of its twenty layers.
TEST_CASE("500 bodies, a quarter of them imported meshes, settle, sleep and stay") {
  const int layers = test::graded_count(20, 4, 4);
  BuiltScene s = built("tests/scene/data/pile_500.json", layers);
  REQUIRE(int(moving(s).size()) == 25 * layers);
  const PileRun run = settle(s, 30);
  MESSAGE("asleep after ", run.slept, " s");
  CHECK(run.slept > 0);
  CHECK(run.excess < 1.1);
  CHECK(run.outside < 2.4);
  CHECK(run.lowest > 0);
  MeshProbes probes;
  CHECK(probes.worst(moving(s)) < 0.02);
  check_still(s);
}
