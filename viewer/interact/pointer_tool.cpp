#include "viewer/interact/pointer_tool.hpp"

#include "viewer/interact/key_map.hpp"

#include <cmath>

namespace tumble {
namespace {

constexpr double drag_threshold = 4;  // [px] a smaller movement is a click

/// Whether a press is early enough to be the second of a double click. If drawing is slow, two fast
/// clicks may be in consecutive pictures.
bool soon(double seconds, int pictures) {
  constexpr double double_click_seconds = 0.35;
  return seconds < double_click_seconds || pictures <= 1;
}

}  // namespace

bool PointerTool::near_click(double x, double y) const {
  return std::hypot(x - click_x_, y - click_y_) < 2 * drag_threshold;
}

bool PointerTool::awaits_second_click(double x, double y, double dt) const {
  return clicked_on_ && near_click(x, y) && soon(since_click_ + dt, pictures_since_click_ + 1);
}

Ray PointerTool::ray_at(const HeldInput& held, const View& view, const CameraController& camera) {
  return pixel_ray(camera.seen(), held.x, held.y, view.width, view.height);
}

PointerEffects PointerTool::handle(const std::vector<InputEvent>& events, const HeldInput& before,
                                   double dt, const View& view, CameraController& camera) {
  PointerEffects out;
  HeldInput held = before;
  since_click_ += dt;
  ++pictures_since_click_;
  for (const InputEvent& event : events) {
    const double x = held.x, y = held.y;
    held.apply(event);
    if (std::holds_alternative<PointerMoved>(event)) {
      if (mode_ != Mode::idle) moved(held.x - x, held.y - y, held, dt, view, camera, out);
    } else if (const auto* p = std::get_if<PointerPressed>(&event)) {
      if (p->down)
        press(p->button, held, view, camera, out);
      else
        release(p->button, camera, out);
    } else if (const auto* wheel = std::get_if<WheelTurned>(&event)) {
      if (mode_ == Mode::drag) {
        drag_.pull(wheel->dy);
        out.drag_moved = true;
      } else {
        camera.zoom(wheel->dy);
      }
    } else if (const auto* focus = std::get_if<FocusChanged>(&event); focus && !focus->focused) {
      if (mode_ == Mode::drag) out.drag_ended = true;
      if (mode_ == Mode::arrange) out.arrange_ended = true;
      cancel();
    }
  }
  if (flying() && view.keys_are_free) fly(held, dt, camera);
  return out;
}

void PointerTool::cancel() {
  drag_.end();
  mode_ = Mode::idle;
  pressed_on_.reset();
  clicked_on_.reset();
}

void PointerTool::press(PointerButton button, const HeldInput& held, const View& view,
                        CameraController& camera, PointerEffects& out) {
  if (mode_ != Mode::idle) return;  // a second button does not change the gesture
  press_x_ = held.x;
  press_y_ = held.y;
  if (button == PointerButton::middle) {
    mode_ = Mode::pan;
  } else if (button == PointerButton::right) {
    mode_ = Mode::fly;
    fly_button_ = button;
  } else if (view.on_handle && view.on_handle(held.x, held.y)) {
    mode_ = Mode::arrange;
    out.on_handle = true;
    out.arrange_began = true;
    out.press_x = press_x_;
    out.press_y = press_y_;
  } else if (held.mods() & Mods::alt) {  // for touchpads without a middle button
    mode_ = Mode::pan;
  } else if (held.key(Key::shift) && !view.arranged) {
    out.shots.push_back(ray_at(held, view, camera));
  } else {
    mode_ = Mode::pressed;
    more_ = (held.mods() & (Mods::ctrl | Mods::shift)) != 0;
    second_ = !more_ && clicked_on_ && near_click(held.x, held.y) &&
              soon(since_click_, pictures_since_click_);
    pressed_on_ = view.pick(ray_at(held, view, camera));
  }
}

void PointerTool::release(PointerButton button, CameraController& camera, PointerEffects& out) {
  if (button == PointerButton::left && mode_ == Mode::pressed) {
    // A moving body may have left the place between the clicks.
    if (second_ && !pressed_on_) pressed_on_ = clicked_on_;
    out.selected = pressed_on_;
    out.more = more_;
    out.press_x = press_x_;
    out.press_y = press_y_;
    out.twice = second_;
    if (second_ && !placing_) camera.focus(pressed_on_->x_world);
    clicked_on_ = second_ ? std::nullopt : pressed_on_;
    since_click_ = 0;
    pictures_since_click_ = 0;
    click_x_ = press_x_;
    click_y_ = press_y_;
    mode_ = Mode::idle;
  } else if (button == PointerButton::left && mode_ == Mode::drag) {
    out.drag_ended = true;
    cancel();
  } else if (button == PointerButton::left && mode_ == Mode::arrange) {
    out.arrange_ended = true;
    mode_ = Mode::idle;
  } else if (button == PointerButton::left && mode_ == Mode::box) {
    out.box = PointerBox{press_x_, press_y_, box_x_, box_y_, true};
    mode_ = Mode::idle;
  } else if ((button == PointerButton::left && mode_ == Mode::orbit) ||
             (button != PointerButton::right && mode_ == Mode::pan) ||
             (button == fly_button_ && mode_ == Mode::fly)) {
    mode_ = Mode::idle;
  }
}

void PointerTool::decide(const View& view, CameraController& camera, PointerEffects& out) {
  if (more_) {
    mode_ = Mode::box;
  } else if (free_flight_) {
    mode_ = Mode::fly;
    fly_button_ = PointerButton::left;
  } else if (pressed_on_ && view.arranged && view.arranged(*pressed_on_)) {
    mode_ = Mode::arrange;
    out.selected = pressed_on_;
    out.arrange_began = true;
    out.press_x = press_x_;
    out.press_y = press_y_;
  } else if (pressed_on_ && !view.arranged && pressed_on_->type == BodyType::dynamic) {
    mode_ = Mode::drag;
    const Ray ray = pixel_ray(camera.seen(), press_x_, press_y_, view.width, view.height);
    drag_.begin(*pressed_on_, ray, camera.camera());
    out.selected = pressed_on_;
    out.drag_began = true;
  } else {
    mode_ = Mode::orbit;
  }
}

void PointerTool::moved(double dx, double dy, const HeldInput& held, double dt, const View& view,
                        CameraController& camera, PointerEffects& out) {
  if (mode_ == Mode::pressed) {
    const double px = held.x - press_x_, py = held.y - press_y_;
    if (std::hypot(px, py) < drag_threshold) return;
    dx = px;
    dy = py;
    decide(view, camera, out);
  }
  if (mode_ == Mode::orbit) camera.orbit(dx, dy);
  if (mode_ == Mode::pan) camera.pan(dx, dy, view.height);
  if (mode_ == Mode::fly) camera.look(dx, dy);
  if (mode_ == Mode::box) {
    box_x_ = held.x;
    box_y_ = held.y;
    out.box = PointerBox{press_x_, press_y_, box_x_, box_y_, false};
  }
  if (mode_ == Mode::arrange) {
    out.arrange_moved = true;
    out.x = held.x;
    out.y = held.y;
  }
  if (mode_ == Mode::drag) {
    if (held.key(Key::shift)) {
      out.turn = MouseDrag::turning(dx, dy, dt, camera.camera());
    } else {
      drag_.move(ray_at(held, view, camera), camera.camera());
      out.drag_moved = true;
    }
  }
}

void PointerTool::fly(const HeldInput& held, double dt, CameraController& camera) const {
  if (held.mods() & ~Mods::shift) return;  // it is a shortcut
  const auto axis = [&](Action plus, Action minus) {
    return double(is_held(plus, held)) - double(is_held(minus, held));
  };
  const Vec3 move(axis(Action::fly_right, Action::fly_left), axis(Action::fly_up, Action::fly_down),
                  axis(Action::fly_forward, Action::fly_back));
  if (move != Vec3::Zero()) camera.fly(move, dt, held.key(Key::shift));
}

}  // namespace tumble
