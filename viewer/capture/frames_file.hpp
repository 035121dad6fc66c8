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

/// One picture of a sequence as frames.json tells of it.
struct FrameRecord {
  uint64_t index = 0;
  FrameTime at;
  double time = 0;          ///< [s]
  uint64_t state_hash = 0;  ///< of the last tick that the picture needs
  uint64_t draw_hash = 0;   ///< draw-list hash
  uint64_t image_hash = 0;
};

/// Wall time of a sequence per stage, in seconds. The first four follow each other on one thread;
/// encoding runs beside them, and only `wait` of it holds them up.
struct SequenceTimes {
  double simulate = 0, extract = 0, draw = 0, read_back = 0, wait = 0, encode = 0;
  double first_frame = 0;  ///< from the program's start to the first file on disk
  double total = 0;
  uint64_t frames = 0;  ///< rendered by this run
};

/// Everything that frames.json says.
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
/// The command that makes a video of the sequence in `folder`.
std::string ffmpeg_line(const std::filesystem::path& folder, Fraction fps);

/// Writes DIR/frames.json, whole or not at all.
Status write_frames_file(const std::filesystem::path& folder, const FramesFile& file);
/// Reads back what resuming needs: run, fps and the frames without their draw hashes.
Result<FramesFile> read_frames_file(const std::filesystem::path& folder);

}  // namespace tumble
