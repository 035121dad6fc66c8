#pragma once
#include "viewer/app/session/replay_saver.hpp"

#include <cstdint>

namespace tumble {

class ReplayPlayer;
struct OpenedScene;

/// The replay that is played into the world that is shown, as far as the window has seen it, and
/// the one of what is done there.
class ReplayDesk {
 public:
  /// A scene is about to be shown.
  void open(const OpenedScene& scene, int threads);
  /// Whether the replay has done anything since this was asked last.
  bool has_done_more(const ReplayPlayer& played);
  ReplaySaver& saver() { return saver_; }

 private:
  ReplaySaver saver_;
  uint64_t deeds_ = 0;  ///< of what is played
};

}  // namespace tumble
