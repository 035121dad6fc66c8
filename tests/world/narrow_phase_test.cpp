// The narrow phase is a choice. References: bytes of the same world under other numbers of threads
// or never saved; for what rests the height at which it was stacked.
#include "engine/collision/narrow_phase.hpp"

#include "engine/core/random.hpp"
#include "tests/support/test_world.hpp"
#include "tests/support/why_not.hpp"

#include <doctest/doctest.h>

using namespace tumble;
using test::TestWorld;

namespace {

WorldSettings with(std::string_view narrow_phase) {
  WorldSettings s;
  s.narrow_phase = narrow_phase;
  return s;
}

/// A heap of boxes and hulls that fall on each other.
void heap(TestWorld& w) {
  w.ground();
  Random random(31);
  for (int i = 0; i < 16; ++i) {
    const double x = random.uniform(-0.4, 0.4), z = random.uniform(-0.4, 0.4);
    const Vec3 place(x, 0.5 + 0.7 * i, z);
    if (i % 2) {
      w.box(place, {0.3, 0.2, 0.4});
      continue;
    }
    auto points = std::make_shared<TriangleMesh>();
    for (int k = 0; k < 14; ++k) {
      const double a = random.uniform(-0.3, 0.3), b = random.uniform(-0.3, 0.3),
                   c = random.uniform(-0.3, 0.3);
      points->vertices.push_back({a, b, c});
    }
    ShapeDef hull;
    hull.type = ShapeType::convex_hull;
    hull.mesh = points;
    w.add(TestWorld::shape_def(hull, place));
  }
}

std::vector<BodyId> tower(TestWorld& w) {
  w.ground();
  std::vector<BodyId> out;
  for (int i = 0; i < 8; ++i) out.push_back(w.box({0, 0.25 + 0.5 * i, 0}, {0.25, 0.25, 0.25}));
  return out;
}

}  // namespace

TEST_CASE("under every narrow phase a world repeats bit for bit, saved or not, for any threads") {
  for (const NarrowPhaseEntry& e : all_narrow_phases()) {
    INFO(e.name);
    TestWorld one(with(e.name), 1), many(with(e.name), 4);
    heap(one);
    heap(many);
    for (int i = 0; i < 60; ++i) {
      TestWorld copy;
      const Status loaded = copy->load(one->save());
      REQUIRE_MESSAGE(loaded.ok(), test::why_not(loaded));
      one.step();
      many.step();
      copy.step();
      CHECK(copy->state_hash() == one->state_hash());
      CHECK(many->state_hash() == one->state_hash());
    }
  }
}

TEST_CASE("under every narrow phase, and when it is switched in between, a tower stands") {
  std::vector<std::string> names;
  for (const NarrowPhaseEntry& e : all_narrow_phases()) names.emplace_back(e.name);
  names.emplace_back("switched");
  for (const std::string& name : names) {
    INFO(name);
    WorldSettings settings = name == "switched" ? WorldSettings{} : with(name);
    settings.realtime.precise = true;
    TestWorld w(settings);
    const std::vector<BodyId> boxes = tower(w);
    for (int i = 0; i < 180; ++i) {
      if (name == "switched" && i % 7 == 0) {
        WorldSettings s = w->settings();
        s.narrow_phase = all_narrow_phases()[size_t(i / 7) % all_narrow_phases().size()].name;
        REQUIRE(w->set_settings(s).ok());
      }
      w.step();
    }
    for (size_t i = 0; i < boxes.size(); ++i) {
      const Vec3& x = w.body(boxes[i]).pose.x;
      CHECK(std::abs(x.y() - (0.25 + 0.5 * double(i))) < 0.005);
      CHECK(std::hypot(x.x(), x.z()) < 0.005);
    }
  }
}
