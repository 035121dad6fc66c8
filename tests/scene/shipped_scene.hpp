#pragma once
#include "engine/scene/build.hpp"
#include "engine/scene/reader.hpp"
#include "engine/world/world.hpp"

#include <cmath>
#include <string>
#include <vector>

#include <doctest/doctest.h>

namespace tumble {

/// A scene of the folder scenes/, built, with values changed as by --set.
inline BuiltScene shipped(const std::string& name, std::vector<std::string> overrides = {}) {
  const std::string file = std::string(TUMBLE_SOURCE_DIR) + "/scenes/" + name + ".json";
  const SceneRead read = load_scene(file, {std::move(overrides)});
  for (const Fault& f : read.faults) MESSAGE(f.text());
  REQUIRE(read.ok());
  auto made = build_world(read.scene);
  REQUIRE(made.ok());
  return std::move(*made);
}

/// Steps for so many simulated seconds.
inline void run(BuiltScene& scene, double seconds) {
  const auto ticks = uint64_t(std::lround(seconds / scene.world->settings().tick.tick()));
  for (uint64_t i = 0; i < ticks; ++i) {
    const auto step = scene.world->step();
    REQUIRE(step.ok());
  }
}

inline const RigidBody& body(const BuiltScene& scene, const std::string& name) {
  const auto it = scene.bodies.find(name);
  REQUIRE_MESSAGE(it != scene.bodies.end(), name);
  return *scene.world->body(it->second);
}
/// Of the centre of mass [m].
inline Vec3 place(const BuiltScene& scene, const std::string& name) {
  return body(scene, name).pose.x;
}
/// The name of a copy.
inline std::string copy(const std::string& name, int i) {
  return name + "[" + std::to_string(i) + "]";
}

/// Calls f(body, name) for every dynamic body.
template <class F>
void for_each_moving(const BuiltScene& scene, F f) {
  for (const auto& [name, id] : scene.bodies)
    if (const RigidBody* b = scene.world->body(id); b && b->type == BodyType::dynamic) f(*b, name);
}

}  // namespace tumble
