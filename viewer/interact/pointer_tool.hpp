#pragma once
#include "viewer/interact/camera_controller.hpp"
#include "viewer/interact/input.hpp"
#include "viewer/interact/mouse_drag.hpp"

#include <functional>
#include <optional>
#include <vector>

namespace tumble {

/// A box drawn over the picture, from where the button was pressed.
struct PointerBox {
  double x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  bool done = false;  ///< the button was released
};

/// What the pointer's gestures ask of the world and of the selection.
struct PointerEffects {
  std::optional<std::optional<Pick>> selected;  ///< a click: on this, or on nothing
  double press_x = 0, press_y = 0;              ///< where a click or an arranging drag began
  double x = 0, y = 0;                          ///< where the pointer arranges to
  bool more = false;                            ///< to what is selected already
  bool twice = false;                           ///< the click is the second of a double click
  std::optional<PointerBox> box;
  bool arrange_began = false, arrange_moved = false, arrange_ended = false;
  bool drag_began = false, drag_moved = false, drag_ended = false;
  std::optional<Vec3> turn;  ///< angular velocity for the held body [rad/s]
  std::vector<Ray> shots;
};

/// Mouse and fly keys as people expect them: see all_pointer_bindings(). One instance per view.
class PointerTool {
 public:
  struct View {
    double width = 1, height = 1;  ///< of the picture in UI units
    /// What a ray hits in the picture that the person sees.
    std::function<std::optional<Pick>(const Ray&)> pick;
    /// While bodies are being arranged: whether this point of the picture is on a handle, and
    /// whether a drag of this body moves it. Null else.
    std::function<bool(double x, double y)> on_handle;
    std::function<bool(const Pick&)> arranged;
    bool keys_are_free = true;  ///< nobody is typing: keys may fly
  };

  /// Events of one frame that the panels did not take, `held` as it was before them.
  PointerEffects handle(const std::vector<InputEvent>& events, const HeldInput& held, double dt,
                        const View& view, CameraController& camera);
  /// Drops whatever is going on (another scene was loaded).
  void cancel();

  const MouseDrag& drag() const { return drag_; }
  /// True while a gesture that began on the scene lasts: the panels must not take its events.
  bool busy() const { return mode_ != Mode::idle; }
  /// True while a press at this place, `dt` after the last events, would be the second of a double
  /// click on a body. It is the scene's too, even where the first click has opened a panel.
  bool awaits_second_click(double x, double y, double dt) const;
  bool flying() const { return mode_ == Mode::fly || free_flight_; }
  /// Without a held button keys fly too, and what a left drag does is look around.
  bool free_flight() const { return free_flight_; }
  void set_free_flight(bool on) { free_flight_ = on; }
  /// Somebody clicked elsewhere: the next click here is a first one.
  void forget_click() { clicked_on_.reset(); }
  /// While clicks put something where they are, a double click does not move the camera.
  void set_placing(bool on) { placing_ = on; }
  bool arranging() const { return mode_ == Mode::arrange; }

 private:
  enum class Mode : uint8_t { idle, pressed, drag, orbit, pan, fly, arrange, box };

  void press(PointerButton button, const HeldInput& held, const View& view,
             CameraController& camera, PointerEffects& out);
  void release(PointerButton button, CameraController& camera, PointerEffects& out);
  /// The pointer has left the place of the press: which gesture it is.
  void decide(const View& view, CameraController& camera, PointerEffects& out);
  void moved(double dx, double dy, const HeldInput& held, double dt, const View& view,
             CameraController& camera, PointerEffects& out);
  void fly(const HeldInput& held, double dt, CameraController& camera) const;
  bool near_click(double x, double y) const;
  static Ray ray_at(const HeldInput& held, const View& view, const CameraController& camera);

  Mode mode_ = Mode::idle;
  bool free_flight_ = false;
  bool placing_ = false;
  PointerButton fly_button_ = PointerButton::right;  ///< that is held while looking around
  double press_x_ = 0, press_y_ = 0;
  double box_x_ = 0, box_y_ = 0;  ///< the other corner
  std::optional<Pick> pressed_on_;
  bool second_ = false;             ///< the press is the second of a double click
  bool more_ = false;               ///< the press adds to the selection
  std::optional<Pick> clicked_on_;  ///< by the last click, if that may still become a double one
  double since_click_ = 1e6;        ///< [s]
  int pictures_since_click_ = 1000;
  double click_x_ = 0, click_y_ = 0;
  MouseDrag drag_;
};

}  // namespace tumble
