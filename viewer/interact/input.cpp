#include "viewer/interact/input.hpp"

#include <algorithm>
#include <cctype>

#include <fmt/format.h>

namespace tumble {
namespace {

struct NamedKey {
  Key key;
  std::string_view name;
};

constexpr NamedKey named_keys[] = {
    {Key::space, "Space"},
    {Key::escape, "Esc"},
    {Key::enter, "Enter"},
    {Key::tab, "Tab"},
    {Key::backspace, "Backspace"},
    {Key::insert, "Ins"},
    {Key::del, "Del"},
    {Key::right, "Right"},
    {Key::left, "Left"},
    {Key::down, "Down"},
    {Key::up, "Up"},
    {Key::page_up, "PageUp"},
    {Key::page_down, "PageDown"},
    {Key::home, "Home"},
    {Key::end, "End"},
    {Key::shift, "Shift"},
    {Key::control, "Ctrl"},
    {Key::alt, "Alt"},
    {Key::super, "Super"},
};

bool same_word(std::string_view a, std::string_view b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](unsigned char x, unsigned char y) {
    return std::tolower(x) == std::tolower(y);
  });
}

}  // namespace

std::string key_name(Key key) {
  for (const NamedKey& k : named_keys)
    if (k.key == key) return std::string(k.name);
  if (key >= Key::f1 && key <= Key::f12) return fmt::format("F{}", int(key) - int(Key::f1) + 1);
  if (int(key) > 32 && int(key) < 127) return std::string(1, char(key));
  return {};
}

Key key_from_name(std::string_view name) {
  for (const NamedKey& k : named_keys)
    if (same_word(k.name, name)) return k.key;
  if (name.size() == 1 && name[0] > 32 && name[0] < 127)
    return Key(std::toupper(static_cast<unsigned char>(name[0])));
  for (int n = 1; n <= 12; ++n)
    if (same_word(name, fmt::format("F{}", n))) return f_key(n);
  return Key::none;
}

void HeldInput::apply(const InputEvent& event) {
  if (const auto* move = std::get_if<PointerMoved>(&event)) {
    x = move->x;
    y = move->y;
  } else if (const auto* press = std::get_if<PointerPressed>(&event)) {
    buttons[size_t(press->button)] = press->down;
  } else if (const auto* key = std::get_if<KeyPressed>(&event)) {
    if (key->key < Key::count) keys[size_t(key->key)] = key->down;
  } else if (const auto* focus = std::get_if<FocusChanged>(&event); focus && !focus->focused) {
    // Releases that happen while another window has the focus are never reported.
    std::fill(std::begin(keys), std::end(keys), false);
    std::fill(std::begin(buttons), std::end(buttons), false);
  }
}

uint8_t HeldInput::mods() const {
  uint8_t m = Mods::none;
  if (key(Key::shift)) m |= Mods::shift;
  if (key(Key::control)) m |= Mods::ctrl;
  if (key(Key::alt)) m |= Mods::alt;
  if (key(Key::super)) m |= Mods::super;
  return m;
}

}  // namespace tumble
