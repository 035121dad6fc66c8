#pragma once
#include "viewer/app/session/replay_saver.hpp"

#include <cstdint>

namespace tumble {

class ReplayPlayer;
struct OpenedScene;

/// The replay being played into the world shown, and the saving of a replay of the user's commands.
class ReplayController {
 public:
  /// To be called when a scene is about to be shown.
  void open(const OpenedScene& scene, int threads);
  /// Whether the replay has executed any command since the last call.
  bool has_done_more(const ReplayPlayer& played);
  ReplaySaver& saver() { return saver_; }

 private:
  ReplaySaver saver_;
  uint64_t undo_steps_ = 0;  ///< number of commands the played replay has executed
};

}  // namespace tumble
