#pragma once
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tumble {

/// The candidate nearest to `word` by edit distance (case ignored, transpositions count one; one
/// that is a whole part of it, as `velocity` of `linear_velocity`, is one edit away), or empty when
/// none is near enough to be what was meant.
std::string nearest_word(std::string_view word, std::span<const std::string> candidates);

/// "unknown KIND 'NAME', did you mean 'X'? Known: a, b, c"
std::string unknown_name(std::string_view kind, std::string_view name,
                         std::span<const std::string> known);

}  // namespace tumble
