#pragma once
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tumble {

/// The candidate nearest to `word` by edit distance, or empty if none is near enough to be meant.
/// Case is ignored, a transposition counts as one edit, and so does a candidate that is a whole
/// part of the word, as `velocity` is of `linear_velocity`.
std::string nearest_word(std::string_view word, std::span<const std::string> candidates);

/// "unknown KIND 'NAME', did you mean 'X'? Known: a, b, c"
std::string unknown_name(std::string_view kind, std::string_view name,
                         std::span<const std::string> known);

}  // namespace tumble
