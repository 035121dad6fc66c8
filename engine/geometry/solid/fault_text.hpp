#pragma once
#include "engine/geometry/hierarchy/triangle_decisions.hpp"

#include <algorithm>
#include <string>
#include <string_view>

#include <fmt/format.h>

/// Words for the faults of a mesh.
namespace tumble::fault_text {

/// More are not named one by one.
constexpr size_t named_items = 5;

/// "1 edge", "3 edges".
inline std::string counted(size_t n, std::string_view singular, std::string_view plural = {}) {
  if (n == 1) return fmt::format("1 {}", singular);
  return plural.empty() ? fmt::format("{} {}s", n, singular) : fmt::format("{} {}", n, plural);
}

inline std::string item(uint32_t i) {
  return fmt::format("{}", i);
}
inline std::string item(const std::array<uint32_t, 2>& e) {
  return fmt::format("{}-{}", e[0], e[1]);
}
inline std::string item(const TriangleIds& ids) {
  return fmt::format("{}-{}", ids.a, ids.b);
}

/// "(vertices 4-6 4-7 ...)": the first few.
template <class Items>
std::string named(std::string_view what, const Items& items) {
  std::string out = fmt::format("({}", what);
  for (size_t i = 0; i < std::min(items.size(), named_items); ++i) {
    out += fmt::format(" {}", item(items[i]));
  }
  out += items.size() > named_items ? " ...)" : ")";
  return out;
}

}  // namespace tumble::fault_text
