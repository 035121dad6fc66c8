#include "engine/scene/check.hpp"

#include "engine/scene/build.hpp"
#include "engine/scene/catalogue.hpp"
#include "engine/world/world.hpp"

namespace tumble {

SceneCheck check_scene(const std::string& name_or_path, const ReadOptions& options) {
  SceneCheck out;
  SceneRead read = open_scene(name_or_path, options);
  out.faults = std::move(read.faults);
  if (!out.faults.empty()) return out;
  WorldDef extras;
  extras.threads = 1;
  auto built = build_world(read.scene, std::move(extras), nullptr, &out.faults);
  if (!built) return out;
  out.warnings = std::move(built->warnings);
  const StepStats& stats = built->world->frame()->stats;
  out.bodies = built->bodies.size();
  out.particles = stats.particles;
  return out;
}

}  // namespace tumble
