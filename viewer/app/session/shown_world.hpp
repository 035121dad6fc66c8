#pragma once
#include "engine/world/world_def.hpp"
#include "viewer/app/session/recorder.hpp"
#include "viewer/app/session/session.hpp"

#include <memory>
#include <optional>
#include <string>

namespace tumble {

/// The running world as it is drawn: its session, the moment shown, the user's snapshot (F5) and
/// the sequence being recorded (F9).
class ShownWorld {
 public:
  /// With `own_thread` false, advance() steps the world by dt, so that equal input gives equal
  /// bits.
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

  /// Advances simulated time for a picture: by dt seconds, or by one frame of a recording.
  void advance(double dt);
  /// How the newest view relates to the one before.
  enum class News : uint8_t {
    none,  ///< the requested world has not been computed yet: the frame stays
    goes_on,
    back,   ///< it was restarted or stepped back
    ahead,  ///< it was set to a later moment, without the frames between
  };
  News look();
  /// Why the simulation has stopped; each reason is returned once.
  std::optional<std::string> take_fault();

  void keep_snapshot() { snapshot_ = session_->keep(); }
  bool has_snapshot() const { return snapshot_ != nullptr; }
  void restore_snapshot() { session_->restore(snapshot_); }

 private:
  bool own_thread_;
  std::unique_ptr<Session> session_;
  Recorder recorder_;
  SessionView view_;
  uint64_t generation_ = 0;  ///< generation of the view; 0: nothing of a new world was seen yet
  uint64_t number_ = 0;      ///< number of the world from Session::replace()
  double behind_ticks_ = 0;  ///< without an own thread: the fraction of a tick that is due
  std::shared_ptr<Session::Kept> snapshot_;  ///< null: none yet
  std::string said_fault_;
};

}  // namespace tumble
