#pragma once
#include "engine/core/hash.hpp"
#include "engine/scene/build.hpp"
#include "engine/scene/catalogue.hpp"
#include "engine/world/replay.hpp"
#include "engine/world/world.hpp"

#include <filesystem>
#include <fstream>
#include <string>

#include <doctest/doctest.h>

namespace tumble {

/// The small scene with the ball pushed at two moments, as a replay; gives the hash at its end.
inline std::string record(const std::filesystem::path& scene, const std::filesystem::path& file,
                          double speed) {
  const SceneRead read = read_scene_file(scene);
  REQUIRE(read.ok());
  auto built = build_world(read.scene);
  REQUIRE(built.ok());
  World& world = *built->world;
  const BodyId ball = built->bodies.at("ball");
  for (int tick = 0; tick <= 40; ++tick) {
    if (tick == 10 || tick == 40)
      REQUIRE(world.set_velocity(ball, Vec3(speed, tick, 0), Vec3::Zero()).ok());
    REQUIRE(world.apply_commands().ok());
    if (tick < 40) REQUIRE(world.step().ok());
  }
  const Bytes bytes = save_replay(world);
  std::ofstream out(file, std::ios::binary);
  out.write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
  return hash_text(world.state_hash());
}

}  // namespace tumble
