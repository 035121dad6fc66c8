#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace tumble {

enum class AnswerVerdict : uint8_t {
  none,     ///< not answered yet
  unclear,  ///< the answer is not a number
  waiting,  ///< the world has not reached the time that decides
  wrong,
  right,
};

/// A question of a lesson and the answer given.
struct LessonQuestionView {
  std::string ask, unit, hint, why;
  std::optional<double> at;  ///< time that decides, if the answer is measured in the world [s]
  AnswerVerdict verdict = AnswerVerdict::none;
  std::string said;                ///< the answer as typed
  std::optional<double> right;     ///< the lesson's own answer, once it has been found
  std::optional<double> measured;  ///< the value measured in the world, once it has been
};

struct LessonStepView {
  std::string title;
  std::vector<std::string> text;    ///< paragraphs
  std::vector<std::string> choose;  ///< settings of the page, "path=value"
  bool chosen = false;              ///< they are the present settings
  bool seen = false;
  std::optional<LessonQuestionView> question;

  bool done() const { return seen && (!question || question->verdict == AnswerVerdict::right); }
};

/// A lesson and the progress in it.
struct LessonView {
  std::string about;
  std::vector<LessonStepView> steps;
  size_t step = 0;  ///< index of the page shown

  size_t questions() const;
  size_t answered() const;  ///< number of questions answered correctly
};

/// The number in a typed answer: with a comma or a point, with or without the unit after it.
std::optional<double> typed_number(std::string text, const std::string& unit);

}  // namespace tumble
