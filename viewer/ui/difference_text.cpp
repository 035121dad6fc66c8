#include "viewer/ui/difference_text.hpp"

#include "viewer/ui/parameter_widgets.hpp"

#include <algorithm>
#include <string_view>

#include <fmt/format.h>

namespace tumble {
namespace {

/// The words without the name with which they may begin.
std::string_view without_name(std::string_view words, std::string_view name) {
  if (words.starts_with(name) && words.substr(name.size()).starts_with(' '))
    words.remove_prefix(name.size() + 1);
  return words;
}

std::string value_text(std::string_view words, std::string_view name) {
  words = without_name(words, name);
  const bool number = !words.empty() && (words[0] == '-' || (words[0] >= '0' && words[0] <= '9'));
  return number ? unit_words(words) : std::string(words);
}

}  // namespace

std::string difference_text(const WorldDifference& d) {
  std::string name = d.path.substr(d.path.rfind('.') + 1);
  const std::string label = name == "simd" ? "SIMD" : label_of(name);
  std::ranges::replace(name, '_', ' ');
  return fmt::format("{}: {} in A, {} in B", label, value_text(d.words_a, name),
                     value_text(d.words_b, name));
}

}  // namespace tumble
