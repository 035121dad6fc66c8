#include "viewer/ui/lesson_view.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace tumble {

size_t LessonView::questions() const {
  return size_t(std::ranges::count_if(steps, [](const auto& s) { return s.question.has_value(); }));
}

size_t LessonView::answered() const {
  return size_t(std::ranges::count_if(steps, [](const LessonStepView& s) {
    return s.question && s.question->verdict == AnswerVerdict::right;
  }));
}

std::optional<double> typed_number(std::string text, const std::string& unit) {
  std::erase(text, ' ');
  std::string without = unit;
  std::erase(without, ' ');
  if (!without.empty() && text.ends_with(without)) text.resize(text.size() - without.size());
  if (std::ranges::count(text, ',') == 1 && text.find('.') == std::string::npos)
    std::ranges::replace(text, ',', '.');
  if (text.starts_with('+')) text.erase(0, 1);
  double value = 0;
  const char* end = text.data() + text.size();
  const auto [stop, bad] = std::from_chars(text.data(), end, value);
  if (bad != std::errc{} || stop != end || !std::isfinite(value)) return std::nullopt;
  return value;
}

}  // namespace tumble
