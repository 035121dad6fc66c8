#include "engine/scene/catalogue.hpp"
#include "viewer/app/command.hpp"
#include "viewer/app/editing/unsaved_work.hpp"
#include "viewer/app/options.hpp"
#include "viewer/app/scenes/load_scene.hpp"
#include "viewer/app/scenes/scene_files.hpp"
#include "viewer/app/scenes/scene_replay.hpp"
#include "viewer/app/window/open_scene.hpp"
#include "viewer/app/window/preferences.hpp"
#include "viewer/app/window/thumbnails.hpp"
#include "viewer/app/window/window_app.hpp"
#include "viewer/render/resources.hpp"

#include <cstdlib>
#include <filesystem>
#include <memory>

namespace tumble {
namespace {

struct OpenLine {
  SceneRequest request;
  std::string capture_folder = ".";
  std::string size = "1280x800";
  double scale = 0;
  std::string status_file, script;
};

bool has_display() {
  for (const char* name : {"DISPLAY", "WAYLAND_DISPLAY"})
    if (const char* value = std::getenv(name); value && *value) return true;
  return false;
}

std::vector<SceneItem> scene_items() {
  std::vector<SceneItem> items;
  for (const CatalogueEntry& entry : scene_catalogue())
    items.push_back({entry.name, entry.description.empty() ? entry.title : entry.description,
                     entry.category, entry.file.string(), entry.title});
  return items;
}

int run_open(OpenLine& line) {
  line.request.log = stderr_log(LogLevel::warning);
  if (auto scene = find_scene(line.request.scene); !scene)
    return report(scene.error(), exit_bad_input);
  if (!has_display()) {
    const std::string instead = "render without one: tumble render " + line.request.scene +
                                " -o out --seconds 4 (`tumble doctor` tells what works here)";
    return report({ErrorCode::unsupported,
                   "there is no display: neither DISPLAY nor WAYLAND_DISPLAY is set",
                   {},
                   instead},
                  exit_no_renderer);
  }
  WindowAppOptions options;
  char cross = 0;
  if (std::sscanf(line.size.c_str(), "%d%c%d", &options.width, &cross, &options.height) != 3 ||
      cross != 'x' || options.width < 64 || options.height < 64)
    return report({ErrorCode::invalid_argument, "not a size: '" + line.size + "'", "--size",
                   "write WxH, e.g. 1280x800"},
                  exit_usage);
  const double aspect = double(options.width) / double(options.height);
  auto shaders = resource_path("shaders");
  if (!shaders) return report(shaders.error(), exit_bad_input);
  auto scene = open_scene(line.request, aspect);
  if (!scene) return report(scene.error(), exit_code_of_scene(scene.error()));

  options.scale = line.scale;
  options.status_file = line.status_file;
  options.script = line.script;
  options.application.shaders = *shaders;
  options.application.scenes = scene_items();
  options.application.thumbnail_folder = Thumbnails::usual_folder();
  std::error_code none;
  options.application.thumbnail_program = std::filesystem::read_symlink("/proc/self/exe", none);
  options.application.unsaved_folder = unsaved_folder();
  options.application.capture_folder = std::filesystem::absolute(line.capture_folder);
  options.application.threads = line.request.threads;
  options.application.version = TUMBLE_VERSION;
  options.application.preferences_file = preferences_file();
  options.application.preferences = take_up_user_files(options.application.faults);
  // Overrides and stepper apply only to the scene of the command line, not to scenes opened later.
  // The replay belongs to that scene, however often it is opened.
  options.application.open = [asked = line.request, aspect](const OpenRequest& wanted) {
    SceneRequest request;
    request.scene = wanted.scene;
    request.overrides = wanted.overrides;
    request.text = wanted.text;
    request.threads = asked.threads;
    request.log = asked.log;
    if (wanted.scene == asked.scene) request.replay = asked.replay;
    return open_scene(request, aspect);
  };
  return run_window(std::move(options), std::move(*scene));
}

}  // namespace

CommandAction declare_open(Options& options) {
  auto line = std::make_shared<OpenLine>();
  line->request.scene = default_scene;
  options
      .value("scene", line->request.scene,
             "scene, robot or mesh file, or a name of `tumble scenes`")
      .shows_default();
  options.value("--threads", line->request.threads, "of the simulation; 0: one per core")
      .between(0, 1024);
  options.value("--stepper", line->request.stepper, "instead of the scene's");
  options.value("--set", line->request.overrides, "path=value, e.g. bodies.ball.mass=3").one_each();
  declare_replay(options, line->request.replay);
  options.value("--size", line->size, "of the window, WxH").shows_default();
  options.value("--scale", line->scale, "size of panels and text; 0: the monitor's")
      .between(0.0, 8.0);
  options.value("--captures", line->capture_folder, "folder for screenshots and sequences")
      .shows_default();
  // For tests and demonstrations, see viewer/app/window/README.md.
  options.value("--status-file", line->status_file).hidden();
  options.value("--script", line->script).hidden();
  options.footer(
      "Without a display it says so and exits 4; `tumble render` needs none. F1 shows every "
      "key.\n\n"
      "Examples:\n"
      "  tumble open tower                             a scene that comes with Tumble\n"
      "  tumble open my_scene.json --set settings.gravity=[0,-1.6,0]\n"
      "  tumble open part.stl                          a mesh file falls on a table\n"
      "  tumble open arm.urdf                          a robot (URDF or MJCF) on a floor\n"
      "  tumble open dominoes --stepper event --size 1600x900");
  return [line] { return run_open(*line); };
}

}  // namespace tumble
