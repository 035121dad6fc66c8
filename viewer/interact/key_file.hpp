#pragma once
#include "viewer/interact/key_map.hpp"

namespace tumble {

/// The default bindings, in which those of the actions named in a key file are replaced (see
/// take_bindings()). Invalid entries are left out, with a line in `faults`.
std::vector<Binding> read_key_file(std::string_view json, std::vector<std::string>& faults);

/// A key with modifiers, such as "Ctrl+Shift+Z".
struct Chord {
  Key key = Key::none;
  uint8_t mods = 0;
};
std::optional<Chord> chord_from_text(std::string_view text);

}  // namespace tumble
