#pragma once
#include "engine/core/result.hpp"
#include "viewer/capture/frame_clock.hpp"
#include "viewer/render/camera.hpp"

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace tumble {

/// The entry of one picture in frames.json.
struct FrameRecord {
  uint64_t index = 0;
  FrameTime at;
  double time = 0;          ///< [s]
  uint64_t state_hash = 0;  ///< of the last tick that the picture needs
  uint64_t draw_hash = 0;   ///< hash of the draw list
  uint64_t image_hash = 0;
};

/// Wall time of a sequence by stage [s]. The first four run one after the other on one thread;
/// encoding runs on another, and `wait` is the time spent waiting for it.
struct SequenceTimes {
  double simulate = 0, extract = 0, draw = 0, read_back = 0, wait = 0, encode = 0;
  double first_frame = 0;  ///< from the program's start to the first file on disk
  double total = 0;
  uint64_t frames = 0;  ///< pictures rendered by this run
};

/// The content of frames.json.
struct FramesFile {
  std::string version, scene, camera_name, context, renderer, gl_version, run;
  Camera camera;
  Fraction fps{30, 1};
  TickRate rate;
  int width = 0, height = 0;
  uint64_t frames_wanted = 0;
  std::vector<FrameRecord> frames;
  SequenceTimes times;
};

/// "frame_000042.png"
std::string frame_name(uint64_t index);
/// The ffmpeg command that makes a video of the sequence in `folder`.
std::string ffmpeg_line(const std::filesystem::path& folder, Fraction fps);

/// Writes DIR/frames.json, whole or not at all.
Status write_frames_file(const std::filesystem::path& folder, const FramesFile& file);
/// Reads what is needed to resume: run, fps and the frames without their draw hashes.
Result<FramesFile> read_frames_file(const std::filesystem::path& folder);

}  // namespace tumble
