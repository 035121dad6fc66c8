#pragma once
#include <string>
#include <vector>

namespace tumble {

/// A modal question over the scene. Esc gives the last answer, which changes nothing.
struct Question {
  std::string title;
  std::vector<std::string> lines;
  struct Choice {
    std::string name;  ///< of its widget, "question.NAME"
    std::string text;
  };
  std::vector<Choice> choices;
};

}  // namespace tumble
