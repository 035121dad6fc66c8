#include "viewer/app/scenes/scene_lesson.hpp"

#include "engine/core/text.hpp"
#include "engine/scene/reader.hpp"
#include "engine/world/world.hpp"
#include "viewer/app/scenes/quantities.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace tumble {
namespace {

std::string path_of(size_t step, const std::string& key) {
  return fmt::format("lesson.steps[{}].{}", step, key);
}

Quantity curve_of(const std::shared_ptr<const BuiltScene>& names, const std::string& text) {
  Quantity out{text, unit_of_quantity(text), {}};
  auto parsed = Expression::parse(text);
  if (!parsed) {  // cannot happen in a scene that validate() accepts
    out.read = [](const Frame&) { return std::nullopt; };
    return out;
  }
  out.read = [names, e = *std::move(parsed)](const Frame& frame) -> std::optional<double> {
    const auto value =
        e.evaluate([&](std::string_view name) { return named_value(*names, frame, name); });
    return value ? std::optional(*value) : std::nullopt;
  };
  return out;
}

LessonStepView view_of(const LessonStepDescription& d, const std::vector<std::string>& choose) {
  LessonStepView out;
  out.title = d.title;
  out.text = d.text;
  out.choose = choose;
  if (d.question) {
    LessonQuestionView& q = out.question.emplace();
    q.ask = d.question->ask;
    q.unit = d.question->unit;
    q.hint = d.question->hint;
    q.why = d.question->why;
    q.at = d.question->at;
  }
  return out;
}

}  // namespace

std::vector<Fault> lesson_faults(
    const BuiltScene& scene,
    const std::function<std::vector<Fault>(const std::vector<std::string>&)>& with_choices) {
  std::vector<Fault> out;
  if (!scene.description->lesson) return out;
  const auto frame = scene.world->frame();
  const auto look = [&](const std::string& text, const std::string& path) {
    const auto parsed = Expression::parse(text);
    if (!parsed) return;  // reported by validate()
    for (const std::string& name : parsed->names()) {
      if (named_value(scene, *frame, name)) continue;
      const std::string near = nearest_word(name, quantity_names(scene));
      out.push_back(fault_at(*scene.description, path,
                             fmt::format("unknown quantity '{}'{}", name,
                                         near.empty() ? "" : ", did you mean '" + near + "'?")));
    }
  };
  const auto& steps = scene.description->lesson->steps;
  for (size_t i = 0; i < steps.size(); ++i) {
    for (size_t k = 0; k < steps[i].plot.size(); ++k)
      look(steps[i].plot[k], path_of(i, fmt::format("plot[{}]", k)));
    if (steps[i].question && !steps[i].question->quantity.empty())
      look(steps[i].question->quantity, path_of(i, "question.quantity"));
    if (steps[i].choose.empty() || !with_choices) continue;
    for (const Fault& f : with_choices(steps[i].choose))
      out.push_back(fault_at(*scene.description, path_of(i, "choose"),
                             fmt::format("cannot be chosen: {}: {}", f.path, f.message)));
  }
  return out;
}

std::shared_ptr<SceneLesson> SceneLesson::make(const BuiltScene& scene, double aspect) {
  if (!scene.description->lesson || scene.description->lesson->steps.empty()) return nullptr;
  const LessonDescription& lesson = *scene.description->lesson;
  std::shared_ptr<SceneLesson> out(new SceneLesson);
  out->names_ = names_of(scene);
  out->view_.about = lesson.about;
  std::vector<std::string> choose, plot;
  for (const LessonStepDescription& d : lesson.steps) {
    if (!d.choose.empty()) choose = d.choose;
    if (!d.plot.empty()) plot = d.plot;
    Wants& wants = out->wants_.emplace_back();
    wants.choose = choose;
    wants.restart = d.restart;
    if (!d.camera.empty())
      if (auto view = find_view_point(scene, d.camera, aspect)) wants.view = *std::move(view);
    if (const auto on = parse_overlays(fmt::format("{}", fmt::join(d.overlays, ","))))
      wants.overlays = *on;
    wants.plots = !d.plot.empty();
    for (const std::string& curve : plot) wants.plot.push_back(curve_of(out->names_, curve));
    out->view_.steps.push_back(view_of(d, d.choose));
    Truth& truth = out->truths_.emplace_back();
    if (!d.question) continue;
    truth.answer = d.question->answer;
    truth.at = d.question->at;
    truth.tolerance = d.question->tolerance;
    if (auto quantity = Expression::parse(d.question->quantity); quantity.ok())
      truth.quantity = *std::move(quantity);
  }
  out->view_.steps[0].seen = true;
  return out;
}

std::optional<double> SceneLesson::measure(const Truth& truth, const Frame& frame) const {
  if (!truth.quantity) return std::nullopt;
  const auto value = truth.quantity->evaluate(
      [&](std::string_view name) { return named_value(*names_, frame, name); });
  return value ? std::optional(*value) : std::nullopt;
}

void SceneLesson::see(const Frame& frame) {
  const std::lock_guard lock(mutex_);
  const double half = 0.5 * frame.rate.tick();
  for (size_t i = 0; i < truths_.size(); ++i) {
    Truth& truth = truths_[i];
    if (!truth.at || truth.measured) continue;
    if (frame.time < *truth.at - half || frame.time >= *truth.at + half) continue;
    truth.measured = measure(truth, frame);
    truth.when = frame.time;
    if (view_.steps[i].question->verdict == AnswerVerdict::waiting) judge(i);
  }
}

void SceneLesson::go_to(const Frame& frame) {
  {
    const std::lock_guard lock(mutex_);
    const double half = 0.5 * frame.rate.tick();
    for (Truth& truth : truths_)
      if (truth.at && truth.when > frame.time - half) truth.measured.reset();
  }
  see(frame);
}

LessonView SceneLesson::view() const {
  const std::lock_guard lock(mutex_);
  return view_;
}

void SceneLesson::turn_to(size_t step) {
  const std::lock_guard lock(mutex_);
  view_.step = std::min(step, view_.steps.size() - 1);
  view_.steps[view_.step].seen = true;
}

/// Judges with the lesson's own number if it has one, otherwise with the measured one.
void SceneLesson::judge(size_t step) {
  LessonQuestionView& q = *view_.steps[step].question;
  const Truth& truth = truths_[step];
  q.measured = truth.measured;
  const std::optional<double> right = truth.answer ? truth.answer : truth.measured;
  const auto said = typed_number(q.said, q.unit);
  if (!said) {
    q.verdict = AnswerVerdict::unclear;
  } else if (!right) {
    q.verdict = AnswerVerdict::waiting;
  } else {
    // Allows for the rounding of an answer given with all its digits.
    const double slack = 1e-9 * std::max(1.0, std::fabs(*right));
    const bool good = std::fabs(*said - *right) <= truth.tolerance + slack;
    q.verdict = good ? AnswerVerdict::right : AnswerVerdict::wrong;
    q.right = good ? right : std::nullopt;
  }
}

AnswerVerdict SceneLesson::answer(const std::string& said, const Frame& now) {
  const std::lock_guard lock(mutex_);
  auto& question = view_.steps[view_.step].question;
  if (!question) return AnswerVerdict::none;
  Truth& truth = truths_[view_.step];
  question->said = said;
  if (!truth.at) truth.measured = measure(truth, now);
  judge(view_.step);
  return question->verdict;
}

void SceneLesson::go_on_from(const SceneLesson& earlier) {
  const LessonView was = earlier.view();
  const std::lock_guard lock(mutex_);
  if (was.steps.size() != view_.steps.size()) return;
  view_.step = was.step;
  for (size_t i = 0; i < was.steps.size(); ++i) {
    LessonStepView& now = view_.steps[i];
    if (was.steps[i].title != now.title) continue;
    now.seen = was.steps[i].seen;
    if (now.question && was.steps[i].question && now.question->ask == was.steps[i].question->ask)
      now.question = was.steps[i].question;
  }
}

bool SceneLesson::Check::holds() const {
  return measured && (!answer || std::fabs(*measured - *answer) <= tolerance);
}

std::vector<SceneLesson::Check> SceneLesson::checks() const {
  const std::lock_guard lock(mutex_);
  std::vector<Check> out;
  for (size_t i = 0; i < truths_.size(); ++i)
    if (const Truth& t = truths_[i]; t.quantity && t.at)
      out.push_back({i, view_.steps[i].question->ask, *t.at, t.answer, t.measured, t.tolerance,
                     wants_[i].choose});
  return out;
}

}  // namespace tumble
