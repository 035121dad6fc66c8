#pragma once
#include "engine/core/random.hpp"

#include <cstdint>
#include <string>

namespace tumble {

/// A text with one to three changes: a number becomes another one that may be in its place, a byte
/// another byte, or some bytes go.
std::string damaged_text(std::string text, Random& random);
/// The text of a random scene, damaged; by number, the same on every machine.
std::string damaged_scene(uint64_t number);

}  // namespace tumble
