#include "viewer/app/new_name.hpp"

#include "engine/world/world.hpp"

#include <fmt/format.h>

namespace tumble {

std::string new_body_name(const World& world, const std::string& name) {
  if (name.empty() || world.find_body(name).is_null()) return name;
  std::string stem = name.substr(0, name.find('['));
  const size_t end = stem.find_last_not_of("0123456789");
  if (end != std::string::npos && end + 1 < stem.size() && stem[end] == '_') stem.resize(end);
  for (int n = 2;; ++n) {
    std::string next = fmt::format("{}_{}", stem, n);
    if (world.find_body(next).is_null()) return next;
  }
}

}  // namespace tumble
