#pragma once
#include "viewer/interact/key_map.hpp"

namespace tumble {

/// The usual bindings with those of a file of bindings in the place of their actions' (see
/// take_bindings()). What is wrong is left out, with a line in `faults`.
std::vector<Binding> read_key_file(std::string_view json, std::vector<std::string>& faults);

/// "Ctrl+Shift+Z" as key and modifiers.
struct Chord {
  Key key = Key::none;
  uint8_t mods = 0;
};
std::optional<Chord> chord_from_text(std::string_view text);

}  // namespace tumble
