// What the scene's file says, changed value by value.
#include "engine/scene/build/body_defs.hpp"
#include "engine/scene/build/live_parts.hpp"
#include "engine/scene/outline/outline_edits.hpp"
#include "engine/scene/reader.hpp"
#include "engine/scene/saving/dependents.hpp"
#include "engine/scene/saving/json_text_edit.hpp"
#include "engine/scene/visitors/object_writer.hpp"
#include "engine/world/world.hpp"
#include "viewer/app/window/application.hpp"

#include <algorithm>
#include <iterator>
#include <span>
#include <utility>

#include <fmt/format.h>

namespace tumble {
namespace {

/// Whether an undo step to the running world says the same in the file as was wanted there: an
/// expression that was typed, say, is more than the number that the world gets.
bool says_same(const std::string& text, const std::filesystem::path& file, const SceneEdit& edit,
               const std::string& wanted) {
  const auto saved = save_edits(text, file.string(), std::span(&edit, 1));
  const auto plain = [](const std::string& said) { return Json::parse(said, nullptr, true, true); };
  return saved && saved->left_out.empty() && plain(saved->text) == plain(wanted);
}

/// A body that is one and needs no file of a mesh, as the scene describes it.
std::optional<BodyDef> described_body(const SceneDescription& scene, const std::string& name) {
  const BodyDescription* body = scene.bodies.find(name);
  if (!body || !body->repeat.empty()) return std::nullopt;
  std::vector<std::string> warnings;
  const FaultSink none = [](const std::string&, const std::string&) {};
  const SceneMeshes no_meshes({}, none, warnings);
  auto defs = body_defs(scene, name, *body, no_meshes, none, warnings);
  return defs.size() == 1 ? std::optional(std::move(defs[0])) : std::nullopt;
}

/// Whether a body begins at the same place with the same motion.
bool begin_alike(const BodyDef& a, const BodyDef& b) {
  return a.pose.x == b.pose.x && a.pose.q.coeffs() == b.pose.q.coeffs() &&
         a.velocity == b.velocity && a.angular_velocity == b.angular_velocity &&
         a.starts_asleep == b.starts_asleep;
}

/// What a text says of a key of a body, where a definition has that in another form.
std::vector<WrittenKey> written_key(const std::string& text, const std::string& body,
                                    const std::string& key) {
  if (key != "course" && key != "drawn") return {};
  const JsonTextEdit file(text);
  const auto said = file.value(ScenePath{} / "bodies" / body / key);
  return {{key, said ? std::optional(std::string(*said)) : std::nullopt}};
}

/// Whether nothing in the scene takes its own place from that of this body, as anchors of joints
/// and springs do and what fills a fluid.
bool begins_alone(const SceneDescription& scene, const std::string& text, const std::string& name) {
  return scene.particles.items.empty() && taken_along(text, {}, RemovedBody{name}).empty();
}

/// Gives a body of the running world the values in which two descriptions differ, one of whose keys
/// was changed. Its motion goes on where it begins alike in both; at the first tick it begins
/// anew.
void carry_over(BodyDef& def, const BodyDef& before, const BodyDef& after, std::string_view key) {
  const auto carry = [&](auto... members) {
    ((before.*members == after.*members ? void() : void(def.*members = after.*members)), ...);
  };
  carry(&BodyDef::type, &BodyDef::velocity, &BodyDef::angular_velocity, &BodyDef::mass,
        &BodyDef::inertia, &BodyDef::products, &BodyDef::centre, &BodyDef::group,
        &BodyDef::gravity_scale, &BodyDef::fluid_friction, &BodyDef::can_sleep,
        &BodyDef::starts_asleep, &BodyDef::precise, &BodyDef::hull_mass);
  if (!(before.pose.x == after.pose.x)) def.pose.x = after.pose.x;
  if (!(before.pose.q.coeffs() == after.pose.q.coeffs())) def.pose.q = after.pose.q;
  if (key == "course" || (after.course && !begin_alike(before, after))) {
    def.course = after.course;  // which begins at the pose of the description
    def.pose = after.pose;
    def.velocity = after.velocity;
    def.angular_velocity = after.angular_velocity;
  }
  if (key == "drawn") def.drawn = after.drawn;
  if (key == "shape" || key == "shapes" || key == "material" || key == "density")
    def.shapes = after.shapes;
  if (key == "colour" || key == "look") def.look = after.look;
}

/// Where an item stands after one has been moved.
size_t place_after(size_t item, size_t from, size_t to) {
  if (item == from) return to;
  if (from < item && item <= to) return item - 1;
  return to <= item && item < from ? item + 1 : item;
}

/// A number that was chosen here ("parameters.gap=3") would go on hiding the one that the file says
/// now, and follows what it is a number of to another name or place. Of a parameter that is written
/// out the choice is its value.
void keep_up_choices(std::vector<std::string>& chosen, const EditDescription& edit) {
  const std::string at = text_of(edit.path);
  if (edit.how == EditDescription::How::rename) {
    const std::string to = text_of(outer_path(edit.path) / edit.value);
    for (std::string& one : chosen)
      if (one.starts_with(at) && one.find_first_of("=.[", at.size()) == at.size())
        one.replace(0, at.size(), to);
    return;
  }
  if (edit.how == EditDescription::How::move) {
    const std::string list = text_of(outer_path(edit.path)) + "[";
    const size_t from = *edit.path.back().index, to = size_t(int(from) + std::stoi(edit.value));
    for (std::string& one : chosen) {
      if (!one.starts_with(list)) continue;
      const size_t end = one.find(']', list.size()), now = std::stoul(one.substr(list.size()));
      one.replace(list.size(), end - list.size(), std::to_string(place_after(now, from, to)));
    }
    return;
  }
  std::erase_if(chosen, [&](const std::string& one) {
    const std::string path = one.substr(0, one.find('='));
    return path == at || path + ".value" == at || path == at + ".value" ||
           (edit.how == EditDescription::How::remove && path.starts_with(at + "."));
  });
}

}  // namespace

/// With all that was changed since the scene was opened, saved or not.
std::string Application::described_text() {
  return undo_steps_.unsaved().text();
}

/// Called once a picture.
void Application::look_at_description() {
  if (ui_.shows(PanelId::description))
    description_.look(described_text(), ui_.described, world_.frame());
}

/// The scene's text with a change of its description, if that is to be taken: a change that makes
/// no scene becomes a part of the draft.
std::optional<DescriptionController::Changed> Application::described_with(
    const EditDescription& edit) {
  const std::string now = described_text();
  auto done = description_.with(now, scene_.file.path, edit);
  if (!done) {
    ui_.toast(ToastKind::warning, "This is not possible", {done.error().message});
    return std::nullopt;
  }
  if (done->text == now && !description_.has_draft()) return std::nullopt;
  ui_.described = done->place;
  if (done->faults.empty()) return *std::move(done);
  description_.keep(edit, std::move(done->faults), false, undo_steps_.edits().undo_steps().size());
  return std::nullopt;
}

void Application::edit_description(const EditDescription& edit) {
  if (recording_forbids("changing the scene")) return;
  const std::string now = described_text();
  auto done = described_with(edit);
  if (!done) return;
  const std::string what = undo_step_of(edit);
  // The panel shows the new value from now on, not when the session has answered: it may be in a
  // slow tick, and pictures do not wait for it.
  if (!description_.has_draft() && describe_live(now, done->text, edit.path, what))
    return undo_steps_.unsaved().expect(std::move(done->text));
  OpenRequest after = request_of_now();
  if (described_text() != now && !(done = described_with(edit))) return;
  for (const EditDescription& earlier : description_.draft())
    keep_up_choices(after.overrides, earlier);
  keep_up_choices(after.overrides, edit);
  after.text = std::move(done->text);
  described_camera_ = !edit.path.empty() && edit.path[0].key == "cameras";
  if (edit.how == EditDescription::How::rename && edit.path.size() == 2)
    renaming_ = Renaming{edit.path[0].key, edit.path[1].key, edit.value};
  described_along_.clear();
  for (const TakenAlong& one : done->along) described_along_.push_back(one.words());
  description_.keep(edit, {}, true, undo_steps_.edits().undo_steps().size());
  describing_ = true;
  choose(std::move(after), what, world_.frame().tick);
}

/// By a command to the running world, where there is one that says the same in the file.
bool Application::describe_live(const std::string& before, const std::string& after,
                                const ScenePath& path, const std::string& what) {
  const std::string list = path.empty() ? std::string() : path[0].key;
  if (list == "bodies") return describe_body_live(before, after, path, what);
  const bool settings = list == "settings";
  constexpr std::string_view parts[] = {"emitters", "sensors", "forces", "particles"};
  if (!settings && (path.size() < 2 || std::ranges::find(parts, list) == std::end(parts)))
    return false;
  const SceneRead old = read_scene(before, scene_.file.path.string(), {scene_.request.overrides});
  const SceneRead now = read_scene(after, scene_.file.path.string(), {scene_.request.overrides});
  if (!old.ok() || !now.ok()) return false;
  if (settings) {
    const ChangedSettings change{old.scene.settings, now.scene.settings};
    if (!says_same(before, scene_.file.path, change, after)) return false;
    change_settings(now.scene.settings);
    return true;
  }
  const std::string& name = path[1].key;
  const auto part = find_part(old.scene, list, name), changed = find_part(now.scene, list, name);
  if (part && changed) {
    if (!says_same(before, scene_.file.path, ChangedPart{name, *part, *changed}, after))
      return false;
    edit_part({name, *part, *changed, what});
    return true;
  }
  if (!part || !says_same(before, scene_.file.path, RemovedPart{name, *part}, after)) return false;
  remove_part({name, *part});
  return true;
}

/// The same for a value of one body. Where and how it begins, and its course, can only be changed
/// so before the first tick; later the run is another one.
bool Application::describe_body_live(const std::string& before, const std::string& after,
                                     const ScenePath& path, const std::string& what) {
  if (path.size() < 3) return false;
  const SceneRead old = read_scene(before, scene_.file.path.string(), {scene_.request.overrides});
  const SceneRead now = read_scene(after, scene_.file.path.string(), {scene_.request.overrides});
  if (!old.ok() || !now.ok()) return false;
  const std::string &name = path[1].key, &key = path[2].key;
  const auto was = described_body(old.scene, name), is = described_body(now.scene, name);
  if (!was || !is) return false;
  const bool at_start = !begin_alike(*was, *is) || key == "course";
  if (at_start && !(stands_at_start() && begins_alone(old.scene, before, name))) return false;
  // In the scene's own world a force may wake what it begins to pull at.
  if (was->starts_asleep != is->starts_asleep && !old.scene.forces.items.empty()) return false;
  const std::vector<WrittenKey> written = written_key(after, name, key);
  if (!says_same(before, scene_.file.path, ChangedBody{name, *was, *is, written}, after))
    return false;
  const Frame& frame = world_.frame();
  for (size_t slot = 0; slot < frame.body_slots(); ++slot) {
    if (frame.body(slot).id.is_null() || frame.info(slot).name != name) continue;
    edit_body({frame.body(slot).id, what,
               [was = *was, is = *is, key](BodyDef& def) { carry_over(def, was, is, key); },
               written, at_start});
    return true;
  }
  return false;
}

/// Whether the world waits before its first tick, whatever moment the picture still shows.
bool Application::stands_at_start() const {
  const SessionCounters now = world_.session().counters();
  return now.paused && now.tick == 0 && now.way_to == 0 && now.under_way_seconds == 0;
}

/// The scene with what was changed in its description is there, or cannot be.
void Application::finish_description(const Status& opened) {
  if (!description_.opening()) return;
  if (opened) {
    if (!described_along_.empty())
      ui_.toast(ToastKind::info, "What needed it is gone, too",
                std::exchange(described_along_, {}));
    return description_.leave_draft();
  }
  const std::string text = opened.error().text();
  std::vector<std::string> faults;
  for (size_t begin = 0; begin < text.size();) {
    const size_t end = std::min(text.find('\n', begin), text.size());
    if (end > begin) faults.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  description_.refuse(std::move(faults));
}

}  // namespace tumble
