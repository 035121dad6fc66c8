#pragma once
#include <span>
#include <string>

namespace tumble {

class World;

/// A name for a new body that nobody has, and that scene files take: `name` itself, else "crate_2"
/// for "crate" and "crate_3" for "crate_2". Copies are "brick[3]" in the world, and nobody else is:
/// what is made of one is "brick", or "brick_2" where the row of "brick" is. An empty one stays
/// empty. `coming`: names of bodies that wait for the next tick to be made.
std::string new_body_name(const World& world, const std::string& name,
                          std::span<const std::string> coming = {});

}  // namespace tumble
