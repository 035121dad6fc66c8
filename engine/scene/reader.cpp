#include "engine/scene/reader.hpp"

#include "engine/scene/json_tree.hpp"
#include "engine/scene/overrides.hpp"
#include "engine/scene/robot_files/expand_robots.hpp"
#include "engine/scene/visitors/object_reader.hpp"

#include <fstream>
#include <sstream>

namespace tumble {
namespace {

/// Whether the file is a scene at all; if not, there is one fault instead of many.
bool is_scene(const JsonNode& root, const std::string& file, FaultList& faults) {
  if (!root.is(JsonNode::Kind::object)) {
    faults.add({file, root.line, {}, "a scene is an object, got " + brief(root)});
    return false;
  }
  const JsonNode* version = root.find("tumble_scene");
  if (!version) {
    faults.add({file,
                root.line,
                {},
                "the key 'tumble_scene' is missing; a scene starts with \"tumble_scene\": 1"});
    return false;
  }
  if (!version->is(JsonNode::Kind::integer) || version->negative ||
      version->magnitude != uint64_t{SceneDescription::version}) {
    faults.add({file, version->line, "tumble_scene",
                "must be 1, got " + brief(*version) + "; a later version needs a later Tumble"});
    return false;
  }
  return true;
}

}  // namespace

SceneRead read_scene(std::string_view text, const std::string& file, const ReadOptions& options) {
  SceneRead out;
  FaultList faults;
  const auto finish = [&] {
    out.faults = faults.sorted();
    return std::move(out);
  };
  auto root = parse_json(text, file, faults);
  if (!root || !is_scene(*root, file, faults)) return finish();
  // Overrides that decide about robots come first, since robots must be read before their parts can
  // be changed.
  const auto comes_first = [](const std::string& o) {
    return o.starts_with("robots") || o.starts_with("parameters");
  };
  for (const std::string& o : options.overrides)
    if (comes_first(o)) apply_override(*root, o, faults);
  expand_robots(*root, file, faults, out.scene.warnings);
  for (const std::string& o : options.overrides)
    if (!comes_first(o)) apply_override(*root, o, faults);

  ReadContext context{file, faults, {}};
  read_object(context, *root, {}, struct_ref(out.scene));
  auto source = std::make_shared<SceneSource>();
  source->file = file;
  source->folder = std::filesystem::path(file).parent_path();
  source->tree = std::make_shared<JsonNode>(std::move(*root));
  out.scene.source = source;
  // A value that could not be read has kept its default, which must not cause further faults.
  const FaultList read_faults = faults;
  for (Fault& f : validate(out.scene))
    if (!read_faults.covers(f.path)) faults.add(std::move(f));
  return finish();
}

SceneRead load_scene(const std::filesystem::path& file, const ReadOptions& options) {
  const auto refuse = [&](std::string why) {
    SceneRead out;
    out.faults.push_back({file.string(), 0, {}, std::move(why)});
    return out;
  };
  std::error_code error;
  if (!std::filesystem::exists(file, error)) return refuse("there is no such file");
  if (!std::filesystem::is_regular_file(file, error))
    return refuse("this is a folder, a device or a pipe, not a file");
  const auto size = std::filesystem::file_size(file, error);
  if (error) return refuse("cannot be read: " + error.message());
  if (size > JsonLimits{}.max_bytes)
    return refuse("the file has " + std::to_string(size) + " bytes; at most " +
                  std::to_string(JsonLimits{}.max_bytes) + " are read");
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  if (!in || !(text << in.rdbuf()).good()) {
    if (size > 0) return refuse("cannot be read");
  }
  return read_scene(std::move(text).str(), file.string(), options);
}

}  // namespace tumble
