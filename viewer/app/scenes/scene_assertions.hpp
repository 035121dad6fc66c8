#pragma once
#include "engine/math/expression.hpp"
#include "engine/scene/build.hpp"
#include "viewer/app/scenes/tick_watcher.hpp"
#include "viewer/ui/assertion_view.hpp"

#include <memory>
#include <mutex>
#include <vector>

namespace tumble {

/// Faults for unknown names in the assertions of a scene, with their lines.
std::vector<Fault> assertion_faults(const BuiltScene& scene);

/// Evaluates the assertions of a scene tick by tick, with a window or without in the same way. An
/// assertion with a time is evaluated at the first tick that reaches it, and at no other.
class SceneAssertions final : public TickWatcher {
 public:
  /// Keeps the names of the scene but not its world; null if it has no assertions. Assertions with
  /// faults (assertion_faults()) fail.
  static std::shared_ptr<SceneAssertions> make(const BuiltScene& scene);

  void see(const Frame& frame) override;
  void go_to(const Frame& frame) override;
  /// To be called with the last frame of the run.
  void finish(const Frame& frame);
  std::vector<AssertionView> views() const;
  /// The length of a run that decides all assertions [s].
  struct Span {
    double seconds = 0;
    bool assumed = false;  ///< no assertion names an end
  };
  /// The span up to the last time that an assertion names, if all `always` assertions have begun by
  /// then; otherwise `unsaid` [s] longer than the latest of their starts.
  Span span(double unsaid) const;
  /// The last time that any of them names [s].
  double last_moment() const;

 private:
  struct One {
    AssertionView view;
    Expression condition;
  };
  SceneAssertions() = default;
  void judge(One& one, const Frame& frame);

  std::shared_ptr<const BuiltScene> names_;  ///< without its world
  mutable std::mutex mutex_;
  std::vector<One> all_;
};

/// The outcome: a line for each assertion that fails, with its values, and for each that is
/// undecided.
std::string verdict_text(const std::vector<AssertionView>& assertions);
bool any_fails(const std::vector<AssertionView>& assertions);
/// Whether one is undecided because the run ended before its time.
bool any_waits(const std::vector<AssertionView>& assertions);

}  // namespace tumble
