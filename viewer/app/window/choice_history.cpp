#include "viewer/app/window/choice_history.hpp"

#include <utility>

namespace tumble {
namespace {

/// Greatest number of steps; a request may contain the text of a scene.
constexpr size_t most_choices = 200;

}  // namespace

std::optional<ChoiceHistory::Step> ChoiceHistory::back() const {
  if (done_.empty()) return std::nullopt;
  Step step = done_.back();
  step.way = Way::back;
  return step;
}

std::optional<ChoiceHistory::Step> ChoiceHistory::again() const {
  if (undone_.empty()) return std::nullopt;
  Step step = undone_.back();
  step.way = Way::again;
  return step;
}

void ChoiceHistory::saved(const std::string& scene, const std::string& text) {
  for (std::vector<Step>* steps : {&done_, &undone_})
    for (Step& step : *steps)
      for (OpenRequest* wanted : {&step.before, &step.after}) {
        wanted->scene = scene;
        if (!wanted->text) wanted->text = text;
      }
}

void ChoiceHistory::gone(Step step) {
  if (step.way == Way::back) {
    if (!done_.empty()) done_.pop_back();
    undone_.push_back(std::move(step));
    return;
  }
  if (step.way == Way::anew)
    undone_.clear();
  else if (!undone_.empty())
    undone_.pop_back();
  done_.push_back(std::move(step));
  if (done_.size() > most_choices) done_.erase(done_.begin());
}

}  // namespace tumble
