#pragma once
#include "engine/core/result.hpp"
#include "engine/core/text.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace tumble {

/// Finds an entry by its `name` member in a list such as all_broad_phases(). The error lists the
/// names that exist, and the nearest one.
template <class Entry>
Result<const Entry*> find_named(const std::vector<Entry>& entries, std::string_view name,
                                std::string_view kind) {
  for (const Entry& e : entries)
    if (e.name == name) return &e;
  std::vector<std::string> names;
  for (const Entry& e : entries) names.emplace_back(e.name);
  return Error{ErrorCode::not_found, unknown_name(kind, name, names), {}, {}};
}

}  // namespace tumble
