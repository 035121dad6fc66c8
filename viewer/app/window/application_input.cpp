#include "engine/world/world.hpp"
#include "viewer/app/window/application.hpp"
#include "viewer/ui/layout.hpp"

#include <algorithm>
#include <cmath>

namespace tumble {

/// The search field gets the keyboard some pictures after it was opened: text typed until then is
/// kept for it, so that it is neither lost nor taken for commands.
std::vector<InputEvent> Application::in_time_for_search(std::span<const InputEvent> events) {
  const bool early = ui_.shows(PanelId::scenes) && !host_.wants_keys();
  std::vector<InputEvent> out;
  if (!early) out.swap(early_text_);
  for (const InputEvent& event : events)
    (early && std::holds_alternative<TextTyped>(event) ? early_text_ : out).push_back(event);
  ui_.search_focus = early && !early_text_.empty();
  return out;
}

void Application::route(std::span<const InputEvent> events, double dt) {
  const HeldInput before = pointer_.held();
  const bool search_was_shown = ui_.shows(PanelId::scenes);
  std::vector<InputEvent> for_scene;
  if (!in_gesture()) undo_steps_.end_gesture();
  for (const InputEvent& event : events) {
    pointer_.note(event);
    if (const auto* key = std::get_if<KeyPressed>(&event)) {
      if (key->down && route_key(*key)) continue;
      for_scene.push_back(event);
    } else if (const auto* press = std::get_if<PointerPressed>(&event)) {
      // A gesture that began in the scene also ends there, wherever the pointer is by then.
      if (!press->down || !host_.wants_pointer())
        for_scene.push_back(event);
      else
        pointer_.forget_click();
    } else if (std::holds_alternative<WheelTurned>(event)) {
      if (!host_.wants_pointer()) for_scene.push_back(event);
    } else if (const auto* files = std::get_if<FilesDropped>(&event)) {
      if (!files->paths.empty()) open(files->paths.front());
    } else if (std::holds_alternative<TextTyped>(event)) {
      // Typed in the same picture as the key that opened the search.
      if (ui_.shows(PanelId::scenes) && !search_was_shown) early_text_.push_back(event);
    } else {
      for_scene.push_back(event);
    }
  }
  pointer_.set_placing(ui_.building || (ui_.ruling && ui_.shows(PanelId::ruler)));
  const auto beside = layout_.area.places() ? second_.view(world_.view()) : std::nullopt;
  apply(pointer_.handle(for_scene, before, dt, {world_.view(), beside ? &*beside : nullptr},
                        camera(), gestures(),
                        !host_.wants_keys() && !ui_.shows(PanelId::scenes) && !dialog_open()));
  if (tools_.arranger.active()) hold_arranged();
  pointer_.choose_look(host_, world_.view(), camera_.seen());
}

/// Whether a modal dialog is open over the scene.
bool Application::dialog_open() const {
  return !ui_.hidden &&
         (ui_.shows(PanelId::question) || ui_.shows(PanelId::save) || ui_.shows(PanelId::help));
}

/// While a dialog is open, keys do not act on the world: only the dialog's own keys, those that
/// open another dialog, and those of the window itself work.
void Application::press_in_dialog(const KeyPressed& key) {
  const bool saves = ui_.shows(PanelId::save) && !ui_.shows(PanelId::question);
  if (saves && key.key == Key::enter && scene_file_.preview()) return write_scene(ui_.save_file);
  const auto action = find_action(key.key, pointer_.held().mods(), key.repeat);
  if (!action) return;
  switch (*action) {
    case Action::quit:
    case Action::full_screen:
    case Action::larger:
    case Action::smaller:
    case Action::next_theme:
    case Action::screenshot:
      return perform(*action);
    case Action::save_scene:
      if (saves) perform(*action);
      return;
    case Action::toggle_help:
    case Action::pick_scene:
      if (!saves && !ui_.shows(PanelId::question)) perform(*action);
      return;
    default:
      return;
  }
}

/// True if the key was a command.
bool Application::route_key(const KeyPressed& key) {
  if (key.key == Key::escape) {
    close_something();
    return true;
  }
  if (host_.wants_keys() || ui_.shows(PanelId::scenes)) return true;  // a text field uses it
  if (dialog_open()) {
    press_in_dialog(key);
    return true;
  }
  // In flight mode, the keys of flight are not commands; nor are the letters beside them while a
  // mouse button is held.
  const uint8_t mods = pointer_.held().mods();
  if (pointer_.tool().flying() && (mods & ~Mods::shift) == 0) {
    const bool letter = key.key >= Key::a && key.key <= letter_key('Z') && mods == 0;
    if (is_fly_key(key.key) || (letter && pointer_.tool().busy())) return false;
  }
  const auto action = find_action(key.key, pointer_.held().mods(), key.repeat);
  if (action) perform(*action);
  return action.has_value();
}

/// Cancels the gesture under way: a pulled body is released, a moved one is put back. False if
/// there is none.
bool Application::give_up_gesture() {
  if (pointer_.drag().active()) {
    end_drag();
  } else if (pointer_.tool().arranging()) {
    const bool moved = tools_.arranger.last().has_value();
    pointer_.cancel();
    tools_.arranger.end();
    if (moved) take_back();
  } else if (tools_.box) {
    pointer_.cancel();
    tools_.box.reset();
  } else {
    return false;
  }
  return true;
}

void Application::close_something() {
  if (question_.open()) return question_.decline(ui_);
  for (const PanelId id : {PanelId::scenes, PanelId::help, PanelId::save})
    if (ui_.shows(id)) {
      ui_.shows(id) = false;
      early_text_.clear();
      host_.give_up_keys();
      return;
    }
  if (give_up_gesture()) return;
  const SessionCounters counters = session().counters();
  if (counters.asking_seconds > slow_question_seconds) return session().cancel_question();
  if (counters.under_way_seconds > slow_tick_seconds) return apply(CancelTick{});
  const auto is_error = [](const Toast& t) { return t.kind == ToastKind::error; };
  if (std::erase_if(ui_.toasts, is_error) > 0) return;
  if (tools_.builder.half_way())
    tools_.builder.cancel();
  else if (pointer_.tool().free_flight())
    pointer_.set_free_flight(false);
  else if (ui_.building)
    end_building();
  else if (instruments_.ruler.half_way())
    instruments_.ruler.cancel();
  else if (ui_.ruling)
    ui_.ruling = false;
  else if (ui_.handles.kind != HandleKind::none)
    ui_.handles.kind = HandleKind::none;
  else if (ui_.shows(PanelId::contact))
    look_into({});
  else
    selection_.clear();
}

void Application::apply(const PointerEffects& effects) {
  const bool ruling = ui_.ruling && ui_.shows(PanelId::ruler);
  const bool works = ((ui_.building || ruling) && effects.selected) || !effects.shots.empty();
  if (works && pointer_.is_beside())
    return ui_.toast(ToastKind::info, "World B is only looked at: click in the left picture");
  if (ui_.building && effects.selected && !effects.drag_began) {
    // A double click would build two things in one place. Only the second end of a joint may be at
    // the place of its first.
    if (effects.twice && !tools_.builder.half_way()) return;
    build_at(effects.press_x, effects.press_y, *effects.selected);
    return;
  }
  if (ruling && effects.selected && !effects.drag_began) {
    // A double click counts once, since nobody measures a distance of zero.
    if (!effects.twice) rule_at(*effects.selected);
    return;
  }
  const Overlays& drawn = ui_.overlays;
  const bool contacts_drawn =
      drawn.contacts || drawn.normals || drawn.forces || drawn.friction_cones;
  std::optional<ContactPick> contact;
  if (effects.selected && !effects.drag_began && contacts_drawn && !pointer_.is_beside())
    contact = pick_contact(world_.frame(), camera_.seen(), effects.press_x, effects.press_y,
                           layout_.area.width(), layout_.area.height());
  if (contact) {
    look_into(contact);
  } else if (effects.selected) {
    const BodyId on = *effects.selected ? (*effects.selected)->body : BodyId{};
    if (effects.more && !on.is_null())
      selection_.toggle(on);
    else if (effects.arrange_began && selection_.contains(on))
      selection_.add(on);
    else if (!effects.more)
      selection_.set(on);
    if (!selection_.empty() && !effects.more && !effects.drag_began) open_inspector();
  }
  if (effects.box) select_box(*effects.box);
  arrange(effects);
  for (const Ray& ray : effects.shots) shoot(ray);
  if (effects.drag_ended) end_drag();
  const MouseDrag& drag = pointer_.drag();
  if (!drag.active()) return;
  if (effects.drag_began) {
    begin_edit("Pull " + name_of(drag.body()));
    mouse_pull_.take(session(), drag.def());
  }
  if (effects.drag_moved) mouse_pull_.move(session(), drag.def());
  if (effects.turn) mouse_pull_.turn(session(), drag.body(), *effects.turn);
}

/// Opens the inspector for a selection, unless it would cover, in a narrow window, what was
/// clicked.
void Application::open_inspector() {
  if (has_two_columns(double(layout_.panels.width))) ui_.shows(PanelId::inspector) = true;
}

/// The thing built last is selected, and its panel is shown now that it covers no place to click.
void Application::end_building() {
  ui_.building = false;
  tools_.builder.cancel();
  if (!selection_.empty()) open_inspector();
}

void Application::look_into(const std::optional<ContactPick>& contact) {
  ui_.shows(PanelId::contact) = contact.has_value();
  if (contact)
    instruments_.probe.choose(*contact);
  else
    instruments_.probe.clear();
}

void Application::end_drag() {
  if (pointer_.drag().active()) pointer_.cancel();
  if (world_.any()) mouse_pull_.let_go(session());
}

void Application::shoot(const Ray& ray) {
  // Radius: a twentieth of the width that the camera sees.
  const double distance = (camera_.camera().eye - camera_.camera().target).norm();
  const double radius = std::clamp(0.025 * distance, 0.02, 1.0);
  BodyDef ball;
  ball.name = "shot";
  ball.pose.x = ray.origin + 3 * radius * ray.direction;
  ball.velocity = std::clamp(3.0 * distance, 4.0, 60.0) * ray.direction;
  BodyShapeDef part;
  part.shape = ball_def(radius);
  part.material.density = 3000;
  part.material.restitution = 0.2;
  ball.shapes.push_back(part);
  ball.look.colour = Vec3f(0.85f, 0.28f, 0.06f);
  ball.look.roughness = 0.35f;
  ball.look.pattern = 0.3f;
  begin_edit("Shoot a ball");
  session().post([ball](World& world) { (void)world.create_body(ball); });
}

}  // namespace tumble
