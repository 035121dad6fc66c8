#pragma once
#include "engine/core/random.hpp"

#include <cstdint>
#include <string>

namespace tumble {

/// A text with one to three changes: a number becomes another one that may be in its place, a byte
/// another byte, or some bytes go.
std::string damaged_text(std::string text, Random& random);
/// The same for bytes that hold binary numbers too: four of them become an extreme number, whole or
/// not; or a byte another byte; or some go, or come twice; or the end is cut off.
std::string damaged_bytes(std::string bytes, Random& random);
/// The text of a random scene, damaged; by number, the same on every machine.
std::string damaged_scene(uint64_t number);

}  // namespace tumble
