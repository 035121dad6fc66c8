#pragma once
#include "engine/core/log.hpp"
#include "engine/world/frame.hpp"
#include "viewer/capture/frames_file.hpp"
#include "viewer/capture/stop_signal.hpp"
#include "viewer/render/extract.hpp"
#include "viewer/render/renderer.hpp"

#include <chrono>
#include <functional>

namespace tumble {

class World;

struct SequenceOptions {
  std::filesystem::path folder;  ///< of the pictures; empty: only a video
  std::filesystem::path video;   ///< of all pictures; empty: none
  bool resume = false;           ///< go on where an earlier run of the same kind stopped
  bool force = false;            ///< overwrite frames that exist
  ExtractOptions extract;
  double trail_seconds = 0;  ///< length of the paths behind moving bodies (Trails); 0: none [s]
  std::chrono::steady_clock::time_point program_start = std::chrono::steady_clock::now();
  LogSink log;
  std::function<void(uint64_t done)> progress;  ///< after each frame handed to the encoder
};

/// What a sequence is made with; all outlive the run.
struct SequenceScene {
  World& world;                        ///< at tick 0
  std::shared_ptr<const Frame> start;  ///< what is to be seen of it then
  Renderer& renderer;
  RenderScene look;  ///< camera, light and ground; content is filled in
  std::function<Camera(const Frame& from, const Frame& to, double s)> camera;
  /// Brings the world nearer to a later tick and gives its frame; called until it is there.
  std::function<Result<std::shared_ptr<const Frame>>(World&, uint64_t tick)> advance;
};

/// Why a sequence ended.
enum class SequenceEnd {
  complete,
  stopped,  ///< by a signal
  cannot_write,
  cannot_draw,
  cannot_read,  ///< what the world was to be brought on by
  broken_down,  ///< the simulation failed
  diverged,     ///< resumed, but the simulation is not the one that was interrupted
};

struct SequenceResult {
  SequenceEnd end = SequenceEnd::complete;
  Error error;  ///< unless complete or stopped
};

/// How many frames of the folder can be kept; an error when frames exist that may not be touched,
/// or when the folder cannot be made. Changes nothing but that.
Result<uint64_t> frames_to_keep(const SequenceOptions& options, const FramesFile& plan,
                                std::vector<FrameRecord>& kept);

/// Renders frames `plan.frames.size()` to `plan.frames_wanted` - 1 into the folder, with
/// frames.json beside them: simulation, extraction, drawing and read-back in turn, encoding on a
/// thread of its own. Frame k is at k / fps. Stops between two frames on a signal. Whatever the
/// end, every file is whole, and frames.json tells what is there.
SequenceResult run_sequence(SequenceScene& scene, FramesFile& plan, const SequenceOptions& options,
                            const StopSignal& stop);

}  // namespace tumble
