#pragma once
#include <string>

namespace tumble {

class World;

/// A name for a new body that nobody has: `name` itself, else "crate 2" for "crate" and "crate 3"
/// for "crate 2". An empty one stays empty.
std::string new_body_name(const World& world, const std::string& name);

}  // namespace tumble
