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

/// What a person did to the world, in order, to be taken back and done again. A deed is a name and
/// the moment of the world just before it: taking it back goes to that moment, with the past that
/// it had, and time goes on from there. Doing it again goes to the moment at which it was taken
/// back.
class EditHistory {
 public:
  /// Somebody is about to do `what` ("Delete crate"). What has been taken back is forgotten. Gives
  /// where to note what the deed changes about the scene's file.
  DeedEdits begin(Session& session, std::string what, uint64_t tick, std::vector<BodyId> selected);
  /// Somebody did something beside the world. `exchange` puts what was before in the place of what
  /// is now, and what is now in its own: taking back and doing again are the same.
  void note_beside(std::string what, std::function<void()> exchange);
  /// A moment that was left behind and is there again.
  struct Back {
    std::string what;              ///< the deed
    std::vector<BodyId> selected;  ///< the bodies that were selected then
    bool beside = false;           ///< the world is as it was
  };
  /// Goes back to before the newest deed that holds; nothing when there is none. `selected`: now.
  std::optional<Back> undo(Session& session, std::vector<BodyId> selected);
  /// Goes to where the deed that was taken back last still held.
  std::optional<Back> redo(Session& session, std::vector<BodyId> selected);
  /// The newest deed has come to nothing: all is as it was before it.
  void drop_newest() { done_.pop_back(); }
  /// Another world is shown.
  void forget() { *this = EditHistory{}; }

  /// Of the deeds that hold, in order.
  std::vector<DeedEdits> file_edits() const;
  /// What the deeds to the world that hold are, and their edits, in order.
  std::vector<std::pair<std::string, DeedEdits>> deeds() const;
  /// Of deeds that are too old to be taken back.
  const std::vector<DeedEdits>& forgotten() const { return forgotten_; }
  /// Of the newest deed to the world, which must be there.
  DeedEdits newest() const;
  /// At which ticks the deeds to the world that hold were done.
  std::vector<uint64_t> ticks() const;
  /// The same of those since the world was restarted last, on the course of history that is shown.
  std::vector<uint64_t> ticks_of_this_course() const;
  /// The world is restarted: what was done in the run that was left is not done in this one.
  void begin_course() { course_ = ++courses_; }
  /// What was done last; "": nothing that can be taken back.
  std::string last() const { return done_.empty() ? std::string() : done_.back().what; }
  /// No deed to the world can be taken back.
  bool empty() const;

 private:
  struct Deed {
    std::string what;
    uint64_t tick = 0;
    DeedEdits edits;
    std::shared_ptr<const Session::Kept> moment;
    std::vector<BodyId> selected;  ///< at that moment
    int course = 0;                ///< of history, that moment is on
    /// Of a deed beside the world, which has neither edits nor a moment.
    std::function<void()> exchange{};
  };
  /// Back to the moment of the newest deed of `from`; with the moment of now it goes to `to`.
  std::optional<Back> go(Session& session, std::deque<Deed>& from, std::deque<Deed>& to,
                         std::vector<BodyId> selected);
  void drop_oldest();

  std::vector<DeedEdits> forgotten_;  ///< of deeds too old to be taken back
  std::deque<Deed> done_;             ///< with the moment before each
  int course_ = 0, courses_ = 0;
  std::deque<Deed> undone_;  ///< with the moment at which each was taken back; the newest last
};

}  // namespace tumble
