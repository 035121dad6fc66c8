#include "viewer/app/editing/description_controller.hpp"

#include "engine/scene/outline/outline_edits.hpp"
#include "engine/scene/reader.hpp"
#include "engine/world/frame.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

namespace tumble {
namespace {

/// "cameras" -> "camera": what one of a list is called until it gets a name.
std::string one_of(std::string_view list) {
  const auto without_end = [&](size_t count) {
    return std::string(list.substr(0, list.size() - count));
  };
  if (list.ends_with("ies")) return without_end(3) + "y";
  if (list.ends_with("shes")) return without_end(2);
  return list.ends_with('s') ? without_end(1) : std::string(list);
}

std::optional<JsonNode> parsed(const std::string& text) {
  FaultList faults;
  return parse_json(text, "", faults);
}

/// A place to add to that has no name yet gets one; copies are numbered.
Result<ScenePath> named_place(const std::string& text, ScenePath path) {
  if (path.empty() || path.back().index || !path.back().key.empty()) return path;
  const auto tree = parsed(text);
  const ScenePath map(path.begin(), path.end() - 1);
  const auto place = tree ? place_of(*tree, map) : std::nullopt;
  if (!place) return Error{ErrorCode::invalid_argument, "there is no such list", {}, {}};
  const auto taken = [&](const std::string& name) {
    return place->node && place->node->find(name) != nullptr;
  };
  const bool numbered = map.back().key == "copies";
  const std::string stem = numbered ? "" : one_of(map.back().key);
  std::string name = numbered ? "0" : stem;
  for (int n = numbered ? 1 : 2; taken(name); ++n)
    name = numbered ? fmt::format("{}", n) : fmt::format("{}_{}", stem, n);
  path.back().key = name;
  return path;
}

Result<DescriptionController::Changed> renamed_place(const std::string& text,
                                                     const EditDescription& edit) {
  DescriptionController::Changed out{{}, edit.path, {}, {}};
  out.place.back().key = edit.value;
  if (edit.path.size() == 2) {
    auto done = renamed(text, edit.path[0].key, edit.path[1].key, edit.value);
    if (!done) return done.error();
    out.text = *std::move(done);
    return out;
  }
  // What stands deeper is named by nothing else in the file, and may be called as the robot's own
  // file calls it.
  if (edit.value.empty())
    return Error{ErrorCode::invalid_argument, "a name has one letter at least", {}, {}};
  const auto tree = parsed(text);
  const auto place = tree ? place_of(*tree, edit.path) : std::nullopt;
  JsonTextEdit change(text);
  if (!place || change.value(outer_path(place->in_text) / edit.value) ||
      !change.rename(place->in_text, edit.value))
    return Error{ErrorCode::invalid_argument, "this name is taken", {}, {}};
  out.text = change.text();
  return out;
}

Result<DescriptionController::Changed> carried_out(const std::string& text,
                                                   const EditDescription& edit) {
  using How = EditDescription::How;
  DescriptionController::Changed out{{}, outer_path(edit.path), {}, {}};
  Result<std::string> done = text;
  switch (edit.how) {
    case How::set:
      done = with_value(text, edit.path, edit.value);
      break;
    case How::add: {
      const auto path = named_place(text, edit.path);
      if (!path) return path.error();
      out.place = *path;
      done = with_added(text, *path);
      break;
    }
    case How::remove:
      done = without(text, edit.path, out.along);
      break;
    case How::move:
      done = with_moved(text, edit.path, std::stoi(edit.value));
      break;
    case How::rename:
      return renamed_place(text, edit);
    case How::declare: {
      auto declared = with_parameter(text, edit.path);
      if (!declared) return declared.error();
      done = std::move(declared->text);
      break;
    }
  }
  if (!done) return done.error();
  out.text = *std::move(done);
  return out;
}

/// Bodies or joints of the world of which the scene's file says nothing itself: in a scene with
/// robots these are theirs.
std::vector<std::string> parts_of_robots(const JsonNode& scene, std::string_view list,
                                         const Frame& world) {
  std::vector<std::string> out;
  const auto take = [&](const std::string& name) {
    const std::string base = name.substr(0, name.find('['));
    const auto has = [&](std::string_view key) {
      const JsonNode* all = scene.find(key);
      return all && all->find(base);
    };
    if (!name.empty() && !has(list) && !has("emitters")) out.push_back(name);
  };
  if (list == "bodies")
    for (size_t slot = 0; slot < world.body_slots(); ++slot)
      if (!world.body(slot).id.is_null()) take(world.info(slot).name);
  if (list == "joints")
    for (const JointFrame& joint : *world.joints) take(joint.name);
  return out;
}

/// What the joints of a robot are called in its own file: those that turn where angles are asked
/// for, else those that slide.
std::vector<std::string> own_joints(const JsonNode& scene, const ScenePath& path,
                                    const Frame& world) {
  if (path.size() < 3 || path[0].key != "robots") return {};
  const std::string& robot = path[1].key;
  const bool turning = path[2].key.ends_with("_deg");
  if (path[2].key != "start" && path[2].key != "target" && !turning) return {};
  std::string prefix = robot + "_";
  if (const auto said = place_of(scene, ScenePath{} / "robots" / robot / "prefix");
      said && said->node)
    prefix = said->node->string;
  const JointKind kind = turning ? JointKind::revolute : JointKind::prismatic;
  const auto map = place_of(scene, {path.begin(), path.begin() + 3});
  std::vector<std::string> out;
  for (const JointFrame& joint : *world.joints) {
    if (joint.kind != kind || !joint.name.starts_with(prefix)) continue;
    const std::string name = joint.name.substr(prefix.size());
    if (!map || !map->node || !map->node->find(name)) out.push_back(name);
  }
  return out;
}

/// The names that stand in files of robots, which the scene's file does not have.
void add_names_of_robots(const JsonNode& scene, const Frame& world, Outline& outline) {
  const JsonNode* robots = scene.find("robots");
  if (!robots || robots->keys.empty()) return;
  for (auto& [list, names] : outline.names)
    for (std::string& name : parts_of_robots(scene, list, world)) names.push_back(std::move(name));
  outline.own_names = own_joints(scene, outline.path, world);
}

}  // namespace

void DescriptionController::look(const std::string& text, ScenePath& place, const Frame& world) {
  std::string now = text;
  if (!draft_.empty())
    if (auto drafted = with_draft(text)) now = std::move(drafted->text);
  const bool same = !stale_ && now == shown_text_ && text_of(place) == text_of(shown_);
  if (same) return;
  stale_ = false;
  const auto tree = now.empty() ? std::nullopt : parsed(now);
  view_.outline = nullptr;
  if (tree && tree->is(JsonNode::Kind::object)) {
    auto outline = std::make_shared<Outline>(outline_of(*tree, place));
    add_names_of_robots(*tree, world, *outline);
    place = outline->path;
    view_.outline = std::move(outline);
  }
  shown_text_ = std::move(now);
  shown_ = place;
}

Result<DescriptionController::Changed> DescriptionController::with_draft(
    const std::string& text) const {
  Changed out{text, {}, {}, {}};
  for (const EditDescription& edit : draft_) {
    auto next = carried_out(out.text, edit);
    if (!next) return next.error();
    next->along.insert(next->along.begin(), out.along.begin(), out.along.end());
    out = *std::move(next);
  }
  return out;
}

Result<DescriptionController::Changed> DescriptionController::with(
    const std::string& text, const std::filesystem::path& file, const EditDescription& edit) const {
  auto before = with_draft(text);
  if (!before) return before.error();
  auto after = carried_out(before->text, edit);
  if (!after) return after.error();
  after->along.insert(after->along.begin(), before->along.begin(), before->along.end());
  for (const Fault& fault : read_scene(after->text, file.string()).faults)
    after->faults.push_back(fault.path.empty() ? fault.message : fault.path + ": " + fault.message);
  return after;
}

void DescriptionController::keep(EditDescription edit, std::vector<std::string> faults,
                                 bool opening, size_t undo_steps) {
  undo_steps_then_.push_back(undo_steps);
  view_.draft.push_back(undo_step_of(edit));
  draft_.push_back(std::move(edit));
  view_.faults = std::move(faults);
  view_.opening = opening;
}

void DescriptionController::refuse(std::vector<std::string> faults) {
  view_.faults = std::move(faults);
  view_.opening = false;
}

std::string DescriptionController::take_back(const std::string& text,
                                             const std::filesystem::path& file) {
  draft_.pop_back();
  undo_steps_then_.pop_back();
  std::string what = std::move(view_.draft.back());
  view_.draft.pop_back();
  view_.faults.clear();
  view_.opening = false;
  if (draft_.empty()) return what;
  if (const auto now = with_draft(text))
    for (const Fault& fault : read_scene(now->text, file.string()).faults)
      view_.faults.push_back(fault.path + ": " + fault.message);
  return what;
}

void DescriptionController::leave_draft() {
  draft_.clear();
  undo_steps_then_.clear();
  view_.draft.clear();
  view_.faults.clear();
  view_.opening = false;
}

}  // namespace tumble
