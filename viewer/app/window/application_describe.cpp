// What the scene's file says, changed value by value.
#include "engine/scene/build/live_parts.hpp"
#include "engine/scene/outline/outline_edits.hpp"
#include "engine/scene/reader.hpp"
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

/// Whether a deed to the running world says the same in the file as was wanted there: an expression
/// that was typed, say, is more than the number that the world gets.
bool says_same(const std::string& text, const std::filesystem::path& file, const SceneEdit& edit,
               const std::string& wanted) {
  const auto saved = save_edits(text, file.string(), std::span(&edit, 1));
  const auto plain = [](const std::string& said) { return Json::parse(said, nullptr, true, true); };
  return saved && saved->left_out.empty() && plain(saved->text) == plain(wanted);
}

/// A number that was chosen here ("parameters.gap=3") would go on hiding the one that the file says
/// now, and follows what it is a number of to another name. Of a parameter that is written out the
/// choice is its value.
void keep_up_choices(std::vector<std::string>& chosen, const EditDescription& edit) {
  const std::string at = text_of(edit.path);
  if (edit.how == EditDescription::How::rename) {
    const std::string to = text_of(outer_path(edit.path) / edit.value);
    for (std::string& one : chosen)
      if (one.starts_with(at) && one.find_first_of("=.[", at.size()) == at.size())
        one.replace(0, at.size(), to);
    return;
  }
  std::erase_if(chosen, [&](const std::string& one) {
    const std::string path = one.substr(0, one.find('='));
    return path == at || path + ".value" == at || path == at + ".value" ||
           (edit.how == EditDescription::How::remove && path.starts_with(at + "."));
  });
}

}  // namespace

std::string Application::described_text() {
  return deeds_.unsaved().any() ? deeds_.unsaved().text() : scene_.file.text;
}

/// Called once a picture.
void Application::look_at_description() {
  if (ui_.shows(PanelId::description)) description_.look(described_text(), ui_.described);
}

void Application::edit_description(const EditDescription& edit) {
  if (recording_forbids("changing the scene")) return;
  SceneWish after = wish_of_now();
  const std::string now = described_text();
  auto done = description_.with(now, scene_.file.path, edit);
  if (!done) return ui_.toast(ToastKind::warning, "This is not possible", {done.error().message});
  const bool alone = !description_.has_draft();
  if (done->text == now && alone) return;
  ui_.described = done->place;
  const size_t deeds = deeds_.edits().deeds().size();
  if (!done->faults.empty()) return description_.keep(edit, std::move(done->faults), false, deeds);
  const std::string what = deed_of(edit);
  if (alone && describe_live(now, done->text, edit.path, what)) return;
  for (const EditDescription& earlier : description_.draft())
    keep_up_choices(after.overrides, earlier);
  keep_up_choices(after.overrides, edit);
  after.text = std::move(done->text);
  described_camera_ = !edit.path.empty() && edit.path[0].key == "cameras";
  if (edit.how == EditDescription::How::rename && edit.path.size() == 2 &&
      edit.path[0].key == "bodies")
    renaming_ = {edit.path[1].key, edit.value};
  described_along_.clear();
  for (const TakenAlong& one : done->along) described_along_.push_back(one.words());
  description_.keep(edit, {}, true, deeds);
  describing_ = true;
  choose(std::move(after), what, world_.frame().tick);
}

/// By a command to the running world, where there is one that says the same in the file.
bool Application::describe_live(const std::string& before, const std::string& after,
                                const ScenePath& path, const std::string& what) {
  const std::string list = path.empty() ? std::string() : path[0].key;
  const bool settings = list == "settings";
  constexpr std::string_view parts[] = {"emitters", "sensors", "forces", "particles"};
  if (!settings && (path.size() < 2 || std::ranges::find(parts, list) == std::end(parts)))
    return false;
  const SceneRead old = read_scene(before, scene_.file.path.string(), {scene_.wish.overrides});
  const SceneRead now = read_scene(after, scene_.file.path.string(), {scene_.wish.overrides});
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
