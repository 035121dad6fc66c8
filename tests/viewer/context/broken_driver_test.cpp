// Drivers that are missing or broken. Reference: the environment variables that Mesa and libglvnd
// document for where drivers are looked for. Everything happens in child processes, and this
// program opens no context itself: a driver that is loaded stays loaded.
#include "tests/viewer/context/child.hpp"
#include "viewer/context/gl_context.hpp"
#include "viewer/context/window_context.hpp"

#include <cstdlib>
#include <string>

#include <doctest/doctest.h>

using namespace tumble;
using tumble::test::in_child;

namespace {

bool contains(const std::string& text, const char* part) {
  return text.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("a broken EGL falls back to OSMesa and says why") {
  for (const char* variable : {"LIBGL_DRIVERS_PATH", "__EGL_VENDOR_LIBRARY_DIRS"}) {
    CAPTURE(variable);
    const std::string answer = in_child([&]() -> std::string {
      setenv(variable, "/nonexistent", 1);
      std::string said;
      auto choice = create_context(
          "auto", [&](LogLevel, std::string_view s) { said += std::string(s) + "\n"; });
      return (choice ? choice->context->info().name : "none") + "\n" + said;
    });
    CHECK(contains(answer, "osmesa\n"));
    CHECK(contains(answer, variable));  // the cure names the variable
    CHECK(contains(answer, "apt install"));
  }
}

TEST_CASE("a broken EGL asked for by name is an error with cause and cure") {
  for (const char* name : {"egl", "egl:0", "surfaceless"}) {
    CAPTURE(name);
    const std::string answer = in_child([&]() -> std::string {
      setenv("LIBGL_DRIVERS_PATH", "/nonexistent", 1);
      auto choice = create_context(name);
      return choice ? "made" : choice.error().text();
    });
    CHECK(answer != "made");
    CHECK(contains(answer, "apt install libegl1 libgl1-mesa-dri"));
  }
}

TEST_CASE("a window without a display names the way out") {
  const std::string answer = in_child([]() -> std::string {
    unsetenv("DISPLAY");
    unsetenv("WAYLAND_DISPLAY");
    auto window = make_window_context({});
    return window ? "made" : window.error().text();
  });
  CHECK(answer != "made");
  CHECK(contains(answer, "tumble render"));
}
