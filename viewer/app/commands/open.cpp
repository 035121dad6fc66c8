#include "viewer/app/command.hpp"
#include "viewer/app/load_scene.hpp"
#include "viewer/app/scene_files.hpp"

#include <cstdlib>
#include <memory>

#include <CLI/CLI.hpp>

namespace tumble {
namespace {

struct OpenLine {
  SceneRequest request;
};

bool has_display() {
  for (const char* name : {"DISPLAY", "WAYLAND_DISPLAY"})
    if (const char* value = std::getenv(name); value && *value) return true;
  return false;
}

int run_open(OpenLine& line) {
  line.request.log = stderr_log(LogLevel::warning);
  if (auto scene = find_scene(line.request.scene); !scene)
    return report(scene.error(), exit_bad_input);
  const std::string instead = "render without one: tumble render " + line.request.scene +
                              " -o out --seconds 4 (`tumble doctor` tells what works here)";
  if (!has_display())
    return report({ErrorCode::unsupported,
                   "there is no display: neither DISPLAY nor WAYLAND_DISPLAY is set",
                   {},
                   instead},
                  exit_no_renderer);
  return report({ErrorCode::unsupported, "this build has no window", {}, instead},
                exit_no_renderer);
}

}  // namespace

CommandAction declare_open(CLI::App& app) {
  auto line = std::make_shared<OpenLine>();
  line->request.scene = default_scene;
  app.add_option("scene", line->request.scene,
                 "scene file, mesh file, or a name of `tumble scenes`")
      ->capture_default_str();
  app.add_option("--threads", line->request.threads, "of the simulation; 0: one per core")
      ->check(CLI::Range(0, 1024));
  app.add_option("--stepper", line->request.stepper, "instead of the scene's");
  app.add_option("--set", line->request.overrides, "path=value, e.g. bodies.ball.mass=3")
      ->allow_extra_args(false);
  app.footer("Without a display it says so and exits 4; `tumble render` needs none.");
  return [line] { return run_open(*line); };
}

}  // namespace tumble
