#include "viewer/ui/fuzzy.hpp"

#include <algorithm>
#include <cctype>
#include <limits>
#include <vector>

namespace tumble {
namespace {

char lower(char c) {
  return char(std::tolower(static_cast<unsigned char>(c)));
}
bool separates(char c) {
  return c == ' ' || c == '_' || c == '-' || c == '.' || c == '/';
}

/// Scores of a matched letter: anywhere in the text, at the beginning of a word, directly after the
/// previous match, and at the beginning of the text; each skipped letter costs one.
constexpr int found = 4, begins_word = 24, runs_on = 60, begins_text = 16;

int worth(std::string_view text, size_t at) {
  return found + (at == 0 || separates(text[at - 1]) ? begins_word : 0) +
         (at == 0 ? begins_text : 0);
}

}  // namespace

/// Maximises over all ways to find the letters in order, by dynamic programming over search and
/// text (Smith and Waterman 1981, with a gap cost linear in the length).
std::optional<int> fuzzy_score(std::string_view search, std::string_view text) {
  constexpr int never = std::numeric_limits<int>::min() / 2;
  // best[i]: best score of all search letters so far, the last of which is matched to text[i].
  std::vector<int> best(text.size(), never), next(text.size(), never);
  bool first = true, running = false;
  for (const char wanted : search) {
    if (separates(wanted)) {
      running = false;
      continue;
    }
    int before = never;  // best score of the previous letters, matched left of here, minus the
                         // letters skipped since
    for (size_t i = 0; i < text.size(); ++i) {
      next[i] = never;
      const int start = first ? -int(i) : before;
      if (lower(text[i]) == lower(wanted) && start > never / 2) {
        next[i] = start + worth(text, i);
        if (running && i > 0 && best[i - 1] > never / 2)
          next[i] = std::max(next[i], best[i - 1] + worth(text, i) + runs_on);
      }
      before = std::max(before - 1, best[i]);
    }
    best.swap(next);
    first = false;
    running = true;
  }
  if (first) return 0;
  const int score = text.empty() ? never : std::ranges::max(best);
  return score > never / 2 ? std::optional(score) : std::nullopt;
}

}  // namespace tumble
