#pragma once
#include <span>
#include <string>

namespace tumble {

class World;

/// An unused name for a new body that scene files accept: `name` itself, otherwise "crate_2" for
/// "crate" and "crate_3" for "crate_2". Indices "brick[3]" are reserved for copies of a repetition:
/// a body made from one of them is named "brick", or "brick_2" if the row "brick" exists. An empty
/// name stays empty. `coming`: names of bodies that will be created at the next tick.
std::string new_body_name(const World& world, const std::string& name,
                          std::span<const std::string> coming = {});

}  // namespace tumble
