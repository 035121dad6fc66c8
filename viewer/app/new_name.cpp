#include "viewer/app/new_name.hpp"

#include "engine/world/world.hpp"

#include <fmt/format.h>

namespace tumble {

std::string new_body_name(const World& world, const std::string& name) {
  if (name.empty() || world.find_body(name).is_null()) return name;
  const size_t end = name.find_last_not_of("0123456789");
  const bool numbered = end != std::string::npos && end + 1 < name.size() && name[end] == ' ';
  const std::string stem = numbered ? name.substr(0, end) : name;
  for (int n = 2;; ++n) {
    std::string next = fmt::format("{} {}", stem, n);
    if (world.find_body(next).is_null()) return next;
  }
}

}  // namespace tumble
