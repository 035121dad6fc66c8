#pragma once
#include <optional>
#include <string_view>

namespace tumble {

/// How well `text` answers a search: every character of `search` must occur in order (case and
/// spaces ignored). Runs, word beginnings and early matches count more. Nothing: no match.
std::optional<int> fuzzy_score(std::string_view search, std::string_view text);

}  // namespace tumble
