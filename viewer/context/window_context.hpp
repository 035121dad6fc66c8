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

/// A desktop window with its context. To be used on the main thread only.
class WindowContext : public GlContext {
 public:
  /// The GLFW window, for callbacks and input.
  virtual GLFWwindow* window() const = 0;
  /// Swaps the buffers: shows what was presented (Device::present) since the last call.
  virtual void swap() = 0;
};

/// Opens a window and makes its context current. Fails without a display, or if the program was
/// built with TUMBLE_WINDOW=OFF.
Result<std::unique_ptr<WindowContext>> make_window_context(const WindowOptions& options);

}  // namespace tumble
