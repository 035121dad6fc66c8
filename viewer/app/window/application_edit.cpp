// The user's changes in the world, and undo.
#include "engine/world/world.hpp"
#include "viewer/app/editing/displaced_body.hpp"
#include "viewer/app/editing/mesh_cure.hpp"
#include "viewer/app/verify/differences.hpp"
#include "viewer/app/window/application.hpp"

#include <algorithm>
#include <variant>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace tumble {
namespace {

/// Distance of a copy from its original, over the width of the original [-].
constexpr double copy_distance = 1.1;

void put_written(std::vector<WrittenKey>& all, const WrittenKey& one) {
  const auto known = std::ranges::find(all, one.key, &WrittenKey::key);
  known == all.end() ? all.push_back(one) : void(*known = one);
}

/// What an edit does to a body that has this definition, and stands at the pose `now`.
ChangedBody change_by(const EditBody& edit, const BodyDef& known, const Pose& now, bool begun) {
  BodyDef wanted = known;
  if (!edit.at_start) wanted.pose = now;
  edit.change(wanted);
  ChangedBody out = edit.at_start ? ChangedBody{known.name, known, std::move(wanted)}
                                  : changed_at(known, now, std::move(wanted), begun);
  for (const WrittenKey& key : edit.written) put_written(out.written, key);
  return out;
}

/// Adds to what a gesture has changed already what it changes now by the same edit.
void go_on_with(ChangedBody& change, const EditBody& edit, const ChangedBody& now) {
  edit.change(change.after);
  if (now.before.course) {  // its pose is that at which the course begins
    change.after.pose = now.after.pose;
    change.after.course = now.after.course;
  }
  for (const WrittenKey& key : now.written) put_written(change.written, key);
}

}  // namespace

std::string Application::name_of(BodyId id) const {
  const auto slot = find_slot(world_.frame(), id);
  const std::string name = slot ? world_.frame().info(*slot).name : std::string();
  return name.empty() ? fmt::format("body {}", id.index) : name;
}

/// To be called before every change that the user makes. What a widget requests in every picture
/// while it is held, or while its text is being typed, is one undo step.
UndoStepEdits Application::begin_edit(std::string what, bool by_gesture) {
  undo_steps_.unsaved().note();
  undo_steps_.choices().forget_taken_back();
  leave_loop();
  return undo_steps_.begin(session(), std::move(what), by_gesture && in_gesture(),
                           world_.frame().tick, selection_.all());
}

bool Application::in_gesture() const {
  return pointer_.held().button(PointerButton::left) || host_.wants_keys();
}

void Application::take_back() {
  end_drag();
  if (description_.opening()) return;  // it is known soon whether that makes a scene
  if (description_.newer_than(undo_steps_.edits().undo_steps().size())) return take_back_draft();
  tools_.parts.note();
  const auto back = undo_steps_.take_back(session(), selection_.all());
  if (!back) {
    if (!go_back_on(undo_steps_.choices().back()))
      ui_.toast(ToastKind::info, "There is nothing to take back");
    return;
  }
  // The trial is of a scene that is no longer the one shown: what was deleted is back.
  (void)tools_.refusal.take_left();
  removal_trial_.reset();
  ui_.toast(ToastKind::info, "Taken back: " + back->what);
}

/// The newest change of the description that makes no scene yet.
void Application::take_back_draft() {
  if (!description_.has_draft() || description_.opening()) return;
  const std::string what = description_.take_back(described_text(), scene_.file.path);
  ui_.toast(ToastKind::info, "Taken back: " + what);
}

void Application::do_again() {
  end_drag();
  leave_loop();
  tools_.parts.note();
  const auto back = undo_steps_.do_again(session(), selection_.all());
  if (!back) {
    if (!go_back_on(undo_steps_.choices().again()))
      ui_.toast(ToastKind::info, "There is nothing to do again");
    return;
  }
  ui_.toast(ToastKind::info, "Done again: " + back->what);
}

/// Names of the selected bodies for the descriptions of undo steps.
std::string Application::selected_names() const {
  if (selection_.size() == 1) return name_of(selection_.main());
  return fmt::format("{} and {} more", name_of(selection_.main()), selection_.size() - 1);
}

/// Begins an undo step that removes something on which other parts may depend.
Removal Application::begin_removal(std::string what) {
  const UndoStepEdits edits = begin_edit(std::move(what));
  return Removal(scene_.file, undo_steps_.edits().file_edits(), edits, tools_.parts,
                 tools_.refusal);
}

void Application::delete_selected() {
  if (selection_.empty()) return;
  const Removal removal = begin_removal("Delete " + selected_names());
  session().post([all = selection_.all(), removal](World& world) {
    for (const BodyId id : all) {
      const auto def = world.body_def(id);
      if (world.destroy_body(id).ok() && def) removal.take(world, RemovedBody{def->name});
    }
    removal.finish(world);
  });
  tools_.parts.note();
  selection_.clear();
}

void Application::duplicate_selected() {
  if (selection_.empty()) return ui_.toast(ToastKind::info, "Select a body to copy it");
  Aabb bounds;
  for (const BodyId id : selection_.all()) {
    const auto slot = find_slot(world_.frame(), id);
    if (slot) bounds.include(body_bounds(world_.frame(), *slot));
  }
  if (bounds.empty())
    return ui_.toast(ToastKind::info, "What has no end is not copied: " + selected_names());
  // To the right in the picture, along a world axis.
  const Camera& camera = camera_.camera();
  const Vec3 right = (camera.target - camera.eye).cross(camera.up);
  const int axis = std::abs(right.x()) >= std::abs(right.z()) ? 0 : 2;
  Vec3 aside = Vec3::Zero();
  aside[axis] = std::copysign(copy_distance * bounds.extent()[axis], right[axis]);
  const UndoStepEdits edits = begin_edit("Copy " + selected_names());
  tools_.duplicator.copy(session(), selection_, aside, session().paused(), edits);
  tools_.parts.name_springs(session(), edits);
  tools_.parts.note();
}

void Application::change_settings(const WorldSettings& wanted) {
  const std::vector<std::string> names = changed_settings(settings_.value(), wanted);
  const std::string what = fmt::format("Change {}", fmt::join(names, ", "));
  const bool goes_on = undo_steps_.goes_on(what, in_gesture());
  if (!goes_on) settings_before_ = settings_.value();
  const UndoStepEdits edits = begin_edit(what, true);
  if (goes_on && changed_settings(settings_before_, wanted).empty()) {
    // A typed number was cancelled by Esc, or a slider set back.
    undo_steps_.drop_newest();
  }
  session().post([edits, wanted](World& world) {
    if (edits->empty()) edits->push_back(ChangedSettings{world.settings(), wanted});
    if (auto* change = std::get_if<ChangedSettings>(&edits->front())) change->after = wanted;
  });
  settings_.change(session(), wanted);
}

/// Shows a hint for the active tool or way of moving as long as it is active.
void Application::keep_hints() {
  const auto keep = [&](bool holds, const std::string& words,
                        const std::vector<std::string>& lines) {
    const auto said = std::ranges::find(ui_.toasts, words, &Toast::title);
    if (said != ui_.toasts.end())
      said->seconds_left = holds ? Toast{}.seconds_left : 0;
    else if (holds)
      ui_.toast(ToastKind::info, words, lines);
  };
  keep(ui_.building && tools_.builder.half_way(), "Now the other body, or nothing for the world",
       {});
  std::string keys;
  for (const Action way : {Action::fly_forward, Action::fly_left, Action::fly_back,
                           Action::fly_right, Action::fly_down, Action::fly_up})
    keys += shortcut_of(way) + " ";
  keep(pointer_.tool().free_flight(), "Flying",
       {fmt::format("{}move, a drag looks around, {} ends it.", keys,
                    shortcut_of(Action::toggle_free_flight))});
}

/// Handles a click on the picture in building mode.
void Application::build_at(double x, double y, const std::optional<Pick>& pressed) {
  const auto hit = pressed && pressed->distance <= placing_reach() ? pressed : std::nullopt;
  const Camera& camera = camera_.camera();
  const Ray ray = pixel_ray(camera_.seen(), x, y, layout_.area.width(), layout_.area.height());
  const double view = (camera.target - camera.eye).norm();
  if (const auto* part = std::get_if<NewPart>(&ui_.build.what))
    return add_parts(part->kind, hit ? hit->x_world : ray.origin + view * ray.direction,
                     hit ? hit->normal : Vec3::UnitY(),
                     Builder::usual_size(hit ? hit->distance : view));
  std::optional<Addition> made;
  if (const auto* chosen = std::get_if<NewMesh>(&ui_.build.what)) {
    const auto mesh = tools_.mesh_palette.ready();
    if (!mesh || !(mesh->chosen == *chosen))
      return tools_.mesh_palette.fault().empty()
                 ? ui_.toast(ToastKind::info, "The mesh is still being read")
                 : ui_.toast(ToastKind::warning, "This mesh cannot be placed",
                             {tools_.mesh_palette.fault()});
    made =
        Builder::mesh_body(ui_.build, *mesh, hit ? hit->x_world : ray.origin + view * ray.direction,
                           hit ? hit->normal : Vec3::UnitY());
  } else {
    made = tools_.builder.click(ui_.build, world_.frame(), ray, hit, view);
  }
  if (made) {
    const UndoStepEdits edits = begin_edit(made->what);
    using Bodies = std::vector<BodyId>;
    tools_.duplicator.await(session().call(
        [make = made->make, edits, refusal = tools_.refusal](World& world) -> Bodies {
          auto added = make(world);
          if (!added) {
            refusal.say(added.error());
            return {};
          }
          edits->push_back(std::move(added->edit));
          return added->body.is_null() ? Bodies{} : Bodies{added->body};
        }));
    tools_.parts.name_springs(session(), edits);
    tools_.parts.note();
    // Shows joints and springs, so that the new one is visible.
    if (std::holds_alternative<NewJoint>(ui_.build.what) ||
        std::holds_alternative<NewSpring>(ui_.build.what))
      building_overlays_.switch_on(&Overlays::joints, ui_.overlays);
  } else if (tools_.builder.half_way()) {
    keep_hints();
  } else {
    ui_.toast(ToastKind::info, "It begins at a body");
  }
}

void Application::edit_body(const EditBody& edit) {
  if (const auto def = tools_.selected_def.def(); def && edit.id == selection_.main()) {
    BodyDef after = *def;
    edit.change(after);
    if (after.name != def->name) return rename_body(def->name, after.name);
  }
  const UndoStepEdits edits = begin_edit(edit.what, true);
  tools_.selected_def.expect(edit);
  tools_.pinned_defs.expect(edit);
  session().post([edit, edits, refusal = tools_.refusal](World& world) {
    const auto before = world.body_def(edit.id);
    if (!before) return;
    if (edit.at_start && world.tick() != 0)
      return refusal.say({ErrorCode::invalid_argument,
                          "the run has begun meanwhile: change it once more, and it begins anew",
                          {},
                          {}});
    ChangedBody now = change_by(edit, *before, world.body(edit.id)->body_frame(), world.tick() > 0);
    if (const Status done = world.set_body(edit.id, now.after); !done)
      return refusal.say(done.error());
    if (edits->empty())
      edits->push_back(std::move(now));
    else if (auto* change = std::get_if<ChangedBody>(&edits->front()))
      go_on_with(*change, edit, now);
  });
}

/// Applies a new collision representation of a mesh once it has been computed.
void Application::take_mesh_modes() {
  auto made = tools_.mesh_modes.take();
  if (!made) return;
  if (!made->parts)
    return ui_.toast(ToastKind::warning, "This is not possible",
                     {with_cure_in_window(made->parts.error()).text()});
  edit_body({made->request.id, made->request.what,
             [group = made->request.group, mesh = made->request.source->mesh,
              parts = *made->parts](BodyDef& def) {
               // Only if the body still has the mesh from which the shapes were computed.
               const auto groups = shape_groups(def);
               if (group >= groups.size()) return;
               const auto source = source_of(def, groups[group]);
               if (source && source->mesh == mesh) replace_group(def, group, parts);
             }});
  if (!made->parts->note.empty())
    ui_.toast(ToastKind::info, made->request.what, {made->parts->note});
}

void Application::edit_joint(const EditJoint& edit) {
  const UndoStepEdits edits = begin_edit(edit.what, true);
  tools_.selected_def.expect(edit);
  tools_.pinned_defs.expect(edit);
  session().post([edit, edits, refusal = tools_.refusal](World& world) {
    const JointDef* now = world.joint(edit.id);
    if (!now) return;
    const JointDef before = *now;
    JointDef after = before;
    edit.change(after);
    if (const Status done = world.set_joint(edit.id, after); !done)
      return refusal.say(done.error());
    if (edits->empty()) edits->push_back(ChangedJoint{before, after});
    if (auto* change = std::get_if<ChangedJoint>(&edits->front())) edit.change(change->after);
  });
}

void Application::remove_joint(JointId id) {
  std::string name = "joint";
  for (const JointFrame& joint : *world_.frame().joints)
    if (joint.id == id && !joint.name.empty()) name = joint.name;
  const Removal removal = begin_removal("Remove " + name);
  tools_.selected_def.ask_again();
  session().post([id, name, removal](World& world) {
    if (world.destroy_joint(id).ok()) removal.take(world, RemovedJoint{name});
    removal.finish(world);
  });
}

}  // namespace tumble
