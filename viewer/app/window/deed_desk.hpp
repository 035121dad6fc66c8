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

/// What a person did to the scene that is shown: deeds to the world and beside it, choices of
/// numbers, and what of all that is not saved. Each deed leads history onto another course, of
/// which is known how far it has been seen.
class DeedDesk {
 public:
  /// `folder`: for work that was not saved; empty: none is kept.
  explicit DeedDesk(std::filesystem::path folder) : unsaved_(std::move(folder)) {}

  /// Another world is shown; its file is given to unsaved().
  void forget();
  EditHistory& edits() { return edits_; }
  const EditHistory& edits() const { return edits_; }
  ChoiceHistory& choices() { return choices_; }
  UnsavedWork& unsaved() { return unsaved_; }

  /// Somebody is about to do something. `held`: a button or a key is, and what is asked for again
  /// meanwhile is one deed. `now`: the moment that is shown.
  DeedEdits begin(Session& session, std::string what, bool held, uint64_t now,
                  std::vector<BodyId> selected);
  /// The same beside the world: see EditHistory.
  void begin_beside(std::string what, bool held, std::function<void()> exchange);
  /// Whether that would go on with the newest deed.
  bool goes_on(std::string_view what, bool held) const;
  /// The deed that is going on has come to nothing.
  void drop_newest();
  /// Nothing is held any more: what comes next is a deed of its own.
  void end_gesture() { gesture_.clear(); }
  /// Takes the newest deed back, and does it again. Nothing: there is none.
  std::optional<EditHistory::Back> take_back(Session& session, std::vector<BodyId> selected);
  std::optional<EditHistory::Back> do_again(Session& session, std::vector<BodyId> selected);
  /// Looks at the newest deeds at once: they count as unsaved work from now on.
  void finish(Session& session, bool own_thread);

  /// The world goes to a moment from which history takes another course, if it was `changed` or
  /// anything was done.
  void jump(bool changed) { other_course_ = changed || !edits_.empty(); }
  /// A moment is shown. `jumped`: time did not simply go on.
  void see(uint64_t tick, bool jumped);
  /// The last moment that was seen on this course.
  uint64_t newest_tick() const { return newest_tick_; }
  /// Where nothing of what was selected stands any more, what was selected at the moment that is
  /// there again.
  void select_as_then(const Frame& frame, Selection& selection);

 private:
  std::optional<EditHistory::Back> went(std::optional<EditHistory::Back> back);

  EditHistory edits_;
  ChoiceHistory choices_;
  UnsavedWork unsaved_;
  std::string gesture_;  ///< the deed that a held button goes on with: a pull at a slider is one
  uint64_t newest_tick_ = 0;
  bool other_course_ = false;          ///< another one begins with the next jump
  std::vector<BodyId> selected_then_;  ///< at the moment that undo or redo goes to
};

}  // namespace tumble
