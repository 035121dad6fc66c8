#include "engine/scene/saving/changed_lines.hpp"

#include "engine/scene/saving/common_lines.hpp"

#include <fmt/format.h>

namespace tumble {

std::vector<std::string> changed_lines(const std::string& before, const std::string& after) {
  const auto a = lines_of_text(before), b = lines_of_text(after);
  std::vector<CommonLine> shared = common_lines(a, b);
  shared.push_back({a.size(), b.size()});
  std::vector<std::string> out;
  size_t i = 0, j = 0;
  for (const CommonLine& line : shared) {
    for (; i < line.a; ++i) out.push_back(fmt::format("- {}: {}", i + 1, a[i]));
    for (; j < line.b; ++j) out.push_back(fmt::format("+ {}: {}", j + 1, b[j]));
    ++i, ++j;
  }
  return out;
}

}  // namespace tumble
