// Emitters, sensors, forces and particles: added by clicks, changed and removed in their panel.
#include "engine/world/world.hpp"
#include "viewer/app/editing/new_part.hpp"
#include "viewer/app/window/application.hpp"

#include <fmt/format.h>

namespace tumble {

void Application::add_parts(PartKind kind, const Vec3& at, const Vec3& normal, double size) {
  PartPlace place{at, normal, size, {}};
  if (const auto slot = find_slot(world_.frame(), selection_.main()))
    place.body = world_.frame().info(*slot).name;
  const auto made = new_parts(kind, place, *tools_.parts.parts());
  if (made.empty()) return;
  const auto& [name, part] = made.back();
  const UndoStepEdits edits = begin_edit("Add " + name);
  for (const auto& [one_name, one] : made) tools_.parts.expect(one_name, one);
  session().post([made, edits, parts = tools_.parts.parts(), live = tools_.parts.live(),
                  refusal = tools_.refusal](World& world) {
    for (const auto& [one_name, one] : made) {
      if (const Status done = live->set(world, *parts, one_name, one); !done)
        return refusal.say(done.error());
      edits->push_back(AddedPart{one_name, one});
    }
  });
  tools_.parts.note();
  ui_.part = {std::string(list_of(part)), name};
  ui_.shows(PanelId::parts) = true;
  if (std::holds_alternative<SensorDescription>(part))
    building_overlays_.switch_on(&Overlays::sensors, ui_.overlays);
}

void Application::edit_part(const EditPart& edit) {
  const UndoStepEdits edits = begin_edit(edit.what, true);
  tools_.parts.expect(edit.name, edit.after);
  session().post([edit, edits, parts = tools_.parts.parts(), live = tools_.parts.live(),
                  refusal = tools_.refusal](World& world) {
    if (const Status done = live->set(world, *parts, edit.name, edit.after, &edit.before); !done)
      return refusal.say(done.error());
    if (edits->empty()) edits->push_back(ChangedPart{edit.name, edit.before, edit.after});
    if (auto* change = std::get_if<ChangedPart>(&edits->front())) change->after = edit.after;
  });
  tools_.parts.note();
}

void Application::remove_part(const RemovePart& removal) {
  const Removal undo_step = begin_removal("Delete " + removal.name);
  tools_.parts.expect(removal.name, removal.part, true);
  session().post([removal, undo_step, live = tools_.parts.live()](World& world) {
    // It may be gone from the world already; it is removed from the file all the same.
    (void)live->remove(world, removal.name, removal.part);
    undo_step.take(world, RemovedPart{removal.name, removal.part});
    undo_step.finish(world);
  });
  tools_.parts.note();
}

/// Emitters are invisible, so each gets a cross at its place and an arrow in the direction of
/// emission. Those carried by a body are drawn on it.
void Application::draw_emitters() {
  if (!ui_.shows(PanelId::parts) && !ui_.shows(PanelId::build)) return;
  const Frame& frame = world_.frame();
  for (const auto& [name, d] : tools_.parts.parts()->emitters.items) {
    Pose pose = d.placement.pose();
    if (!d.carrier.empty()) {
      const Vec3* at = nullptr;
      for (size_t slot = 0; slot < frame.body_slots() && !at; ++slot)
        if (!frame.body(slot).id.is_null() && frame.info(slot).name == d.carrier) {
          const Pose& centre = frame.body(slot).pose;
          pose = Pose{centre.x - centre.direction(frame.info(slot).centre_body), centre.q} * pose;
          at = &centre.x;
        }
      if (!at) continue;
    }
    const double size = 0.04 * (camera_.camera().eye - pose.x).norm();
    const bool chosen = ui_.part.list == "emitters" && ui_.part.name == name;
    const auto line = [&](const Vec3& a, const Vec3& b) {
      LineSegment segment;
      segment.a = pose.point(size * a).cast<float>();
      segment.b = pose.point(size * b).cast<float>();
      segment.colour = chosen ? Vec4f(1, 0.45f, 0.05f, 1) : Vec4f(0.1f, 0.45f, 0.8f, 1);
      segment.width = 2.5f;
      canvas_.picture().lines.push_back(segment);
    };
    line({-0.4, 0, 0}, {0.4, 0, 0});
    line({0, 0, -0.4}, {0, 0, 0.4});
    line({0, 0, 0}, {0, 1.4, 0});
    for (const double side : {-0.2, 0.2}) line({0, 1.4, 0}, {side, 1.1, 0});
  }
}

}  // namespace tumble
