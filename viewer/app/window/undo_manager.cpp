#include "viewer/app/window/undo_manager.hpp"

#include <algorithm>
#include <utility>

namespace tumble {

void UndoManager::forget() {
  edits_.forget();
  newest_tick_ = 0;
  other_course_ = false;
  selected_then_.clear();
}

UndoStepEdits UndoManager::begin(Session& session, std::string what, bool held, uint64_t now,
                                 std::vector<BodyId> selected) {
  if (held && gesture_ == what && !edits_.empty()) return edits_.newest();
  gesture_ = held ? what : std::string();
  // The ticks after this one belong to a course that is left.
  newest_tick_ = now;
  return edits_.begin(session, std::move(what), now, std::move(selected));
}

void UndoManager::begin_beside(std::string what, bool held, std::function<void()> exchange) {
  const bool same = goes_on(what, held);
  gesture_ = held ? what : std::string();
  if (same) return;  // a name that is being typed
  choices_.forget_taken_back();
  edits_.note_beside(std::move(what), std::move(exchange));
}

bool UndoManager::goes_on(std::string_view what, bool held) const {
  return held && gesture_ == what && edits_.last() == what;
}

void UndoManager::drop_newest() {
  edits_.drop_newest();
  gesture_.clear();
}

void UndoManager::leave_newest(Session& session) {
  unsaved_.look_again();
  edits_.leave_newest(session);
  gesture_.clear();
}

std::optional<EditHistory::Back> UndoManager::went(std::optional<EditHistory::Back> back) {
  if (back && !back->beside) {
    other_course_ = true;
    selected_then_ = back->selected;
  }
  return back;
}

std::optional<EditHistory::Back> UndoManager::take_back(Session& session,
                                                        std::vector<BodyId> selected) {
  unsaved_.look_again();
  return went(edits_.undo(session, std::move(selected)));
}

std::optional<EditHistory::Back> UndoManager::do_again(Session& session,
                                                       std::vector<BodyId> selected) {
  unsaved_.look_again();
  return went(edits_.redo(session, std::move(selected)));
}

void UndoManager::finish(Session& session, bool own_thread) {
  unsaved_.finish(session, edits_.file_edits(), own_thread);
}

void UndoManager::see(uint64_t tick, bool jumped) {
  // After an undo, or on another course, the later ticks are not those seen before.
  if (jumped && std::exchange(other_course_, false)) newest_tick_ = 0;
  newest_tick_ = std::max(newest_tick_, tick);
}

void UndoManager::select_as_then(const Frame& frame, Selection& selection) {
  if (selection.empty())
    for (const BodyId id : selected_then_)
      if (find_slot(frame, id)) selection.add(id);
  if (!selection.empty()) selected_then_.clear();
}

}  // namespace tumble
