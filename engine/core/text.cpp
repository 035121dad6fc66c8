#include "engine/core/text.hpp"

#include <algorithm>
#include <cctype>

namespace tumble {
namespace {

/// Optimal string alignment distance (Damerau-Levenshtein without repeated edits).
size_t edit_distance(std::string_view a, std::string_view b) {
  const auto lower = [](char c) { return char(std::tolower(static_cast<unsigned char>(c))); };
  const size_t w = b.size() + 1;
  std::vector<size_t> d((a.size() + 1) * w);
  for (size_t i = 0; i <= a.size(); ++i) d[i * w] = i;
  for (size_t j = 0; j <= b.size(); ++j) d[j] = j;
  for (size_t i = 1; i <= a.size(); ++i) {
    for (size_t j = 1; j <= b.size(); ++j) {
      const size_t cost = lower(a[i - 1]) == lower(b[j - 1]) ? 0 : 1;
      size_t best =
          std::min({d[(i - 1) * w + j] + 1, d[i * w + j - 1] + 1, d[(i - 1) * w + j - 1] + cost});
      if (i > 1 && j > 1 && lower(a[i - 1]) == lower(b[j - 2]) &&
          lower(a[i - 2]) == lower(b[j - 1]))
        best = std::min(best, d[(i - 2) * w + j - 2] + 1);
      d[i * w + j] = best;
    }
  }
  return d.back();
}

/// Whether `part` is one or more of the words that underscores make of `name`: velocity of
/// linear_velocity.
bool is_part(std::string_view part, std::string_view name) {
  const std::string words = '_' + std::string(name) + '_';
  return !part.empty() && words.find('_' + std::string(part) + '_') != std::string::npos;
}

}  // namespace

std::string nearest_word(std::string_view word, std::span<const std::string> candidates) {
  if (word.empty() || word.size() > 64) return {};
  const std::string* best = nullptr;
  size_t best_distance = std::max<size_t>(1, word.size() / 3) + 1;
  for (const std::string& c : candidates) {
    const size_t distance = is_part(c, word) ? 1 : edit_distance(word, c);
    if (distance < best_distance) {
      best_distance = distance;
      best = &c;
    }
  }
  return best ? *best : std::string{};
}

std::string unknown_name(std::string_view kind, std::string_view name,
                         std::span<const std::string> known) {
  std::string out = "unknown " + std::string(kind) + " '" + std::string(name) + "'";
  if (const std::string near = nearest_word(name, known); !near.empty())
    out += ", did you mean '" + near + "'?";
  else if (!known.empty())
    out += ".";
  if (!known.empty()) {
    out += " Known: ";
    for (size_t i = 0; i < known.size(); ++i) out += (i ? ", " : "") + known[i];
  }
  return out;
}

}  // namespace tumble
