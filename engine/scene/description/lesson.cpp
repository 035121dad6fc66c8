#include "engine/scene/description/lesson.hpp"

#include "engine/math/expression.hpp"

#include <cmath>

#include <fmt/format.h>

namespace tumble {
namespace {

/// Why a text is not an expression for a number; "" if it is.
std::string not_a_number(const std::string& text) {
  const auto parsed = Expression::parse(text);
  if (!parsed) return parsed.error().text();
  if (parsed->is_condition())
    return "'" + text + "' is true or false, and not a number: name a quantity";
  return {};
}

}  // namespace

void QuestionDescription::check(const QuestionDescription& d, Complaints& complaints) {
  if (!d.answer && d.quantity.empty())
    complaints.add({}, "has no answer: give the number as 'answer', or a 'quantity' of the world");
  if (!d.quantity.empty())
    if (const std::string wrong = not_a_number(d.quantity); !wrong.empty())
      complaints.add("quantity", wrong);
  if (d.at && d.quantity.empty())
    complaints.add("at", "the moment of what? give a 'quantity' of the world, or leave 'at' away");
  const bool whole = d.answer && *d.answer == std::floor(*d.answer);
  if (d.tolerance == 0 && !whole)
    complaints.add("tolerance", "0 fits whole numbers only: nobody types all figures of others");
}

void LessonStepDescription::check(const LessonStepDescription& d, Complaints& complaints) {
  for (size_t i = 0; i < d.plot.size(); ++i)
    if (const std::string wrong = not_a_number(d.plot[i]); !wrong.empty())
      complaints.add(fmt::format("plot[{}]", i), wrong);
  for (size_t i = 0; i < d.choose.size(); ++i) {
    const std::string& c = d.choose[i];
    const bool known = c.starts_with("settings.") || c.starts_with("parameters.");
    if (!known || c.find('=') == std::string::npos)
      complaints.add(
          fmt::format("choose[{}]", i),
          "'" + c + "' chooses nothing: write settings.PATH=value or parameters.NAME=value");
  }
}

}  // namespace tumble
