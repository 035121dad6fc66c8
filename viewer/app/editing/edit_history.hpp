#pragma once
#include "viewer/app/editing/scene_saver.hpp"
#include "viewer/app/session/session.hpp"

#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace tumble {

/// Undo history of the user's changes. A change (undo step) consists of its description and a
/// snapshot of the world just before it: undo restores that snapshot, including its past, and the
/// simulation continues from there. Redo restores the moment at which the change was undone.
class EditHistory {
 public:
  /// Begins a change `what` ("Delete crate"); changes that were undone are dropped. Returns the
  /// list in which to record what it changes about the scene's file.
  UndoStepEdits begin(Session& session, std::string what, uint64_t tick,
                      std::vector<BodyId> selected);
  /// Records a change that does not concern the world. `exchange` swaps the former and the present
  /// state, so that it serves both undo and redo.
  void note_beside(std::string what, std::function<void()> exchange);
  /// Result of going back or forth.
  struct Back {
    std::string what;              ///< description of the change
    std::vector<BodyId> selected;  ///< bodies selected at the restored moment
    bool beside = false;           ///< the world was not changed
  };
  /// Undoes the newest change; empty if there is none. `selected`: the present selection.
  std::optional<Back> undo(Session& session, std::vector<BodyId> selected);
  /// Redoes the change undone last; empty if there is none.
  std::optional<Back> redo(Session& session, std::vector<BodyId> selected);
  /// Goes back to the moment before the newest change, which is forgotten.
  void leave_newest(Session& session);
  /// Drops the newest change, which had no effect.
  void drop_newest() { done_.pop_back(); }
  /// To be called when another world is shown.
  void forget() { *this = EditHistory{}; }

  /// The edits of the scene's file by all changes in effect, in order.
  std::vector<UndoStepEdits> file_edits() const;
  /// Descriptions and edits of all changes of the world in effect, in order.
  std::vector<std::pair<std::string, UndoStepEdits>> undo_steps() const;
  /// Edits of changes that are in effect but too old to be undone.
  const std::vector<UndoStepEdits>& forgotten() const { return forgotten_; }
  /// Edits of the newest change of the world, which must exist.
  UndoStepEdits newest() const;
  /// The ticks at which the changes of the world in effect were made.
  std::vector<uint64_t> ticks() const;
  /// The same for changes since the last restart, on the present course of the run.
  std::vector<uint64_t> ticks_of_this_course() const;
  /// To be called when the world is restarted: earlier changes were not made in this run.
  void begin_course() { course_ = ++courses_; }
  /// Description of the newest change; "": there is nothing to undo.
  std::string last() const { return done_.empty() ? std::string() : done_.back().what; }
  /// Whether no change of the world can be undone.
  bool empty() const;

 private:
  struct UndoStep {
    std::string what;
    uint64_t tick = 0;
    UndoStepEdits edits;
    std::shared_ptr<const Session::Kept> moment;
    std::vector<BodyId> selected;  ///< at that moment
    int course = 0;                ///< the course of the run to which that moment belongs
    /// For a change that does not concern the world, which has neither edits nor a moment.
    std::function<void()> exchange{};
  };
  /// Goes to the moment of the newest change of `from`; the change moves to `to` with the present
  /// moment.
  std::optional<Back> go(Session& session, std::deque<UndoStep>& from, std::deque<UndoStep>& to,
                         std::vector<BodyId> selected);
  void drop_oldest();

  std::vector<UndoStepEdits> forgotten_;  ///< edits of changes too old to be undone
  std::deque<UndoStep> done_;             ///< with the moment before each
  int course_ = 0, courses_ = 0;
  std::deque<UndoStep> undone_;  ///< with the moment at which each was undone; the newest last
};

}  // namespace tumble
