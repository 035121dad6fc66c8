#pragma once
#include "engine/math/expression.hpp"
#include "engine/scene/build.hpp"
#include "viewer/app/scenes/scene_look.hpp"
#include "viewer/app/scenes/tick_watcher.hpp"
#include "viewer/ui/lesson_view.hpp"
#include "viewer/ui/measures.hpp"

#include <functional>
#include <memory>
#include <mutex>
#include <vector>

namespace tumble {

/// What is wrong with the lesson of a scene beyond what validate() sees: names of quantities that
/// the scene does not have, and choices for which `with_choices` finds faults.
std::vector<Fault> lesson_faults(
    const BuiltScene& scene,
    const std::function<std::vector<Fault>(const std::vector<std::string>&)>& with_choices);

/// The lesson of a scene with how far a person has come. The world's answers are taken tick by
/// tick, each at the tick of its moment.
class SceneLesson final : public TickWatcher {
 public:
  /// What a page wants to be seen.
  struct Wants {
    std::optional<ViewPoint> view;
    Overlays overlays;
    std::vector<Quantity> plot;       ///< of this page, or of the last before it that plots
    bool plots = false;               ///< they are of this page
    std::vector<std::string> choose;  ///< of this page, or of the last before it that chooses
    bool restart = false;
  };

  /// Keeps the names of the scene and not its world; null where it teaches nothing.
  static std::shared_ptr<SceneLesson> make(const BuiltScene& scene, double aspect);

  void see(const Frame& frame) override;
  void go_to(const Frame& frame) override;

  LessonView view() const;
  size_t step() const { return view_.step; }
  size_t steps() const { return view_.steps.size(); }
  const Wants& wants() const { return wants_[view_.step]; }
  /// Another page; out of range: the nearest.
  void turn_to(size_t step);
  /// Judges the answer to this page's question. `now` decides where no moment is given.
  AnswerVerdict answer(const std::string& said, const Frame& now);
  /// Goes on where the same lesson was left in a scene that was opened before.
  void go_on_from(const SceneLesson& earlier);

  /// For runs without a window: what the world says to each question that it can decide, and how
  /// far that is from the lesson's own answer.
  struct Check {
    size_t step;
    std::string ask;
    double at;  ///< [s]
    std::optional<double> answer, measured;
    double tolerance;
    std::vector<std::string> choose;  ///< what must have been chosen
    bool holds() const;
  };
  std::vector<Check> checks() const;

 private:
  struct Truth {
    std::optional<double> answer;
    std::optional<Expression> quantity;
    std::optional<double> at;
    double tolerance = 0;
    std::optional<double> measured;
    double when = 0;  ///< it was measured [s]
  };
  SceneLesson() = default;
  std::optional<double> measure(const Truth& truth, const Frame& frame) const;
  void judge(size_t step);

  std::shared_ptr<const BuiltScene> names_;  ///< without its world
  std::vector<Wants> wants_;
  mutable std::mutex mutex_;
  LessonView view_;
  std::vector<Truth> truths_;  ///< one a page
};

}  // namespace tumble
