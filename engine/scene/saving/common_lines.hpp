#pragma once
#include <cstddef>
#include <string_view>
#include <vector>

namespace tumble {

/// The lines of a text, without their ends.
std::vector<std::string_view> lines_of_text(std::string_view text);

/// Lines that two texts share.
struct CommonLine {
  size_t a = 0, b = 0;  ///< their numbers, from 0
};
/// A longest common subsequence of lines, in order. Takes time and memory of the product of the
/// numbers of lines between the common beginning and the common end.
std::vector<CommonLine> common_lines(const std::vector<std::string_view>& a,
                                     const std::vector<std::string_view>& b);

}  // namespace tumble
