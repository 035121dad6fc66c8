#include "viewer/app/command.hpp"
#include "viewer/app/commands/file_roles.hpp"
#include "viewer/app/options.hpp"
#include "viewer/app/scenes/packed_scene.hpp"
#include "viewer/capture/atomic_file.hpp"

#include <filesystem>
#include <memory>
#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace tumble {
namespace {

struct PackLine {
  std::string scene, file, replay;
  bool no_replay = false, force = false, json = false;
};

int run_pack(const PackLine& line) {
  if (line.file.empty())
    return report({ErrorCode::invalid_argument,
                   "the name of the pack is missing",
                   {},
                   "`tumble pack my_scene.json my.tumble`"},
                  exit_usage);
  if (std::error_code none; !line.force && std::filesystem::exists(line.file, none))
    return report({ErrorCode::io, "the file is there already", line.file,
                   "--force overwrites it, or name another"},
                  exit_cannot_write);
  SceneRequest request;
  request.scene = line.scene;
  request.threads = 1;
  request.replay.none = line.no_replay;
  request.log = stderr_log(LogLevel::warning);
  FileRoles roles;
  roles.reads(request).reads(line.replay).writes("the pack", line.file);
  if (const auto scene = read_scene_request(request)) roles.reads(*scene);
  if (const Status apart = roles.apart(); !apart) return report(apart.error(), exit_usage);
  std::optional<NamedReplay> replay;
  if (!line.replay.empty()) {
    auto bytes = read_file(line.replay);
    if (!bytes) return report(bytes.error(), exit_bad_input);
    replay = NamedReplay{*std::move(bytes), line.replay};
  }
  const auto files = packed_scene(request, replay ? &*replay : nullptr);
  if (!files)
    return report(files.error(),
                  files.error().code == ErrorCode::internal ? exit_negative : exit_bad_input);
  if (const Status written = write_pack(line.file, *files); !written)
    return report(written.error(), exit_cannot_write);
  if (line.json) {
    nlohmann::ordered_json out = {{"file", line.file},
                                  {"entries", nlohmann::ordered_json::array()}};
    for (const PackFile& f : *files)
      out["entries"].push_back({{"name", f.name}, {"bytes", f.bytes.size()}});
    fmt::print("{}\n", out.dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
    return exit_ok;
  }
  for (const PackFile& f : *files) fmt::print("{:>10}  {}\n", f.bytes.size(), f.name);
  return exit_ok;
}

}  // namespace

CommandAction declare_pack(Options& options) {
  auto line = std::make_shared<PackLine>();
  options.value("scene", line->scene, "scene, robot or mesh file, or a name of `tumble scenes`")
      .required();
  options.value("file,-o,--output", line->file,
                "the pack to write, e.g. my.tumble; needed, in either way");
  const Option replay =
      options
          .value("--replay", line->replay,
                 "with a replay of this scene, as `tumble simulate --replay` writes them, or the "
                 "window by Ctrl+F9; it is run first; a pack keeps its own unless one is given")
          .not_empty();
  options
      .flag("--no-replay", line->no_replay, "leave out the replay of a pack that is packed again")
      .excludes(replay);
  options.flag("--force", line->force, "overwrite a file that exists");
  options.flag("--json", line->json, "one JSON object on stdout");
  options.footer(
      "One file with the scene and all that it needs: its meshes, the robots in it, its lesson. "
      "open,\n"
      "render, simulate, verify and check read it in place of a scene, and dropped on the window "
      "it opens.\n"
      "It is a ZIP archive, and the same scene makes the same bytes.\n\n"
      "Examples:\n"
      "  tumble pack my_scene.json my.tumble\n"
      "  tumble simulate my_scene.json --seconds 4 --replay run.bin\n"
      "  tumble pack my_scene.json -o my.tumble --replay run.bin\n"
      "  tumble open my.tumble");
  return [line] { return run_pack(*line); };
}

}  // namespace tumble
