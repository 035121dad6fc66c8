#pragma once
#include "engine/world/world.hpp"
#include "tests/support/scale.hpp"
#include "tests/support/why_not.hpp"

#include <cstdlib>
#include <string>

#include <doctest/doctest.h>

namespace tumble::test {

inline int scaled(int count) {
  return scaled_count(count);
}

/// A world in three lines: `TestWorld w; auto b = w.box({0, 1, 0}); w.run(2.0);`. Any warning of
/// the engine fails the test.
struct TestWorld {
  std::unique_ptr<World> world;

  /// Warnings with `expected` in them are none.
  explicit TestWorld(WorldSettings settings = {}, int threads = 1, std::string expected = {}) {
    WorldDef def;
    def.settings = settings;
    def.threads = threads;
    def.log = [expected](LogLevel level, std::string_view message) {
      if (!expected.empty() && message.find(expected) != std::string_view::npos) return;
      if (level >= LogLevel::warning) FAIL_CHECK("engine warning: ", std::string(message));
    };
    auto made = World::create(std::move(def));
    REQUIRE_MESSAGE(made.ok(), test::why_not(made));
    world = std::move(*made);
  }
  World* operator->() { return world.get(); }

  BodyId add(BodyDef def) {
    auto id = world->create_body(std::move(def));
    REQUIRE_MESSAGE(id.ok(), test::why_not(id));
    apply();
    return *id;
  }
  static BodyDef shape_def(ShapeDef shape, const Vec3& x, BodyType type = BodyType::dynamic) {
    BodyDef def;
    def.type = type;
    def.pose.x = x;
    def.shapes.push_back({std::move(shape), {}, {}});
    return def;
  }
  static BodyDef box_def(const Vec3& x, const Vec3& half = {0.5, 0.5, 0.5}) {
    ShapeDef s;
    s.type = ShapeType::box;
    s.half_extents = half;
    return shape_def(s, x);
  }
  static BodyDef sphere_def(const Vec3& x, double radius = 0.5) {
    ShapeDef s;
    s.type = ShapeType::sphere;
    s.radius = radius;
    return shape_def(s, x);
  }
  BodyId box(const Vec3& x, const Vec3& half = {0.5, 0.5, 0.5}) { return add(box_def(x, half)); }
  BodyId sphere(const Vec3& x, double radius = 0.5) { return add(sphere_def(x, radius)); }
  BodyId ground() {
    ShapeDef s;
    s.type = ShapeType::half_space;
    return add(shape_def(s, Vec3::Zero(), BodyType::fixed));
  }
  ForceId force(ForceDef def) {
    auto id = world->create_force(std::move(def));
    REQUIRE_MESSAGE(id.ok(), test::why_not(id));
    apply();
    return *id;
  }
  void apply() {
    const Status s = world->apply_commands();
    REQUIRE_MESSAGE(s.ok(), test::why_not(s));
  }
  StepReport step() {
    auto report = world->step();
    REQUIRE_MESSAGE(report.ok(), test::why_not(report));
    return *report;
  }
  void run(double seconds) {
    const auto n = uint64_t(seconds / world->settings().tick.tick() + 0.5);
    for (uint64_t i = 0; i < n; ++i) step();
  }
  const RigidBody& body(BodyId id) const {
    const RigidBody* b = world->body(id);
    REQUIRE(b);
    return *b;
  }
};

}  // namespace tumble::test
