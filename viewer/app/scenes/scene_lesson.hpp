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

/// Faults in the lesson of a scene that validate() cannot see: unknown names of quantities, and
/// choices of settings for which `with_choices` finds faults.
std::vector<Fault> lesson_faults(
    const BuiltScene& scene,
    const std::function<std::vector<Fault>(const std::vector<std::string>&)>& with_choices);

/// The lesson of a scene and the user's progress in it. Answers measured in the world are taken at
/// the first tick that reaches their time.
class SceneLesson final : public TickWatcher {
 public:
  /// What a page wants to be shown.
  struct Wants {
    std::optional<ViewPoint> view;
    Overlays overlays;
    std::vector<Quantity> plot;  ///< of this page, or of the last page before it that has plots
    bool plots = false;          ///< they are those of this page
    std::vector<std::string> choose;  ///< of this page, or of the last page before it with a choice
    bool restart = false;
  };

  /// Keeps the names of the scene but not its world; null if it has no lesson.
  static std::shared_ptr<SceneLesson> make(const BuiltScene& scene, double aspect);

  void see(const Frame& frame) override;
  void go_to(const Frame& frame) override;

  LessonView view() const;
  size_t step() const { return view_.step; }
  size_t steps() const { return view_.steps.size(); }
  const Wants& wants() const { return wants_[view_.step]; }
  /// Shows another page; an index out of range is clamped.
  void turn_to(size_t step);
  /// Judges the answer to this page's question. `now` is measured if the question has no time.
  AnswerVerdict answer(const std::string& said, const Frame& now);
  /// Takes over the progress in the same lesson of a scene opened before.
  void go_on_from(const SceneLesson& earlier);

  /// For runs without a window: the measured answer to each question that the world can decide, and
  /// its distance from the lesson's answer.
  struct Check {
    size_t step;
    std::string ask;
    double at;  ///< time of the measurement [s]
    std::optional<double> answer, measured;
    double tolerance;
    std::vector<std::string> choose;  ///< settings under which it is asked
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
    double when = 0;  ///< time of the measurement [s]
  };
  SceneLesson() = default;
  std::optional<double> measure(const Truth& truth, const Frame& frame) const;
  void judge(size_t step);

  std::shared_ptr<const BuiltScene> names_;  ///< without its world
  std::vector<Wants> wants_;
  mutable std::mutex mutex_;
  LessonView view_;
  std::vector<Truth> truths_;  ///< one per page
};

}  // namespace tumble
