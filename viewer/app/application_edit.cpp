// What a person changes in the world, and takes back.
#include "engine/world/world.hpp"
#include "viewer/app/application.hpp"
#include "viewer/app/changed_settings.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace tumble {
namespace {

/// How far a copy stands from its original, over the width of that.
constexpr double copy_distance = 1.1;

}  // namespace

std::string Application::name_of(BodyId id) const {
  const auto slot = find_slot(world_.frame(), id);
  const std::string name = slot ? world_.frame().info(*slot).name : std::string();
  return name.empty() ? fmt::format("body {}", id.index) : name;
}

/// Before everything that a person does to the world. What a widget asks for in every picture while
/// it is held, or while its text is being typed, is one deed.
DeedEdits Application::begin_edit(std::string what, bool by_gesture) {
  const bool goes_on = by_gesture && in_gesture();
  if (goes_on && gesture_ == what && !edits_.empty()) return edits_.newest();
  gesture_ = goes_on ? what : std::string();
  // What came after this moment will not come any more.
  newest_tick_ = world_.frame().tick;
  return edits_.begin(session(), std::move(what), world_.frame().tick);
}

bool Application::in_gesture() const {
  return pointer_.held().button(PointerButton::left) || host_.wants_keys();
}

void Application::take_back() {
  end_drag();
  if (const auto what = edits_.undo(session()))
    ui_.toast(ToastKind::info, "Taken back: " + *what);
  else
    ui_.toast(ToastKind::info, "There is nothing to take back");
}

void Application::do_again() {
  end_drag();
  if (const auto what = edits_.redo(session()))
    ui_.toast(ToastKind::info, "Done again: " + *what);
  else
    ui_.toast(ToastKind::info, "There is nothing to do again");
}

void Application::delete_selected() {
  if (!selected_) return;
  const DeedEdits edits = begin_edit("Delete " + name_of(selected_));
  session().post([id = selected_, edits](World& world) {
    const auto def = world.body_def(id);
    if (world.destroy_body(id).ok() && def) edits->push_back(RemovedBody{def->name});
  });
  selected_ = {};
}

void Application::duplicate_selected() {
  const auto slot = find_slot(world_.frame(), selected_);
  if (!slot) return ui_.toast(ToastKind::info, "Select a body to copy it");
  const Aabb bounds = body_bounds(world_.frame(), *slot);
  if (bounds.empty())
    return ui_.toast(ToastKind::info, "What has no end is not copied: " + name_of(selected_));
  // To the right of the picture, along an axis of the world.
  const Camera& camera = camera_.camera();
  const Vec3 right = (camera.target - camera.eye).cross(camera.up);
  const int axis = std::abs(right.x()) >= std::abs(right.z()) ? 0 : 2;
  Vec3 aside = Vec3::Zero();
  aside[axis] = std::copysign(copy_distance * bounds.extent()[axis], right[axis]);
  const DeedEdits edits = begin_edit("Copy " + name_of(selected_));
  duplicator_.copy(session(), selected_, aside, session().paused(), edits);
}

void Application::change_settings(const WorldSettings& wanted) {
  const std::vector<std::string> names = changed_settings(settings_.value(), wanted);
  const DeedEdits edits = begin_edit(fmt::format("Change {}", fmt::join(names, ", ")), true);
  session().post([edits, wanted](World& world) {
    if (edits->empty()) edits->push_back(ChangedSettings{world.settings(), wanted});
    if (auto* change = std::get_if<ChangedSettings>(&edits->front())) change->after = wanted;
  });
  settings_.change(session(), wanted);
}

/// A click on the picture while something is being built.
void Application::build_at(double x, double y, const std::optional<Pick>& hit) {
  const Camera& camera = camera_.camera();
  const Ray ray = pixel_ray(camera, x, y, double(ui_list_.width), double(ui_list_.height));
  auto made =
      builder_.click(ui_.build, world_.frame(), ray, hit, (camera.target - camera.eye).norm());
  if (made) {
    const DeedEdits edits = begin_edit(made->what);
    session().post([make = made->make, edits, refusal = refusal_](World& world) {
      auto edit = make(world);
      if (edit)
        edits->push_back(*std::move(edit));
      else
        refusal.say(edit.error());
    });
  } else if (builder_.half_way()) {
    ui_.toast(ToastKind::info, "Now the other body, or nothing for the world");
  } else {
    ui_.toast(ToastKind::info, "It begins at a body");
  }
}

void Application::change_parameter(const ChangeParameter& change) {
  SceneWish wish = scene_.wish;
  const std::string path = fmt::format("parameters.{}=", change.name);
  std::erase_if(wish.overrides, [&](const std::string& o) { return o.starts_with(path); });
  wish.overrides.push_back(fmt::format("{}{}", path, change.value));
  open(std::move(wish));
}

/// Shows what saving would write; asked for once more it writes that.
void Application::save_scene() {
  if (ui_.shows(PanelId::save) && saver_.preview()) return write_scene(ui_.save_file);
  ui_.hidden = false;
  ui_.shows(PanelId::save) = true;
  ui_.save_file.clear();
  std::vector<SceneEdit> numbers;
  for (const SceneParameter& p : scene_.parameters)
    for (const std::string& o : scene_.wish.overrides)
      if (o.starts_with(fmt::format("parameters.{}=", p.name)))
        numbers.push_back(ChangedParameter{p.name, p.value});
  saver_.prepare(session(), edits_.file_edits(), std::move(numbers));
}

void Application::write_scene(const std::string& file) {
  ui_.shows(PanelId::save) = false;
  if (const Status done = saver_.write(file); !done)
    return ui_.toast(ToastKind::error, "The scene was not saved", {done.error().text()});
  ui_.toast(ToastKind::info, "Saved to " + file);
}

void Application::edit_body(const EditBody& edit) {
  const DeedEdits edits = begin_edit(edit.what, true);
  selected_def_.expect(edit);
  session().post([edit, edits, refusal = refusal_](World& world) {
    const auto before = world.body_def(edit.id);
    if (!before) return;
    BodyDef after = *before;
    edit.change(after);
    if (const Status done = world.set_body(edit.id, after); !done) return refusal.say(done.error());
    if (edits->empty()) edits->push_back(ChangedBody{before->name, *before, after});
    if (auto* change = std::get_if<ChangedBody>(&edits->front())) edit.change(change->after);
  });
}

}  // namespace tumble
