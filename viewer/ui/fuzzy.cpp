#include "viewer/ui/fuzzy.hpp"

#include <cctype>

namespace tumble {
namespace {

char lower(char c) {
  return char(std::tolower(static_cast<unsigned char>(c)));
}
bool separates(char c) {
  return c == ' ' || c == '_' || c == '-' || c == '.' || c == '/';
}

}  // namespace

std::optional<int> fuzzy_score(std::string_view search, std::string_view text) {
  int score = 0;
  size_t at = 0;
  bool running = false;
  for (const char wanted : search) {
    if (separates(wanted)) {
      running = false;
      continue;
    }
    const size_t before = at;
    while (at < text.size() && lower(text[at]) != lower(wanted)) ++at;
    if (at == text.size()) return std::nullopt;
    const bool word_begins = at == 0 || separates(text[at - 1]);
    score += 1;
    if (word_begins) score += 6;
    if (running && at == before) score += 8;
    if (at == 0) score += 4;
    score -= int(at - before) / 4;
    running = true;
    ++at;
  }
  return score;
}

}  // namespace tumble
