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
  bool resume = false;           ///< continue where an earlier run of the same kind stopped
  bool force = false;            ///< overwrite existing frames
  ExtractOptions extract;
  double trail_seconds = 0;  ///< length of the trails behind moving bodies (Trails); 0: none [s]
  std::chrono::steady_clock::time_point program_start = std::chrono::steady_clock::now();
  LogSink log;
  std::function<void(uint64_t done)> progress;  ///< called after each frame passed to the encoder
};

/// The inputs of a sequence; all must outlive the run.
struct SequenceScene {
  World& world;  ///< at tick 0
  /// Frame of its first tick, with looks that may be overridden.
  std::shared_ptr<const Frame> start;
  Renderer& renderer;
  RenderScene look;  ///< camera, light and ground; the contents are filled in
  std::function<Camera(const Frame& from, const Frame& to, double s)> camera;
  /// Advances the world towards a later tick and returns its frame; called until the tick is
  /// reached.
  std::function<Result<std::shared_ptr<const Frame>>(World&, uint64_t tick)> advance;
};

/// Why a sequence ended.
enum class SequenceEnd {
  complete,
  stopped,  ///< by a signal
  cannot_write,
  cannot_draw,
  cannot_read,  ///< the data by which the world is to be advanced
  broken_down,  ///< the simulation failed
  diverged,     ///< after resuming, the simulation differs from the interrupted one
};

struct SequenceResult {
  SequenceEnd end = SequenceEnd::complete;
  Error error;  ///< set unless complete or stopped
};

/// The number of frames in the folder that can be kept; an error if existing frames must not be
/// overwritten, or the folder cannot be made. Nothing but the folder is created.
Result<uint64_t> frames_to_keep(const SequenceOptions& options, const FramesFile& plan,
                                std::vector<FrameRecord>& kept);

/// Renders frames `plan.frames.size()` to `plan.frames_wanted` - 1 into the folder, with
/// frames.json beside them: simulation, extraction, drawing and read-back in turn, encoding on a
/// thread of its own. Frame k shows the state at k / fps. A signal stops it between two frames.
/// However it ends, every file is complete, and frames.json lists the existing ones.
SequenceResult run_sequence(SequenceScene& scene, FramesFile& plan, const SequenceOptions& options,
                            const StopSignal& stop);

}  // namespace tumble
