// How the first contact of fast bodies is found is a choice. References: which side of the wall
// bodies are on, and bytes of the same world under other numbers of threads or never saved.
#include "engine/collision/time_of_contact.hpp"
#include "engine/core/random.hpp"
#include "engine/geometry/make_mesh.hpp"
#include "tests/support/test_world.hpp"
#include "tests/support/why_not.hpp"

#include <doctest/doctest.h>

using namespace tumble;
using test::TestWorld;

namespace {

WorldSettings with_contact_time(std::string_view method, std::string_view narrow_phase = "gjk") {
  WorldSettings s;
  s.gravity = Vec3::Zero();
  s.contact_time = method;
  s.narrow_phase = narrow_phase;
  return s;
}

ShapeDef mesh_box(const Vec3& half) {
  ShapeDef d;
  d.type = ShapeType::triangle_mesh;
  d.mesh = std::make_shared<const TriangleMesh>(make_mesh::box(half));
  return d;
}

BodyDef thrown(const ShapeDef& shape, const Vec3& place, const Vec3& spin) {
  BodyDef d = TestWorld::shape_def(shape, place);
  d.velocity = {0, 0, 400};
  d.angular_velocity = spin;
  return d;
}

/// A wall of 0.1 mm at z = 0, and a ball, a rod, a box and a mesh that fly at it.
std::vector<BodyId> volley(TestWorld& w, bool mesh_wall) {
  ShapeDef wall;
  wall.type = ShapeType::box;
  wall.half_extents = {20, 20, 5e-5};
  BodyDef fixed =
      TestWorld::shape_def(mesh_wall ? mesh_box(wall.half_extents) : wall, Vec3::Zero());
  fixed.type = BodyType::fixed;
  w.add(fixed);
  ShapeDef ball, rod, brick;
  ball.radius = 0.1;
  rod.type = ShapeType::capsule;
  rod.radius = 0.02, rod.height = 0.6;
  brick.type = ShapeType::box;
  brick.half_extents = {0.02, 0.3, 0.1};
  std::vector<BodyId> out;
  out.push_back(w.add(thrown(ball, {-6, 0, -9}, {0, 0, 50})));
  out.push_back(w.add(thrown(rod, {-2, 0, -9}, {0, 0, 0})));
  out.push_back(w.add(thrown(brick, {2, 0, -9}, {0, 0, 70})));
  out.push_back(w.add(thrown(mesh_box({0.1, 0.2, 0.1}), {6, 0, -9}, {0, 0, 40})));
  return out;
}

}  // namespace

TEST_CASE("under every method for the time of contact nothing passes a thin wall") {
  for (const ContactTimeMethod& method : all_contact_time_methods()) {
    for (const char* narrow_phase : {"gjk", "v_clip"}) {
      for (const bool mesh_wall : {false, true}) {
        INFO(method.name);
        TestWorld w(with_contact_time(method.name, narrow_phase));
        const std::vector<BodyId> bodies = volley(w, mesh_wall);
        for (int i = 0; i < 20; ++i) w.step();
        for (const BodyId b : bodies) {
          INFO(w.body(b).pose.x.x());
          CHECK(w.body(b).pose.x.z() < 0);
        }
      }
    }
  }
}

TEST_CASE("the method for the time of contact can be switched while a world runs, and is saved") {
  const auto& all = all_contact_time_methods();
  TestWorld one(with_contact_time("automatic"), 1), many(with_contact_time("automatic"), 4);
  volley(one, true);
  volley(many, true);
  for (int i = 0; i < 24; ++i) {
    for (TestWorld* w : {&one, &many}) {
      WorldSettings s = (*w)->settings();
      s.contact_time = all[size_t(i) % all.size()].name;
      REQUIRE((*w)->set_settings(s).ok());
    }
    TestWorld copy;
    const Status loaded = copy->load(one->save());
    REQUIRE_MESSAGE(loaded.ok(), test::why_not(loaded));
    one.step();
    many.step();
    copy.step();
    CHECK(copy->settings().contact_time == all[size_t(i) % all.size()].name);
    CHECK(copy->state_hash() == one->state_hash());
    CHECK(many->state_hash() == one->state_hash());
  }
  WorldSettings wrong = one->settings();
  wrong.contact_time = "bisektion";
  const auto refused = one->set_settings(wrong);
  REQUIRE(!refused.ok());
  CHECK(refused.error().text().find("bisection") != std::string::npos);
}

TEST_CASE("a box that whirls on a plate of half a millimetre is not turned through it") {
  Random r(3);
  for (int i = 0; i < test::scaled(360); ++i) {
    TestWorld w(with_contact_time(i % 2 ? "automatic" : "conservative_advancement"));
    BodyDef plate = TestWorld::box_def(Vec3::Zero(), {20, 20, 2.5e-4});
    plate.type = BodyType::fixed;
    w.add(plate);
    const Vec3 half(r.uniform(0.005, 0.05), r.uniform(0.005, 0.05), r.uniform(0.005, 0.05));
    BodyDef d = TestWorld::box_def({0, 0, -half.z() - 2.5e-4 - r.uniform(0, 1e-4)}, half);
    d.velocity = {r.uniform(-5, 5), r.uniform(-5, 5), r.uniform(0, 10)};
    d.angular_velocity = 5e4 * Vec3(r.uniform(-1, 1), r.uniform(-1, 1), r.uniform(-1, 1));
    const BodyId b = w.add(d);
    for (int k = 0; k < 10; ++k) {
      w.step();
      CHECK_MESSAGE(w.body(b).pose.x.z() < 0, i);
    }
  }
}
