#pragma once
#include "engine/world/microscope/microscope.hpp"
#include "viewer/app/session/session.hpp"
#include "viewer/capture/frames_file.hpp"
#include "viewer/capture/png_writer.hpp"
#include "viewer/render/renderer.hpp"

#include <filesystem>
#include <future>
#include <memory>
#include <optional>
#include <string>

namespace tumble {

/// What a recording is told about where it comes from and goes to.
struct Recording {
  std::filesystem::path parent;  ///< gets a new folder
  std::string scene, renderer, version;
  int width = 0, height = 0;  ///< of every frame, whatever becomes of the window [px]
  bool own_thread = true;     ///< the session steps on a thread of its own
  bool video = false;         ///< a video in place of pictures
};

/// A frame sequence recorded from the window: while it lasts each picture is one frame at 60 a
/// second of simulated time, whatever the wall clock says; capture blocks the simulation, never the
/// reverse. Frames between ticks are interpolated, as those of `tumble render`.
class Recorder {
 public:
  bool active() const { return writer_ != nullptr; }
  uint64_t frames() const { return file_.frames.size(); }
  /// Of the pictures; of a video its file.
  const std::filesystem::path& folder() const { return folder_; }
  bool video() const { return recording_.video; }
  int width() const { return file_.width; }
  int height() const { return file_.height; }

  /// What lies under the microscope: where the world is to be asked for that, it is asked at the
  /// ticks that frames show, so that a recording holds the same whatever the wall clock does.
  void look_through(const std::optional<MicroscopeSetup>& setup) { microscope_ = setup; }
  /// What the world said at the tick of the next frame; null: nothing was asked.
  const std::shared_ptr<const MicroscopeAnswer>& said() const { return to_.said; }
  /// Pauses the session, and makes the folder or starts the video.
  Status start(Session& session, const Recording& recording);
  /// Steps the session to the ticks around the next frame and waits for them, but not for long:
  /// a tick may take its time while the window goes on.
  void advance(Session& session);
  /// The ticks around the next frame are there.
  bool ready() const { return active() && to_.frame && to_.frame->tick >= due(); }
  /// While recording: shows the moment of the next frame.
  void show(SessionView& view) const;
  /// Hands the renderer's last picture to the encoder. After a failure the recording is over and
  /// the session waits for stop() to go on.
  Status add(Renderer& renderer, const Camera& camera, uint64_t draw_hash);
  /// Waits for the last file, writes frames.json, and lets the session go on as before.
  Status stop(Session& session);

 private:
  struct Tick {
    std::shared_ptr<const Frame> frame;
    uint64_t hash = 0;  ///< of the state
    std::shared_ptr<const MicroscopeAnswer> said;
  };
  std::future<Tick> ask(Session& session, bool shown) const;
  uint64_t due() const { return first_tick_ + next_time().last_tick(); }
  FrameTime next_time() const { return frame_time(frames(), file_.fps, file_.rate); }
  Status finish();
  Status open_output();

  std::unique_ptr<PngWriter> writer_;
  Recording recording_;
  std::filesystem::path folder_;
  FramesFile file_;
  Tick from_, to_;            ///< the newest two ticks
  std::future<Tick> coming_;  ///< the one after them, when it has been asked for
  uint64_t first_tick_ = 0;
  bool was_paused_ = false;
  std::optional<MicroscopeSetup> microscope_;
};

}  // namespace tumble
