#include "engine/scene/robot_files/expand_robots.hpp"

#include "engine/scene/resources.hpp"
#include "engine/scene/robot_files/robot_parts.hpp"
#include "engine/scene/visitors/object_reader.hpp"
#include "engine/scene/visitors/object_validator.hpp"
#include "engine/scene/writer.hpp"

#include <algorithm>
#include <numbers>

#include <fmt/format.h>

namespace tumble {
namespace {

namespace fs = std::filesystem;

void set_all_lines(JsonNode& node, int line) {
  node.line = line;
  for (JsonNode& item : node.items) set_all_lines(item, line);
}

RobotsOfScene read_robots(const JsonNode& root, const std::string& file, FaultList& faults) {
  JsonNode head;
  head.kind = JsonNode::Kind::object;
  head.line = root.line;
  for (const std::string_view key : {"parameters", "robots"})
    if (const JsonNode* node = root.find(key)) {
      head.keys.emplace_back(key);
      head.items.push_back(*node);
    }
  RobotsOfScene out;
  FaultList found;
  ReadContext context{file, found, {}};
  read_object(context, head, {}, struct_ref(out));
  const FaultSink sink = [&](std::string path, std::string message) {
    if (!found.covers(path)) {
      const int line = line_of(head, path);
      found.add({line == 0 ? "--set" : file, line, std::move(path), std::move(message)});
    }
  };
  validate_object(struct_ref(out), {}, sink);
  for (const Fault& f : found.sorted())  // faults of parameters are reported again with the scene
    if (f.path.starts_with("robots")) faults.add(f);
  return out;
}

/// Path of the file that a robot names: relative to the scene's folder, or among the shipped files.
Result<fs::path> robot_file(const fs::path& folder, const std::string& given) {
  std::error_code error;
  const fs::path here = folder / given;
  if (fs::is_regular_file(here, error)) return here;
  if (auto shipped = find_resource(fs::path("scenes") / given);
      shipped && fs::is_regular_file(*shipped, error))
    return *shipped;
  return Error{
      ErrorCode::not_found, fmt::format("there is no robot file '{}'", here.string()), {}, {}};
}

RobotOptions options_of(const std::string& name, int number, const RobotDescription& d) {
  constexpr int first_group = 1'000'000;  // apart from numbers that scenes use
  RobotOptions out;
  out.prefix = d.prefix.value_or(name + "_");
  out.pose = d.placement.pose();
  out.base = d.base;
  out.motors = d.motors;
  out.self_collision = d.self_collision;
  out.group = first_group + number;
  const auto take = [](const auto& list, double unit, std::map<std::string, double>& to) {
    for (const auto& item : list.items) to[item.name] = item.value.value * unit;
  };
  take(d.start, 1, out.start);
  take(d.start_deg, std::numbers::pi / 180, out.start);
  take(d.target, 1, out.target);
  take(d.target_deg, std::numbers::pi / 180, out.target);
  return out;
}

class Expander {
 public:
  Expander(JsonNode& root, const std::string& file, FaultList& faults,
           std::vector<std::string>& warnings)
      : root_(root), file_(file), faults_(faults), warnings_(warnings) {}

  void robot(const std::string& name, int number, const RobotDescription& d, int line) {
    const fs::path folder = fs::path(file_).parent_path();
    const std::string at = "robots." + name;
    const auto found = robot_file(folder, d.file);
    if (!found) return faults_.add({file_, line, at + ".file", found.error().message});
    const bool bare = *found == fs::path(file_);
    PackageFolders packages;
    for (const auto& item : d.packages.items) packages[item.name] = folder / item.value.folder;
    RobotLog log;
    RobotModel model = read_robot_file(*found, packages, log);
    RobotParts parts;
    if (log.ok()) parts = make_robot(std::move(model), options_of(name, number, d), log);
    for (const Fault& f : log.faults()) faults_.add(bare ? f : Fault{file_, line, at, f.text()});
    for (std::string& w : log.warnings()) warnings_.push_back(std::move(w));
    if (!log.ok()) return;
    FaultList ignored;
    auto tree = parse_json(write_scene(parts.scene), file_, ignored);
    if (!tree) return faults_.add({file_, line, at, "makes more than a scene can hold"});
    for (const std::string_view list : {"meshes", "bodies", "joints"})
      if (JsonNode* from = tree->find(list)) take_in(list, *from, bare, line, parts.lines);
  }

 private:
  void take_in(std::string_view list, JsonNode& from, bool bare, int line,
               const std::map<std::string, int>& lines) {
    JsonNode* to = root_.find(list);
    if (!to) {
      root_.keys.emplace_back(list);
      to = &root_.items.emplace_back();
      to->kind = JsonNode::Kind::object;
      to->line = root_.line;
    }
    if (!to->is(JsonNode::Kind::object)) return;  // reported as a fault of the scene
    for (size_t i = 0; i < from.items.size(); ++i) {
      const std::string path = std::string(list) + "." + from.keys[i];
      const auto own = lines.find(path);
      const int here = !bare ? line : own == lines.end() ? 1 : own->second;
      if (to->find(from.keys[i])) {
        faults_.add({file_, here, path,
                     "there is one of this name beside the robot's (give the "
                     "robot a 'prefix')"});
        continue;
      }
      set_all_lines(from.items[i], here);
      to->keys.push_back(from.keys[i]);
      to->items.push_back(std::move(from.items[i]));
    }
  }

  JsonNode& root_;
  const std::string& file_;
  FaultList& faults_;
  std::vector<std::string>& warnings_;
};

}  // namespace

void expand_robots(JsonNode& root, const std::string& file, FaultList& faults,
                   std::vector<std::string>& warnings) {
  const JsonNode* robots = root.find("robots");
  if (!robots) return;
  const RobotsOfScene scene = read_robots(root, file, faults);
  std::vector<int> lines;
  for (const auto& item : scene.robots.items) {
    const JsonNode* node = robots->find(item.name);
    lines.push_back(node ? node->line : robots->line);
  }
  const size_t place = size_t(robots - root.items.data());
  root.keys.erase(root.keys.begin() + std::ptrdiff_t(place));
  root.items.erase(root.items.begin() + std::ptrdiff_t(place));
  Expander expander(root, file, faults, warnings);
  for (size_t i = 0; i < scene.robots.size(); ++i) {
    const auto& [name, robot] = scene.robots.items[i];
    if (!faults.covers("robots." + name)) expander.robot(name, int(i), robot, lines[i]);
  }
}

}  // namespace tumble
