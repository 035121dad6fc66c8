#include "viewer/app/editing/new_name.hpp"

#include "engine/world/world.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace tumble {

namespace {

/// Whether a name belongs to a body, or to a row of copies "brick[0]", "brick[1]", ...
bool is_taken(const World& world, std::span<const std::string> coming, const std::string& name) {
  return std::ranges::find(coming, name) != coming.end() || !world.find_body(name).is_null() ||
         !world.find_body(name + "[0]").is_null();
}

}  // namespace

std::string new_body_name(const World& world, const std::string& name,
                          std::span<const std::string> coming) {
  std::string stem = name.substr(0, name.find('['));
  if (stem.empty() || !is_taken(world, coming, stem)) return stem;
  const size_t end = stem.find_last_not_of("0123456789");
  if (end != std::string::npos && end + 1 < stem.size() && stem[end] == '_') stem.resize(end);
  for (int n = 2;; ++n) {
    std::string next = fmt::format("{}_{}", stem, n);
    if (!is_taken(world, coming, next)) return next;
  }
}

}  // namespace tumble
