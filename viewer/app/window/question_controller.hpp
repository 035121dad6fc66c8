#pragma once
#include "viewer/ui/question.hpp"
#include "viewer/ui/ui_state.hpp"

#include <functional>
#include <optional>
#include <utility>
#include <vector>

namespace tumble {

/// The modal question that the window asks, and the effect of each answer.
class QuestionController {
 public:
  struct Asked {
    Question question{};
    std::vector<std::function<void()>> answers{};  ///< the last answer changes nothing
    bool quits = false;                            ///< asked before quitting
  };
  void ask(Asked asked, UiState& ui) {
    asked_ = std::move(asked);
    ui.hidden = false;
    ui.shows(PanelId::question) = true;
  }
  void answer(size_t choice, UiState& ui) {
    if (!asked_ || choice >= asked_->answers.size()) return;
    const auto act = asked_->answers[choice];
    asked_.reset();
    ui.shows(PanelId::question) = false;
    act();
  }
  void decline(UiState& ui) {
    if (asked_) answer(asked_->answers.size() - 1, ui);
  }
  void forget() { asked_.reset(); }
  bool open() const { return asked_.has_value(); }
  /// Requesting to quit again while this question is asked quits.
  bool quits() const { return asked_ && asked_->quits; }
  /// Null: there is no question.
  const Question* question() const { return asked_ ? &asked_->question : nullptr; }

 private:
  std::optional<Asked> asked_;
};

}  // namespace tumble
