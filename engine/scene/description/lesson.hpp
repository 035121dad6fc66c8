#pragma once
#include "engine/scene/description/values.hpp"

#include <optional>
#include <string>
#include <vector>

namespace tumble {

/// A question of a lesson. The answer is a number given by the lesson, or a quantity of the world.
struct QuestionDescription {
  std::string ask;
  std::optional<double> answer;
  std::string quantity;      ///< an expression over what `tumble simulate --assert` knows
  std::optional<double> at;  ///< time of the measurement [s]; none: when the question is answered
  double tolerance = 0;      ///< in units of the answer
  std::string unit;
  std::string hint;
  std::string why;

  static constexpr std::string_view schema_name = "question";
  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.field(d.ask,
            {.name = "ask", .required = true, .doc = "the question, whose answer is a number"});
    v.field(d.answer, {.name = "answer", .min = -1e15, .max = 1e15, .doc = "the right number"});
    v.field(d.quantity,
            {.name = "quantity",
             .doc = "an expression over quantities of --assert: the world's own answer"});
    v.field(d.at, {.name = "at",
                   .unit = "s",
                   .min = 0,
                   .max = 1e6,
                   .doc = "the moment of the quantity; the one that is shown unless given"});
    v.field(d.tolerance, {.name = "tolerance",
                          .min = 0,
                          .max = 1e15,
                          .required = true,
                          .doc = "by how much an answer may differ, in units of the answer"});
    v.field(d.unit, {.name = "unit", .doc = "of the answer, for people"});
    v.field(d.hint, {.name = "hint", .doc = "a help for who asks for it"});
    v.field(d.why, {.name = "why", .doc = "what is said to the right answer"});
  }
  static void check(const QuestionDescription& d, Complaints& complaints);
};

/// A page of a lesson, with the camera, overlays and plots for it.
struct LessonStepDescription {
  std::string title;
  std::vector<std::string> text;      ///< one text per paragraph
  std::string camera;                 ///< of the scene; empty: the view stays
  std::vector<std::string> overlays;  ///< on while this page is read
  std::vector<std::string> plot;      ///< expressions over what --assert knows
  std::vector<std::string> choose;    ///< "path=value", as for --set
  bool restart = false;
  std::optional<QuestionDescription> question;

  static constexpr std::string_view schema_name = "lesson_step";
  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.field(d.title, {.name = "title", .required = true, .doc = "of the page"});
    v.field(d.text, {.name = "text", .required = true, .doc = "its paragraphs"});
    v.field(d.camera, {.name = "camera", .doc = "name of a camera to look from"});
    v.field(d.overlays, {.name = "overlays", .doc = "what is drawn over the bodies on this page"});
    v.field(d.plot, {.name = "plot", .doc = "expressions over quantities of --assert, as curves"});
    v.field(d.choose, {.name = "choose",
                       .doc = "path=value of settings and parameters to be chosen, as of --set"});
    v.field(d.restart, {.name = "restart", .doc = "the page begins at the first tick, paused"});
    v.object(d.question, {.name = "question", .doc = "to be answered before going on"});
  }
  static void check(const LessonStepDescription& d, Complaints& complaints);
};

/// A lesson of a scene, shown page by page beside the picture.
struct LessonDescription {
  std::string about;
  std::vector<LessonStepDescription> steps;

  static constexpr std::string_view schema_name = "lesson";
  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.field(d.about, {.name = "about", .doc = "one line: what is learnt"});
    v.list(d.steps, {.name = "steps", .required = true, .doc = "the pages"});
  }
  static void check(const LessonDescription& d, Complaints& complaints) {
    if (d.steps.empty()) complaints.add("steps", "a lesson without pages: give at least one");
  }
};

}  // namespace tumble
