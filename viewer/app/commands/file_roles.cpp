#include "viewer/app/commands/file_roles.hpp"

#include "engine/core/part_file.hpp"
#include "engine/scene/description.hpp"
#include "engine/scene/json_tree.hpp"
#include "engine/scene/resources.hpp"
#include "viewer/app/scenes/load_scene.hpp"
#include "viewer/app/scenes/scene_files.hpp"
#include "viewer/capture/atomic_file.hpp"

namespace tumble {
namespace fs = std::filesystem;
namespace {

/// Whether something is there that is neither a file nor a folder.
bool is_device(const fs::path& path) {
  std::error_code none;
  const auto type = fs::status(path, none);
  return fs::exists(type) && !fs::is_regular_file(type) && !fs::is_directory(type);
}

/// One name for all ways to write a path, whether or not it exists.
fs::path one_name(const fs::path& path) {
  std::error_code none;
  const fs::path whole = fs::absolute(behind_links(path), none);
  fs::path real = fs::weakly_canonical(whole, none);
  if (real.empty()) real = whole.lexically_normal();
  return real.has_filename() ? real : real.parent_path();  // "folder/"
}

/// Whether both are there and are the same file or folder.
bool is_same(const fs::path& a, const fs::path& b) {
  std::error_code none;
  return !is_device(a) && fs::equivalent(a, b, none);
}

/// Whether both would be the same once they are written.
bool will_be_same(const fs::path& a, const fs::path& b) {
  return is_same(a, b) || (!is_device(a) && one_name(a) == one_name(b));
}

/// The robot files that the text of a scene names: its description has only what they were made
/// into.
std::vector<fs::path> robot_files_of(const fs::path& scene) {
  std::vector<fs::path> out;
  if (scene.extension() != ".json" && scene.extension() != ".jsonc") return out;
  const auto text = read_file(scene);
  if (!text) return out;
  FaultList ignored;
  const auto root = parse_json(*text, scene.string(), ignored);
  const JsonNode* robots = root ? root->find("robots") : nullptr;
  if (!robots) return out;
  for (const JsonNode& robot : robots->items) {
    const JsonNode* file = robot.is(JsonNode::Kind::object) ? robot.find("file") : &robot;
    if (file && file->is(JsonNode::Kind::string)) out.push_back(scene.parent_path() / file->string);
  }
  return out;
}

}  // namespace

FileRoles& FileRoles::reads(const fs::path& file) {
  if (!file.empty()) inputs_.push_back(file);
  return *this;
}

FileRoles& FileRoles::reads(const SceneRequest& request) {
  // Not where a folder or nothing has the name of a scene that comes with Tumble.
  if (std::error_code none; fs::is_regular_file(request.scene, none))
    reads(fs::path(request.scene));
  reads(fs::path(request.replay.file));
  if (const auto file = find_scene(request.scene)) {
    reads(*file);
    for (const fs::path& robot : robot_files_of(*file)) reads(robot);
  }
  return *this;
}

FileRoles& FileRoles::reads(const SceneDescription& scene) {
  const fs::path folder = scene.source ? scene.source->folder : fs::path();
  for (const auto& [name, mesh] : scene.meshes.items)
    if (const auto file = find_mesh_file(folder, mesh.file)) reads(*file);
  return *this;
}

FileRoles& FileRoles::writes(const std::string& option, const fs::path& file) {
  if (!file.empty()) outputs_.push_back({option, file});
  return *this;
}

Status FileRoles::apart() const {
  for (const Output& output : outputs_) {
    for (const fs::path& input : inputs_)
      if (is_same(output.file, input))
        return Error{ErrorCode::invalid_argument, "this file is read, and would be overwritten",
                     output.file.string(), "name another for " + output.option};
    for (const Output* other = outputs_.data(); other != &output; ++other)
      if (will_be_same(output.file, other->file))
        return Error{ErrorCode::invalid_argument,
                     other->option + " and " + output.option + " would both write this",
                     output.file.string(), "name a file or folder for each"};
  }
  return {};
}

}  // namespace tumble
