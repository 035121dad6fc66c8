#pragma once
#include "viewer/interact/camera_controller.hpp"
#include "viewer/interact/input.hpp"
#include "viewer/interact/mouse_drag.hpp"

#include <functional>
#include <optional>
#include <vector>

namespace tumble {

/// A selection box dragged over the picture from where the button was pressed.
struct PointerBox {
  double x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  bool done = false;  ///< the button was released
};

/// Effects of the pointer's gestures on world and selection.
struct PointerEffects {
  std::optional<std::optional<Pick>> selected;  ///< a click on this, or on nothing
  double press_x = 0, press_y = 0;              ///< start of a click or of a drag of handles
  double x = 0, y = 0;                          ///< present point of such a drag
  bool more = false;                            ///< the click adds to the selection
  bool twice = false;                           ///< the click is the second of a double click
  std::optional<PointerBox> box;
  bool on_handle = false;  ///< the drag of handles began on one, and not on a body
  bool arrange_began = false, arrange_moved = false, arrange_ended = false;
  bool drag_began = false, drag_moved = false, drag_ended = false;
  std::optional<Vec3> turn;  ///< angular velocity for the held body [rad/s]
  std::vector<Ray> shots;
};

/// Mouse and flight control: see all_pointer_bindings(). One instance per view.
class PointerTool {
 public:
  struct View {
    double width = 1, height = 1;  ///< size of the picture in UI units
    /// Returns what a ray hits in the picture shown.
    std::function<std::optional<Pick>(const Ray&)> pick;
    /// While bodies are being arranged: whether a point of the picture is on a handle, and whether
    /// a drag of a body moves it. Otherwise null.
    std::function<bool(double x, double y)> on_handle;
    std::function<bool(const Pick&)> arranged;
    bool keys_are_free = true;  ///< no text field has the keyboard: keys may fly
  };

  /// Handles the events of one frame that the panels did not take; `held` is the state before them.
  PointerEffects handle(const std::vector<InputEvent>& events, const HeldInput& held, double dt,
                        const View& view, CameraController& camera);
  /// Cancels the gesture under way (another scene was loaded).
  void cancel();

  const MouseDrag& drag() const { return drag_; }
  /// Whether a gesture that began in the scene is under way: the panels must ignore its events.
  bool busy() const { return mode_ != Mode::idle; }
  /// Whether a press at this place, `dt` [s] after the last events, would be the second of a double
  /// click on a body. It then belongs to the scene even if the first click has opened a panel
  /// there.
  bool awaits_second_click(double x, double y, double dt) const;
  bool flying() const { return mode_ == Mode::fly || free_flight_; }
  /// In free flight, keys fly without a held button, and a left drag looks around.
  bool free_flight() const { return free_flight_; }
  void set_free_flight(bool on) { free_flight_ = on; }
  /// After a click elsewhere, the next click here is not a double click.
  void forget_click() { clicked_on_.reset(); }
  /// While clicks place things, a double click does not move the camera.
  void set_placing(bool on) { placing_ = on; }
  bool arranging() const { return mode_ == Mode::arrange; }

 private:
  enum class Mode : uint8_t { idle, pressed, drag, orbit, pan, fly, arrange, box };

  void press(PointerButton button, const HeldInput& held, const View& view,
             CameraController& camera, PointerEffects& out);
  void release(PointerButton button, CameraController& camera, PointerEffects& out);
  /// Decides which gesture it is, once the pointer has left the place of the press.
  void decide(const View& view, CameraController& camera, PointerEffects& out);
  void moved(double dx, double dy, const HeldInput& held, double dt, const View& view,
             CameraController& camera, PointerEffects& out);
  void fly(const HeldInput& held, double dt, CameraController& camera) const;
  bool near_click(double x, double y) const;
  static Ray ray_at(const HeldInput& held, const View& view, const CameraController& camera);

  Mode mode_ = Mode::idle;
  bool free_flight_ = false;
  bool placing_ = false;
  PointerButton fly_button_ = PointerButton::right;  ///< held while looking around
  double press_x_ = 0, press_y_ = 0;
  double box_x_ = 0, box_y_ = 0;  ///< the corner of the box at the pointer
  std::optional<Pick> pressed_on_;
  bool second_ = false;             ///< the press is the second of a double click
  bool more_ = false;               ///< the press adds to the selection
  std::optional<Pick> clicked_on_;  ///< of the last click, while a double click is still possible
  double since_click_ = 1e6;        ///< time since that click [s]
  int pictures_since_click_ = 1000;
  double click_x_ = 0, click_y_ = 0;
  MouseDrag drag_;
};

}  // namespace tumble
