#pragma once
#include "viewer/app/editing/edit_history.hpp"
#include "viewer/app/editing/unsaved_work.hpp"
#include "viewer/app/window/choice_history.hpp"
#include "viewer/interact/picking.hpp"
#include "viewer/interact/selection.hpp"

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tumble {

/// Manages the user's changes to the scene (undo steps): undo and redo of changes in the world,
/// beside it, and of choices of numbers, and the unsaved work. After each change the run takes a
/// new course, of which the latest tick seen is known.
class UndoManager {
 public:
  /// `folder`: where unsaved work is kept; empty: nowhere.
  explicit UndoManager(std::filesystem::path folder) : unsaved_(std::move(folder)) {}

  /// To be called when another world is shown; its file is passed to unsaved().
  void forget();
  EditHistory& edits() { return edits_; }
  const EditHistory& edits() const { return edits_; }
  ChoiceHistory& choices() { return choices_; }
  UnsavedWork& unsaved() { return unsaved_; }

  /// To be called before each change. `held`: a button or key is being held, and the same change
  /// requested repeatedly meanwhile is one undo step. `now`: the tick shown.
  UndoStepEdits begin(Session& session, std::string what, bool held, uint64_t now,
                      std::vector<BodyId> selected);
  /// The same for a change that does not concern the world: see EditHistory.
  void begin_beside(std::string what, bool held, std::function<void()> exchange);
  /// Whether such a change would continue the newest undo step.
  bool goes_on(std::string_view what, bool held) const;
  /// Drops the newest undo step, which has had no effect.
  void drop_newest();
  /// Goes back to before the newest undo step, which has had no effect after all.
  void leave_newest(Session& session);
  /// To be called when nothing is held any more: the next change is an undo step of its own.
  void end_gesture() { gesture_.clear(); }
  /// Undoes the newest change, or redoes the last undone one; empty if there is none.
  std::optional<EditHistory::Back> take_back(Session& session, std::vector<BodyId> selected);
  std::optional<EditHistory::Back> do_again(Session& session, std::vector<BodyId> selected);
  /// Records the newest changes as unsaved work at once.
  void finish(Session& session, bool own_thread);

  /// To be called when the world goes to a moment after which history takes another course, if it
  /// was `changed` or there were any changes by the user.
  void jump(bool changed) { other_course_ = changed || !edits_.empty(); }
  /// Takes the tick shown. `jumped`: time did not simply advance.
  void see(uint64_t tick, bool jumped);
  /// The latest tick seen on this course.
  uint64_t newest_tick() const { return newest_tick_; }
  /// If no selected body exists any more, selects what was selected at the moment that undo or redo
  /// went to.
  void select_as_then(const Frame& frame, Selection& selection);

 private:
  std::optional<EditHistory::Back> went(std::optional<EditHistory::Back> back);

  EditHistory edits_;
  ChoiceHistory choices_;
  UnsavedWork unsaved_;
  /// The undo step that a held button continues: a drag of a slider is one step.
  std::string gesture_;
  uint64_t newest_tick_ = 0;
  bool other_course_ = false;          ///< the next jump begins another course
  std::vector<BodyId> selected_then_;  ///< at the moment that undo or redo goes to
};

}  // namespace tumble
