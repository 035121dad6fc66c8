#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace tumble {

enum class AnswerVerdict : uint8_t {
  none,     ///< nothing was answered yet
  unclear,  ///< not a number
  waiting,  ///< the world has not come to the moment that decides
  wrong,
  right,
};

/// A question of a lesson, and what was answered.
struct LessonQuestionView {
  std::string ask, unit, hint, why;
  std::optional<double> at;  ///< the moment that decides, if the world does [s]
  AnswerVerdict verdict = AnswerVerdict::none;
  std::string said;                ///< the answer, as it was typed
  std::optional<double> right;     ///< the answer of the lesson, once it was found
  std::optional<double> measured;  ///< the world's own, once it was found
};

struct LessonStepView {
  std::string title;
  std::vector<std::string> text;    ///< paragraphs
  std::vector<std::string> choose;  ///< "path=value"
  bool chosen = false;              ///< they are the ones of now
  bool seen = false;
  std::optional<LessonQuestionView> question;

  bool done() const { return seen && (!question || question->verdict == AnswerVerdict::right); }
};

/// A lesson and how far a person has come.
struct LessonView {
  std::string about;
  std::vector<LessonStepView> steps;
  size_t step = 0;  ///< the page that is shown

  size_t questions() const;
  size_t answered() const;  ///< rightly
};

/// The number in what a person typed: with a comma or a point, and with the unit behind it or
/// without.
std::optional<double> typed_number(std::string text, const std::string& unit);

}  // namespace tumble
