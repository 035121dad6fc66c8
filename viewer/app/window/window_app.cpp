#include "viewer/app/window/window_app.hpp"

#include "viewer/app/window/status_file.hpp"
#include "viewer/capture/atomic_file.hpp"
#include "viewer/capture/stop_signal.hpp"
#include "viewer/context/window_context.hpp"
#include "viewer/render/gl/gl_device.hpp"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <thread>
#include <utility>

#ifdef TUMBLE_WINDOW
#include "viewer/app/window/glfw_input.hpp"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#endif

namespace tumble {
namespace {

constexpr int exit_bad_script = 2, exit_no_window = 4;

int complain(const Error& error, int code) {
  std::fprintf(stderr, "tumble: %s\n", error.text().c_str());
  return code;
}

#ifdef TUMBLE_WINDOW

/// The three units of a window: window units (in which GLFW reports the pointer), pixels, and UI
/// units (in which panels are laid out).
struct Measures {
  Application::Picture picture;
  double window_units = 1;  ///< per UI unit
};

Measures measure(GLFWwindow* window, double wanted_scale, double zoom = 1) {
  Measures m;
  int width = 0, height = 0;
  glfwGetWindowSize(window, &width, &height);
  glfwGetFramebufferSize(window, &m.picture.width, &m.picture.height);
  float sx = 1, sy = 1;
  glfwGetWindowContentScale(window, &sx, &sy);
  m.picture.scale =
      wanted_scale > 0 ? wanted_scale : std::clamp(double(std::max(sx, sy)), 1.0, 4.0);
  m.picture.scale *= zoom;
  const double pixels_per_window_unit = width > 0 ? double(m.picture.width) / double(width) : 1.0;
  m.window_units = m.picture.scale / pixels_per_window_unit;
  return m;
}

/// Refresh period of the display that shows the middle of the window; 0: not known [s]. Queries the
/// display, which takes a moment.
double display_period(GLFWwindow* window) {
  int x = 0, y = 0, width = 0, height = 0, count = 0;
  glfwGetWindowPos(window, &x, &y);
  glfwGetWindowSize(window, &width, &height);
  x += width / 2, y += height / 2;
  GLFWmonitor** monitors = glfwGetMonitors(&count);
  for (int i = 0; i < count; ++i) {
    int left = 0, top = 0;
    glfwGetMonitorPos(monitors[i], &left, &top);
    const GLFWvidmode* mode = glfwGetVideoMode(monitors[i]);
    if (!mode || mode->refreshRate <= 0 || x < left || y < top || x >= left + mode->width ||
        y >= top + mode->height)
      continue;
    return 1.0 / mode->refreshRate;
  }
  return 0;
}

/// Sets the least size for which bar and panels can be laid out.
void limit_size(GLFWwindow* window, double wanted_scale) {
  constexpr double least_width = 360, least_height = 280;  // [UI units]
  const double units = measure(window, wanted_scale).window_units;
  glfwSetWindowSizeLimits(window, int(least_width * units), int(least_height * units),
                          GLFW_DONT_CARE, GLFW_DONT_CARE);
}

/// Exits without waiting for a scene that is still being opened, which cannot always be cancelled
/// (libraries read the mesh files). All files are complete by now; the system releases the rest.
[[noreturn]] void leave_at_once(int code) {
  std::fflush(nullptr);
  std::_Exit(code);
}

/// Switches to full screen on the monitor that shows the window, and back to the former place.
class FullScreen {
 public:
  void set(GLFWwindow* window, bool on) {
    if (on == on_) return;
    on_ = on;
    if (!on) return glfwSetWindowMonitor(window, nullptr, x_, y_, width_, height_, 0);
    glfwGetWindowPos(window, &x_, &y_);
    glfwGetWindowSize(window, &width_, &height_);
    GLFWmonitor* monitor = glfwGetPrimaryMonitor();
    int count = 0;
    GLFWmonitor** all = glfwGetMonitors(&count);
    for (int i = 0; i < count; ++i) {
      int mx = 0, my = 0;
      glfwGetMonitorPos(all[i], &mx, &my);
      const GLFWvidmode* mode = glfwGetVideoMode(all[i]);
      const int cx = x_ + width_ / 2, cy = y_ + height_ / 2;
      if (mode && cx >= mx && cx < mx + mode->width && cy >= my && cy < my + mode->height)
        monitor = all[i];
    }
    const GLFWvidmode* mode = monitor ? glfwGetVideoMode(monitor) : nullptr;
    if (mode)
      glfwSetWindowMonitor(window, monitor, 0, 0, mode->width, mode->height, mode->refreshRate);
  }

 private:
  bool on_ = false;
  int x_ = 0, y_ = 0, width_ = 0, height_ = 0;
};

/// Limits the frame rate: without vertical synchronisation (virtual displays) the loop would use a
/// whole core.
class Pace {
 public:
  double next() {
    constexpr std::chrono::microseconds shortest(1000000 / 120);
    std::this_thread::sleep_until(last_ + shortest);
    const auto now = std::chrono::steady_clock::now();
    const double dt = std::chrono::duration<double>(now - last_).count();
    last_ = now;
    const auto wall = std::chrono::system_clock::now();
    was_away_ = wall - std::exchange(wall_, wall) > std::chrono::seconds(2);
    return std::min(dt, 1.0);
  }
  /// Whether so much time passed before the last next() that the machine may have been suspended.
  /// Measured by the wall clock, since the steady clock stops during a suspend.
  bool was_away() const { return was_away_; }

 private:
  std::chrono::system_clock::time_point wall_ = std::chrono::system_clock::now();
  bool was_away_ = false;
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

struct Extras {
  std::optional<StatusFile> status;
  std::optional<ScriptedInput> script;
};

Result<Extras> open_extras(const WindowAppOptions& options) {
  Extras extras;
  if (!options.status_file.empty()) {
    auto status = StatusFile::create(options.status_file);
    if (!status) return status.error();
    extras.status = std::move(*status);
  }
  if (!options.script.empty()) {
    auto text = read_file(options.script);
    if (!text) return text.error();
    auto script = ScriptedInput::parse(*text);
    if (!script) return script.error();
    extras.script = std::move(*script);
  }
  return extras;
}

int run_loop(WindowContext& context, Application& app, Extras& extras, double scale) {
  GLFWwindow* window = context.window();
  GlfwInput input(window);
  app.ui().set_clipboard(input.clipboard());
  FullScreen full_screen;
  StopSignal stop;
  Pace pace;
  std::string title;
  double period = display_period(window);
  while (!app.quit_requested() && !stop.requested()) {
    glfwPollEvents();
    if (glfwWindowShouldClose(window)) {
      glfwSetWindowShouldClose(window, GLFW_FALSE);
      app.ask_to_quit();
    }
    Measures m = measure(window, scale, app.zoom());
    if (pace.was_away()) period = display_period(window);
    m.picture.display_period = period;
    std::vector<InputEvent> events = input.take(m.window_units);
    if (extras.script && !extras.script->done()) {
      auto played = extras.script->next([&](std::string_view place) { return app.locate(place); });
      if (!played) return complain(played.error(), exit_bad_script);
      events.insert(events.end(), played->begin(), played->end());
    }
    const double dt = pace.next();
    if (input.take_exposed() || pace.was_away()) app.draw_anew();
    if (Status s = app.frame(events, dt, m.picture); !s) return complain(s.error(), exit_no_window);
    app.present();
    context.swap();
    if (extras.status) extras.status->add(app, m.window_units);
    input.set_pointer_look(app.pointer_look());
    full_screen.set(window, app.full_screen());
    if (const std::string wanted = app.title() + " - Tumble"; wanted != title) {
      title = wanted;
      glfwSetWindowTitle(window, title.c_str());
    }
  }
  return stop.exit_code();
}

#endif

}  // namespace

#ifdef TUMBLE_WINDOW

int run_window(WindowAppOptions options, OpenedScene scene) {
  WindowOptions wanted;
  wanted.width = options.width;
  wanted.height = options.height;
  auto context = make_window_context(wanted);
  if (!context) return complain(context.error(), exit_no_window);
  limit_size((*context)->window(), options.scale);
  auto device = make_gl_device(**context);
  if (!device) return complain(device.error(), exit_no_window);
  auto extras = open_extras(options);
  if (!extras) return complain(extras.error(), exit_bad_script);
  auto app = Application::create(**device, std::move(options.application), std::move(scene));
  if (!app) return complain(app.error(), exit_no_window);
  const int code = run_loop(**context, **app, *extras, options.scale);
  (*app)->finish();
  if ((*app)->opening()) leave_at_once(code);
  return code;
}

#else

int run_window(WindowAppOptions, OpenedScene) {
  return complain({ErrorCode::unsupported,
                   "this build has no window",
                   {},
                   "draw to files with `tumble render`, or build with -DTUMBLE_WINDOW=ON"},
                  exit_no_window);
}

#endif

}  // namespace tumble
