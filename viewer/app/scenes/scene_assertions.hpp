#pragma once
#include "engine/math/expression.hpp"
#include "engine/scene/build.hpp"
#include "viewer/app/scenes/tick_watcher.hpp"
#include "viewer/ui/assertion_view.hpp"

#include <memory>
#include <mutex>
#include <vector>

namespace tumble {

/// Names in the assertions of a scene that it does not have, with their lines.
std::vector<Fault> assertion_faults(const BuiltScene& scene);

/// The assertions of a scene, judged tick by tick, in the window and without it in the same way: an
/// assertion with a moment by the tick at which it comes, and no other.
class SceneAssertions final : public TickWatcher {
 public:
  /// Keeps the names of the scene and not its world; null where it has no assertions. Those that
  /// assertion_faults() finds fault with fail.
  static std::shared_ptr<SceneAssertions> make(const BuiltScene& scene);

  void see(const Frame& frame) override;
  void go_to(const Frame& frame) override;
  /// The run ends with this frame.
  void finish(const Frame& frame);
  std::vector<AssertionView> views() const;
  /// How long a run decides them all [s].
  struct Span {
    double seconds = 0;
    bool assumed = false;  ///< none of them says when to end
  };
  /// To the last moment that one of them names, if that comes after all `always` have begun; else
  /// for `unsaid` after that.
  Span span(double unsaid) const;
  /// The last moment that any of them names [s].
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

/// What came of them: a line for each that fails, with its values, and for each that still waits.
std::string verdict_text(const std::vector<AssertionView>& assertions);
bool any_fails(const std::vector<AssertionView>& assertions);
/// Whether one is not decided: the run ended before its moment.
bool any_waits(const std::vector<AssertionView>& assertions);

}  // namespace tumble
