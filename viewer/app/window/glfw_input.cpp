#include "viewer/app/window/glfw_input.hpp"

#include <utility>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

namespace tumble {
namespace {

/// GLFW's printable keys have the values of ASCII, as ours have.
Key key_from_glfw(int key) {
  if (key > 0 && key < 127) return Key(key);
  if (key >= GLFW_KEY_F1 && key <= GLFW_KEY_F12) return f_key(key - GLFW_KEY_F1 + 1);
  if (key >= GLFW_KEY_KP_0 && key <= GLFW_KEY_KP_9) return Key('0' + key - GLFW_KEY_KP_0);
  switch (key) {
    case GLFW_KEY_ESCAPE:
      return Key::escape;
    case GLFW_KEY_ENTER:
    case GLFW_KEY_KP_ENTER:
      return Key::enter;
    case GLFW_KEY_TAB:
      return Key::tab;
    case GLFW_KEY_BACKSPACE:
      return Key::backspace;
    case GLFW_KEY_INSERT:
      return Key::insert;
    case GLFW_KEY_DELETE:
      return Key::del;
    case GLFW_KEY_RIGHT:
      return Key::right;
    case GLFW_KEY_LEFT:
      return Key::left;
    case GLFW_KEY_DOWN:
      return Key::down;
    case GLFW_KEY_UP:
      return Key::up;
    case GLFW_KEY_PAGE_UP:
      return Key::page_up;
    case GLFW_KEY_PAGE_DOWN:
      return Key::page_down;
    case GLFW_KEY_HOME:
      return Key::home;
    case GLFW_KEY_END:
      return Key::end;
    case GLFW_KEY_LEFT_SHIFT:
    case GLFW_KEY_RIGHT_SHIFT:
      return Key::shift;
    case GLFW_KEY_LEFT_CONTROL:
    case GLFW_KEY_RIGHT_CONTROL:
      return Key::control;
    case GLFW_KEY_LEFT_ALT:
    case GLFW_KEY_RIGHT_ALT:
      return Key::alt;
    case GLFW_KEY_LEFT_SUPER:
    case GLFW_KEY_RIGHT_SUPER:
      return Key::super;
    case GLFW_KEY_KP_DECIMAL:
      return Key::period;
    case GLFW_KEY_KP_SUBTRACT:
      return Key::minus;
    case GLFW_KEY_KP_ADD:
    case GLFW_KEY_KP_EQUAL:
      return Key::equal;
    default:
      return Key::none;
  }
}

/// Shortcuts refer to the letters and signs printed on the user's keyboard, not to their places on
/// an American one.
Key key_as_printed(int key, int scancode) {
  if (key < 127) {
    if (const char* name = glfwGetKeyName(key, scancode); name && name[0] && !name[1])
      if (const Key printed = key_from_name(name); printed != Key::none) return printed;
  }
  return key_from_glfw(key);
}

}  // namespace

struct GlfwInput::Cursors {
  std::pair<PointerLook, GLFWcursor*> all[5] = {
      {PointerLook::arrow, glfwCreateStandardCursor(GLFW_ARROW_CURSOR)},
      {PointerLook::hand, glfwCreateStandardCursor(GLFW_HAND_CURSOR)},
      {PointerLook::text, glfwCreateStandardCursor(GLFW_IBEAM_CURSOR)},
      {PointerLook::resize_x, glfwCreateStandardCursor(GLFW_HRESIZE_CURSOR)},
      {PointerLook::resize_y, glfwCreateStandardCursor(GLFW_VRESIZE_CURSOR)}};
  ~Cursors() {
    for (auto& [look, cursor] : all)
      if (cursor) glfwDestroyCursor(cursor);
  }
};

GlfwInput& GlfwInput::of(GLFWwindow* window) {
  return *static_cast<GlfwInput*>(glfwGetWindowUserPointer(window));
}

GlfwInput::GlfwInput(GLFWwindow* window) : window_(window), cursors_(std::make_unique<Cursors>()) {
  glfwSetWindowUserPointer(window, this);
  glfwSetCursorPosCallback(window, [](GLFWwindow* w, double x, double y) {
    of(w).add(PointerMoved{x, y});
  });
  glfwSetMouseButtonCallback(window, [](GLFWwindow* w, int button, int action, int) {
    if (button <= GLFW_MOUSE_BUTTON_MIDDLE)
      of(w).add(PointerPressed{PointerButton(button), action == GLFW_PRESS});
  });
  glfwSetScrollCallback(window, [](GLFWwindow* w, double dx, double dy) {
    of(w).add(WheelTurned{dx, dy});
  });
  glfwSetKeyCallback(window, [](GLFWwindow* w, int key, int scancode, int action, int) {
    const Key ours = key_as_printed(key, scancode);
    if (ours != Key::none)
      of(w).add(KeyPressed{ours, action != GLFW_RELEASE, action == GLFW_REPEAT});
  });
  glfwSetCharCallback(
      window, [](GLFWwindow* w, unsigned int codepoint) { of(w).add(TextTyped{codepoint}); });
  glfwSetWindowFocusCallback(window, [](GLFWwindow* w, int focused) {
    of(w).exposed_ |= focused == GLFW_TRUE;
    of(w).add(FocusChanged{focused == GLFW_TRUE});
  });
  glfwSetWindowRefreshCallback(window, [](GLFWwindow* w) { of(w).exposed_ = true; });
  glfwSetDropCallback(window, [](GLFWwindow* w, int count, const char** paths) {
    FilesDropped files;
    for (int i = 0; i < count; ++i) files.paths.emplace_back(paths[i]);
    of(w).add(std::move(files));
  });
}

GlfwInput::~GlfwInput() {
  glfwSetCursorPosCallback(window_, nullptr);
  glfwSetMouseButtonCallback(window_, nullptr);
  glfwSetScrollCallback(window_, nullptr);
  glfwSetKeyCallback(window_, nullptr);
  glfwSetCharCallback(window_, nullptr);
  glfwSetWindowFocusCallback(window_, nullptr);
  glfwSetWindowRefreshCallback(window_, nullptr);
  glfwSetDropCallback(window_, nullptr);
  glfwSetWindowUserPointer(window_, nullptr);
}

std::vector<InputEvent> GlfwInput::take(double window_units_per_ui_unit) {
  std::vector<InputEvent> out = std::exchange(events_, {});
  for (InputEvent& event : out)
    if (auto* move = std::get_if<PointerMoved>(&event)) {
      move->x /= window_units_per_ui_unit;
      move->y /= window_units_per_ui_unit;
    }
  return out;
}

void GlfwInput::set_pointer_look(PointerLook look) {
  if (look == look_) return;
  look_ = look;
  for (const auto& [kind, cursor] : cursors_->all)
    if (kind == look) glfwSetCursor(window_, cursor);
}

UiHost::Clipboard GlfwInput::clipboard() {
  return {[this] {
            const char* text = glfwGetClipboardString(window_);
            return std::string(text ? text : "");
          },
          [this](const std::string& text) { glfwSetClipboardString(window_, text.c_str()); }};
}

}  // namespace tumble
