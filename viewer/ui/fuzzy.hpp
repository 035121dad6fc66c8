#pragma once
#include <optional>
#include <string_view>

namespace tumble {

/// Score of `text` for a search: every character of `search` must occur in order (case and spaces
/// ignored). Consecutive matches, beginnings of words and early matches score higher. Empty: no
/// match.
std::optional<int> fuzzy_score(std::string_view search, std::string_view text);

}  // namespace tumble
