#include "viewer/context/window_context.hpp"

#include "viewer/context/backends.hpp"

#define GLFW_INCLUDE_NONE
#include <cstdlib>

#include <GLFW/glfw3.h>

namespace tumble {
namespace {

Error window_fault(const char* fallback) {
  const char* text = nullptr;
  glfwGetError(&text);
  const char* display = std::getenv("DISPLAY");
  return Error{ErrorCode::unsupported, text ? text : fallback, "window",
               display && *display
                   ? std::string("check that display '") + display + "' can be reached"
                   : "start it in a desktop session (DISPLAY is not set), under xvfb-run, or draw "
                     "to files with `tumble render`"};
}

class GlfwWindow final : public WindowContext {
 public:
  GlfwWindow() { info_.name = "window"; }
  ~GlfwWindow() override {
    if (window_) glfwDestroyWindow(window_);
    if (initialised_) glfwTerminate();
  }

  Status open(const WindowOptions& options) {
    if (!glfwInit()) return window_fault("GLFW does not start");
    initialised_ = true;
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    glfwWindowHint(GLFW_OPENGL_FORWARD_COMPAT, GLFW_TRUE);
    glfwWindowHint(GLFW_VISIBLE, options.visible ? GLFW_TRUE : GLFW_FALSE);
    glfwWindowHint(GLFW_SAMPLES, 0);  // the picture is already antialiased
    glfwWindowHint(GLFW_DEPTH_BITS, 0);
    glfwWindowHint(GLFW_STENCIL_BITS, 0);
    window_ =
        glfwCreateWindow(options.width, options.height, options.title.c_str(), nullptr, nullptr);
    if (!window_) return window_fault("no window with OpenGL 3.3 core");
    if (Status s = make_current(); !s) return s;
    glfwSwapInterval(options.vsync ? 1 : 0);
    return describe_current(*this, info_);
  }

  const ContextInfo& info() const override { return info_; }
  Status make_current() override {
    glfwMakeContextCurrent(window_);
    if (glfwGetCurrentContext() != window_) return window_fault("the window's context is lost");
    return {};
  }
  void release() override { glfwMakeContextCurrent(nullptr); }
  Function get_proc_address(const char* name) const override { return glfwGetProcAddress(name); }
  GLFWwindow* window() const override { return window_; }
  void swap() override { glfwSwapBuffers(window_); }

 private:
  GLFWwindow* window_ = nullptr;
  bool initialised_ = false;
  ContextInfo info_;
};

}  // namespace

Result<std::unique_ptr<WindowContext>> make_window_context(const WindowOptions& options) {
  auto window = std::make_unique<GlfwWindow>();
  if (Status s = window->open(options); !s) return s.error();
  return std::unique_ptr<WindowContext>(std::move(window));
}

}  // namespace tumble
