#include "viewer/interact/paced_input.hpp"

#include <cstddef>

namespace tumble {
namespace {

bool is_command_modifier(Key key) {
  return key == Key::control || key == Key::alt || key == Key::super;
}
/// Keys whose effect on a text field is not the text that they type.
bool edits_text(Key key) {
  return key >= Key::escape && key <= Key::end;
}

}  // namespace

/// A key that edits is seen only if it is down during one picture and up during another. Of one
/// picture the panels take the text first, and then such keys.
size_t PacedInput::count_fitting() const {
  bool typed = false, commanded = false;
  bool changed[size_t(Key::count)] = {};
  for (size_t i = 0; i < waiting_.size(); ++i) {
    const InputEvent& event = waiting_[i];
    if (std::holds_alternative<TextTyped>(event)) {
      if (commanded) return i;
      typed = true;
    } else if (const auto* press = std::get_if<PointerPressed>(&event)) {
      if (press->down && typed) return i;
      commanded = commanded || press->down;
    } else if (const auto* key = std::get_if<KeyPressed>(&event); key && key->key < Key::count) {
      const bool modifier = is_command_modifier(key->key);
      if (key->repeat || (!modifier && !edits_text(key->key))) continue;
      if (changed[size_t(key->key)] || (modifier && key->down && typed)) return i;
      changed[size_t(key->key)] = true;
      commanded = commanded || key->down;
    }
  }
  return waiting_.size();
}

std::vector<InputEvent> PacedInput::take() {
  const auto end = waiting_.begin() + std::ptrdiff_t(count_fitting());
  std::vector<InputEvent> out(waiting_.begin(), end);
  waiting_.erase(waiting_.begin(), end);
  return out;
}

}  // namespace tumble
