#include "viewer/app/scenes/load_scene.hpp"

#include "engine/core/stop.hpp"
#include "engine/scene/catalogue.hpp"
#include "viewer/app/exit_codes.hpp"
#include "viewer/app/scenes/scene_assertions.hpp"
#include "viewer/app/scenes/scene_files.hpp"
#include "viewer/app/scenes/scene_lesson.hpp"

#include <algorithm>

namespace tumble {
namespace fs = std::filesystem;
namespace {

Error scene_error(const std::vector<Fault>& faults) {
  Error error = to_error(faults);
  const bool ours =
      std::all_of(faults.begin(), faults.end(), [](const Fault& f) { return f.file == "--set"; });
  if (ours) error.code = ErrorCode::invalid_argument;
  return error;
}

SceneRead read_file_of(const SceneRequest& request, const fs::path& file) {
  ReadOptions options;
  options.overrides = request.overrides;
  if (!request.stepper.empty())
    options.overrides.push_back("settings.stepper=\"" + request.stepper + "\"");
  if (request.text) return read_scene(*request.text, file.string(), options);
  return read_scene_file(file, options);
}

}  // namespace

Result<SceneDescription> read_scene_request(const SceneRequest& request,
                                            std::vector<Fault>* faults) {
  const auto file = find_scene(request.scene);
  if (!file) return file.error();
  auto read = read_file_of(request, *file);
  if (faults) *faults = read.faults;
  if (!read.ok()) return scene_error(read.faults);
  return std::move(read.scene);
}

Result<LoadedScene> load_scene_and_world(const SceneRequest& request, std::vector<Fault>* faults) {
  auto description = read_scene_request(request, faults);
  if (!description) return description.error();
  WorldDef extras;
  extras.threads = request.threads;
  extras.log = request.log;
  auto built = build_world(*description, extras, nullptr, faults);
  if (stop_requested()) return stopped_error();
  if (!built) return built.error();
  if (std::vector<Fault> unknown = assertion_faults(*built); !unknown.empty()) {
    if (faults) *faults = unknown;
    return scene_error(unknown);
  }
  const auto with_choices = [&](const std::vector<std::string>& choices) {
    SceneRequest chosen = request;
    chosen.overrides.insert(chosen.overrides.end(), choices.begin(), choices.end());
    std::vector<Fault> found;
    (void)read_scene_request(chosen, &found);
    return found;
  };
  if (std::vector<Fault> wrong = lesson_faults(*built, with_choices); !wrong.empty()) {
    if (faults) *faults = wrong;
    return scene_error(wrong);
  }
  if (request.log)
    for (const std::string& warning : built->warnings) request.log(LogLevel::warning, warning);
  const fs::path file = *find_scene(request.scene);
  return LoadedScene{file.stem().string(), file, *std::move(built)};
}

Status check_scene_text(const std::string& text, const fs::path& file) {
  auto read = read_scene(text, file.string(), {});
  if (!read.ok()) return scene_error(read.faults);
  WorldDef extras;
  extras.threads = 1;
  const auto built = build_world(read.scene, extras);
  if (!built) return built.error();
  return {};
}

ExitCode exit_code_of_scene(const Error& error) {
  return error.code == ErrorCode::invalid_argument ? exit_usage : exit_bad_input;
}

}  // namespace tumble
