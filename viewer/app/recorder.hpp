#pragma once
#include "viewer/app/session.hpp"
#include "viewer/capture/frames_file.hpp"
#include "viewer/capture/png_writer.hpp"
#include "viewer/render/renderer.hpp"

#include <filesystem>
#include <memory>
#include <string>

namespace tumble {

/// A frame sequence recorded from the window: while it lasts each picture is one frame at 60 a
/// second of simulated time, whatever the wall clock says; capture blocks the simulation, never the
/// reverse.
class Recorder {
 public:
  bool active() const { return writer_ != nullptr; }
  uint64_t frames() const { return file_.frames.size(); }
  const std::filesystem::path& folder() const { return folder_; }

  /// Pauses the session and makes a new folder below `parent`.
  Status start(Session& session, const std::filesystem::path& parent, const std::string& scene,
               const std::string& renderer);
  /// Steps the session to the next frame's tick and waits for it.
  void advance(Session& session, bool own_thread);
  /// Hands the renderer's last picture to the encoder. After a failure the recording is over.
  Status add(Renderer& renderer, const Frame& frame, const Camera& camera, uint64_t draw_hash);
  /// Waits for the last file, writes frames.json, and lets the session go on as before.
  Status stop(Session& session);

 private:
  Status finish();

  std::unique_ptr<PngWriter> writer_;
  std::filesystem::path folder_;
  FramesFile file_;
  uint64_t first_tick_ = 0;
  bool was_paused_ = false;
};

}  // namespace tumble
