// The lesson of a scene: pages that set camera, overlays and curves; answers; choices.
#include "viewer/app/scenes/scene_lesson.hpp"
#include "viewer/app/window/application.hpp"

#include <algorithm>

namespace tumble {

/// Shows the first page, or the page where the same scene was left.
void Application::begin_lesson() {
  ui_.shows(PanelId::lesson) = scene_.lesson != nullptr;
  lesson_overlays_.end(scene_.overlays, ui_.overlays);
  if (scene_.lesson) show_lesson_page(false);
}

void Application::turn_lesson_page(size_t step) {
  if (!scene_.lesson || step >= scene_.lesson->steps()) return;
  scene_.lesson->turn_to(step);
  show_lesson_page(true);
}

void Application::show_lesson_page(bool turned) {
  const SceneLesson::Wants& wants = scene_.lesson->wants();
  const LessonView lesson = scene_.lesson->view();
  const auto& question = lesson.steps[lesson.step].question;
  ui_.lesson_typed = question ? question->said : "";  // shown beside its verdict
  ui_.lesson_hint = false;
  ui_.content_height[size_t(PanelId::lesson)] = 0;
  lesson_overlays_.turn_to(wants.overlays, ui_.overlays);
  if (wants.view) {
    own_flight_ = false;
    camera_.look_from(*wants.view, world_.view());
  }
  // A scene opened anew has the curves of its page and the pages before; turning to a page without
  // curves keeps the present ones.
  if (!wants.plot.empty() && (wants.plots || !turned)) {
    instruments_.measures.clear();
    for (const Quantity& q : wants.plot) instruments_.measures.add(q, world_.frame());
    ui_.shows(PanelId::measure) = true;
    ui_.raise(PanelId::measure);
    ui_.raise(PanelId::lesson);  // in a low window its text goes before its curves
  }
  if (!wants.restart) return;
  session().set_paused(true);
  if (turned) restart(false);
}

void Application::answer_lesson(const std::string& said) {
  if (scene_.lesson) scene_.lesson->answer(said, world_.frame());
}

/// Opens the scene anew with the choices of this page, keeping the camera.
void Application::take_lesson_choice() {
  if (!scene_.lesson) return;
  choose(scene_.lesson->wants().choose, "The lesson's choice", 0);
}

/// Whether the world has the settings that the page chooses.
bool Application::lesson_choice_is_taken(const std::vector<std::string>& choose) const {
  for (const std::string& choice : choose)
    if (std::ranges::find(scene_.request.overrides, choice) == scene_.request.overrides.end())
      return false;
  return true;
}

std::optional<LessonView> Application::lesson_view() const {
  if (!scene_.lesson) return std::nullopt;
  LessonView view = scene_.lesson->view();
  // An answer measured on a page counts only in the world with the choices of that page, or without
  // any choice if the page has none.
  const bool some_choice = std::ranges::any_of(view.steps, [this](const LessonStepView& step) {
    return !step.choose.empty() && lesson_choice_is_taken(step.choose);
  });
  for (LessonStepView& step : view.steps) {
    step.chosen = !step.choose.empty() && lesson_choice_is_taken(step.choose);
    const bool its_world = step.choose.empty() ? !some_choice : step.chosen;
    if (step.question && !its_world) step.question->measured.reset();
  }
  return view;
}

}  // namespace tumble
