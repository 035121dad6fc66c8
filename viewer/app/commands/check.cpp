#include "viewer/app/command.hpp"
#include "viewer/app/load_scene.hpp"

#include <memory>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace tumble {
namespace {

struct CheckLine {
  std::vector<std::string> files, overrides;
  bool json = false;
};

nlohmann::ordered_json fault_json(const Fault& f) {
  nlohmann::ordered_json out = {{"file", f.file}};
  if (f.line > 0) out["line"] = f.line;
  if (!f.path.empty()) out["path"] = f.path;
  out["message"] = f.message;
  return out;
}

int run_check(const CheckLine& line) {
  nlohmann::ordered_json out = {{"ok", true}, {"files", nlohmann::ordered_json::array()}};
  int code = exit_ok;
  for (const std::string& file : line.files) {
    std::vector<Fault> faults;
    std::vector<std::string> warnings;
    SceneRequest request;
    request.scene = file;
    request.overrides = line.overrides;
    request.threads = 1;
    request.log = [&warnings](LogLevel level, std::string_view message) {
      if (level >= LogLevel::warning) warnings.emplace_back(message);
    };
    const auto scene = load_scene_and_world(request, &faults);
    if (!scene && faults.empty())
      faults.push_back({.file = file, .path = {}, .message = scene.error().text()});
    nlohmann::ordered_json one = {{"file", file}, {"ok", scene.ok()}};
    if (scene) {
      const auto& stats = scene->built.world->frame()->stats;
      one["bodies"] = stats.bodies;
      one["particles"] = stats.particles;
      if (!line.json)
        fmt::print("{}: ok, {} bodies, {} particles\n", file, stats.bodies, stats.particles);
    } else {
      code = scene.error().code == ErrorCode::invalid_argument ? exit_usage : exit_bad_input;
    }
    one["warnings"] = warnings;
    one["faults"] = nlohmann::ordered_json::array();
    for (const Fault& f : faults) {
      one["faults"].push_back(fault_json(f));
      fmt::print(stderr, "{}\n", f.text());
    }
    for (const std::string& w : warnings) fmt::print(stderr, "{}: warning: {}\n", file, w);
    out["files"].push_back(std::move(one));
  }
  out["ok"] = code == exit_ok;
  if (line.json)
    fmt::print("{}\n", out.dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
  return code;
}

}  // namespace

CommandAction declare_check(CLI::App& app) {
  auto line = std::make_shared<CheckLine>();
  app.add_option("files", line->files, "scene files, or names of `tumble scenes`")->required();
  app.add_option("--set", line->overrides, "path=value, as for `render`")->allow_extra_args(false);
  app.add_flag("--json", line->json, "one JSON object on stdout");
  app.footer(
      "Every fault is printed as FILE:LINE: PATH: what is wrong. 0 when all are right, else 3.\n\n"
      "Examples:\n"
      "  tumble check my_scene.json\n"
      "  tumble check scenes/*.json --json");
  return [line] { return run_check(*line); };
}

}  // namespace tumble
