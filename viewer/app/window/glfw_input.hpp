#pragma once
#include "viewer/interact/input.hpp"
#include "viewer/ui/ui_host.hpp"

#include <memory>
#include <utility>
#include <vector>

struct GLFWwindow;

namespace tumble {

/// Turns a GLFW window's callbacks into events; none between two frames is lost. Uses the window's
/// user pointer.
class GlfwInput {
 public:
  explicit GlfwInput(GLFWwindow* window);
  ~GlfwInput();
  GlfwInput(const GlfwInput&) = delete;
  GlfwInput& operator=(const GlfwInput&) = delete;

  /// Events since the last call; positions are divided by window units per UI unit.
  std::vector<InputEvent> take(double window_units_per_ui_unit);
  /// Whether, since the last call, the system requested a redraw or the window got the keyboard
  /// focus.
  bool take_exposed() { return std::exchange(exposed_, false); }
  void set_pointer_look(PointerLook look);
  UiHost::Clipboard clipboard();

 private:
  struct Cursors;
  static GlfwInput& of(GLFWwindow* window);
  void add(InputEvent event) { events_.push_back(std::move(event)); }

  GLFWwindow* window_;
  std::vector<InputEvent> events_;
  bool exposed_ = true;
  std::unique_ptr<Cursors> cursors_;
  PointerLook look_ = PointerLook::arrow;
};

}  // namespace tumble
