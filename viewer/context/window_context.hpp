#pragma once
#include "viewer/context/gl_context.hpp"

struct GLFWwindow;

namespace tumble {

struct WindowOptions {
  int width = 1280, height = 720;  ///< screen units
  std::string title = "Tumble";
  bool visible = true;
  bool vsync = true;
};

/// A desktop window with its context. One thread, the main one.
class WindowContext : public GlContext {
 public:
  /// The GLFW window, for callbacks and input.
  virtual GLFWwindow* window() const = 0;
  /// Shows what was presented (Device::present) since the last call.
  virtual void swap() = 0;
};

/// Opens a window, its context current. Fails without a display, or when the program was built
/// with TUMBLE_WINDOW=OFF.
Result<std::unique_ptr<WindowContext>> make_window_context(const WindowOptions& options);

}  // namespace tumble
