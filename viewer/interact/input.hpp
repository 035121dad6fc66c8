#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace tumble {

// Input events, independent of any window library: they come from GLFW, from a script or from
// tests.

/// Physical keys that Tumble knows. Letters and digits have the values of their ASCII characters.
enum class Key : uint16_t {
  none = 0,
  space = ' ',
  apostrophe = '\'',
  comma = ',',
  minus = '-',
  period = '.',
  slash = '/',
  digit_0 = '0',
  digit_9 = '9',
  semicolon = ';',
  equal = '=',
  a = 'A',
  d = 'D',
  e = 'E',
  q = 'Q',
  s = 'S',
  w = 'W',
  z = 'Z',
  left_bracket = '[',
  backslash = '\\',
  right_bracket = ']',
  grave = '`',
  escape = 128,
  enter,
  tab,
  backspace,
  insert,
  del,
  right,
  left,
  down,
  up,
  page_up,
  page_down,
  home,
  end,
  shift,
  control,
  alt,
  super,
  f1 = 160,
  f12 = f1 + 11,
  count = 256,
};
constexpr Key letter_key(char upper) {
  return Key(upper);
}
constexpr Key f_key(int n) {
  return Key(int(Key::f1) + n - 1);
}

/// Modifier keys held, as bits.
struct Mods {
  static constexpr uint8_t none = 0, shift = 1, ctrl = 2, alt = 4, super = 8;
};

enum class PointerButton : uint8_t { left = 0, right = 1, middle = 2 };

/// Positions are in UI units (window coordinates): top left origin, y down.
struct PointerMoved {
  double x = 0, y = 0;
};
struct PointerPressed {
  PointerButton button = PointerButton::left;
  bool down = true;
};
struct WheelTurned {
  double dx = 0, dy = 0;  ///< notches; dy > 0 is away from the user
};
struct KeyPressed {
  Key key = Key::none;
  bool down = true;
  bool repeat = false;
};
struct TextTyped {
  uint32_t codepoint = 0;
};
struct FilesDropped {
  std::vector<std::string> paths;
};
struct FocusChanged {
  bool focused = true;
};

using InputEvent = std::variant<PointerMoved, PointerPressed, WheelTurned, KeyPressed, TextTyped,
                                FilesDropped, FocusChanged>;

/// "Space", "F5", "Ctrl", "[": as printed in the help and understood by scripts.
std::string key_name(Key key);
/// The key of that name (case ignored), or Key::none.
Key key_from_name(std::string_view name);

/// The keys and buttons that are held after the events so far.
struct HeldInput {
  bool keys[size_t(Key::count)] = {};
  bool buttons[3] = {};
  double x = -1e6, y = -1e6;  ///< pointer; far outside before the first move

  void apply(const InputEvent& event);
  bool key(Key k) const { return keys[size_t(k)]; }
  bool button(PointerButton b) const { return buttons[size_t(b)]; }
  uint8_t mods() const;
};

}  // namespace tumble
