#pragma once
#include "engine/world/world_def.hpp"
#include "viewer/app/session/recorder.hpp"
#include "viewer/app/session/session.hpp"

#include <memory>
#include <optional>
#include <string>

namespace tumble {

/// The running world as pictures see it: its session, the moment that is shown, the snapshot that a
/// person keeps (F5) and the sequence that is recorded from it (F9).
class ShownWorld {
 public:
  /// `own_thread` false: advance() steps the world, by dt: same input, same bits.
  explicit ShownWorld(bool own_thread) : own_thread_(own_thread) {}

  /// Shows another world from its first frame on.
  void show(std::unique_ptr<World> world, TickWatchers watchers = {},
            std::shared_ptr<ReplayPlayer> replay = nullptr);
  bool any() const { return session_ != nullptr; }
  Session& session() const { return *session_; }
  Recorder& recorder() { return recorder_; }
  const Recorder& recorder() const { return recorder_; }
  const SessionView& view() const { return view_; }
  const Frame& frame() const { return *view_.to; }

  /// Lets simulated time pass for a picture: dt seconds, or one frame of a recording.
  void advance(double dt);
  /// What the newest view is to the last one.
  enum class News : uint8_t {
    none,  ///< the world that was asked for is not there yet: its first frame stays
    goes_on,
    back,   ///< it was restarted or stepped back
    ahead,  ///< it was put to a later moment, and nobody has seen the way
  };
  News look();
  /// Why the simulation has stopped; each reason once.
  std::optional<std::string> take_fault();

  void keep_snapshot() { snapshot_ = session_->keep(); }
  bool has_snapshot() const { return snapshot_ != nullptr; }
  void restore_snapshot() { session_->restore(snapshot_); }

 private:
  bool own_thread_;
  std::unique_ptr<Session> session_;
  Recorder recorder_;
  SessionView view_;
  uint64_t generation_ = 0;                  ///< of the view; 0: of a new world nothing was seen
  uint64_t number_ = 0;                      ///< which world, as Session::replace() counts
  double behind_ticks_ = 0;                  ///< without an own thread: part of a tick that is due
  std::shared_ptr<Session::Kept> snapshot_;  ///< null: none yet
  std::string said_fault_;
};

}  // namespace tumble
