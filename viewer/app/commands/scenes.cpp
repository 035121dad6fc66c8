#include "engine/scene/resources.hpp"
#include "viewer/app/command.hpp"
#include "viewer/app/options.hpp"
#include "viewer/app/scenes/load_scene.hpp"
#include "viewer/app/scenes/scene_files.hpp"

#include <algorithm>
#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace tumble {
namespace {

struct SceneLine {
  std::string name, title, description, category, file;
};

int run_scenes(bool json) {
  if (const auto folder = find_resource("scenes"); !folder)
    return report(folder.error(), exit_bad_input);
  std::vector<SceneLine> lines;
  size_t widest = 0;
  for (const std::string& name : scene_names()) {
    SceneRequest request;
    request.scene = name;
    const auto scene = read_scene_request(request);
    SceneLine line;
    line.name = name;
    if (const auto file = find_scene(name); file) line.file = file->string();
    if (scene) {
      line.title = scene->title;
      line.description = scene->description;
      line.category = scene->category;
    } else {
      line.description = "faulty; see `tumble check " + name + "`";
    }
    widest = std::max(widest, name.size());
    lines.push_back(std::move(line));
  }
  if (json) {
    nlohmann::ordered_json out = {{"scenes", nlohmann::ordered_json::array()}};
    for (const SceneLine& l : lines)
      out["scenes"].push_back({{"name", l.name},
                               {"title", l.title},
                               {"description", l.description},
                               {"category", l.category},
                               {"file", l.file}});
    fmt::print("{}\n", out.dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
    return exit_ok;
  }
  for (const SceneLine& l : lines)
    fmt::print("{:<{}}  {}\n", l.name, widest, l.description.empty() ? l.title : l.description);
  return exit_ok;
}

}  // namespace

CommandAction declare_scenes(Options& options) {
  auto json = std::make_shared<bool>(false);
  options.flag("--json", *json, "one JSON object on stdout");
  return [json] { return run_scenes(*json); };
}

}  // namespace tumble
