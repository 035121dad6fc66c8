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

/// Parameters of a recording.
struct Recording {
  std::filesystem::path parent;  ///< a new folder is made in it
  std::string scene, renderer, version;
  int width = 0, height = 0;  ///< of every frame, independent of the window's size [px]
  bool own_thread = true;     ///< the session steps on a thread of its own
  bool video = false;         ///< a video instead of pictures
};

/// Records a sequence of frames from the window. While it lasts, each picture is one frame at 60
/// per second of simulated time, independently of real time: the simulation waits for capture,
/// never the reverse. Frames between ticks are interpolated, as with `tumble render`.
class Recorder {
 public:
  bool active() const { return writer_ != nullptr; }
  uint64_t frames() const { return file_.frames.size(); }
  /// The folder of the pictures, or the video file.
  const std::filesystem::path& folder() const { return folder_; }
  bool video() const { return recording_.video; }
  int width() const { return file_.width; }
  int height() const { return file_.height; }

  /// Sets the microscope's setup. If it needs queries of the world, these are made at the ticks
  /// that frames show, so that the recording does not depend on real time.
  void look_through(const std::optional<MicroscopeSetup>& setup) { microscope_ = setup; }
  /// The world's answer for the microscope at the tick of the next frame; null: no query.
  const std::shared_ptr<const MicroscopeAnswer>& said() const { return to_.said; }
  /// Pauses the session, and makes the folder or starts the video.
  Status start(Session& session, const Recording& recording);
  /// Steps the session to the ticks around the next frame and waits for them, but only briefly, so
  /// that the window keeps responding during slow ticks.
  void advance(Session& session);
  /// Whether the ticks around the next frame have been computed.
  bool ready() const { return active() && to_.frame && to_.frame->tick >= due(); }
  /// Sets the view to the moment of the next frame; only while recording.
  void show(SessionView& view) const;
  /// Passes the renderer's last picture to the encoder. After a failure the recording has ended,
  /// and the session stays paused until stop().
  Status add(Renderer& renderer, const Camera& camera, uint64_t draw_hash);
  /// Waits for the last file, writes frames.json, and puts the session back into its former state
  /// (running or paused).
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
  std::future<Tick> coming_;  ///< the next one, if it has been requested
  uint64_t first_tick_ = 0;
  bool was_paused_ = false;
  std::optional<MicroscopeSetup> microscope_;
};

}  // namespace tumble
