#include "viewer/capture/sequence.hpp"

#include "engine/world/world.hpp"
#include "viewer/capture/atomic_file.hpp"
#include "viewer/capture/png.hpp"
#include "viewer/capture/png_writer.hpp"
#include "viewer/render/trails.hpp"

#include <algorithm>
#include <optional>

#include <fmt/format.h>

namespace tumble {
namespace fs = std::filesystem;
namespace {

using Clock = std::chrono::steady_clock;

double since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Adds the duration of a scope to a sum.
struct Timed {
  explicit Timed(double& sum) : sum_(sum), start_(Clock::now()) {}
  ~Timed() { sum_ += since(start_); }
  double& sum_;
  Clock::time_point start_;
};

/// The first file, by name, that this sequence would overwrite.
std::optional<fs::path> existing_frame(const fs::path& folder) {
  std::error_code code;
  std::optional<fs::path> first;
  for (fs::directory_iterator it(folder, code), end; !code && it != end; it.increment(code)) {
    const std::string name = it->path().filename().string();
    const bool ours =
        (name.starts_with("frame_") && name.ends_with(".png")) || name == "frames.json";
    if (ours && (!first || it->path() < *first)) first = it->path();
  }
  return first;
}

/// Whether the picture on disk is the one listed in frames.json.
bool is_whole(const fs::path& folder, const FrameRecord& frame) {
  const auto picture = read_image(folder / frame_name(frame.index));
  return picture.ok() && image_hash(*picture) == frame.image_hash;
}

/// Removes frames after the end of the sequence, which would otherwise become part of a video made
/// from the folder.
void remove_frames_from(const fs::path& folder, uint64_t first) {
  std::error_code code;
  std::vector<fs::path> stale;
  for (fs::directory_iterator it(folder, code), end; !code && it != end; it.increment(code)) {
    const std::string name = it->path().filename().string();
    if (name.size() == frame_name(0).size() && name.starts_with("frame_") &&
        name.ends_with(".png") && name >= frame_name(first))
      stale.push_back(it->path());
  }
  for (const fs::path& file : stale) fs::remove(file, code);
}

/// The kind of end for an error of advancing the world.
SequenceEnd end_by(const Error& error) {
  switch (error.code) {
    case ErrorCode::cancelled:
      return SequenceEnd::stopped;
    case ErrorCode::io:
    case ErrorCode::parse:
    case ErrorCode::not_found:
      return SequenceEnd::cannot_read;
    default:
      return SequenceEnd::broken_down;
  }
}

/// The state of one run that its stages share.
class Run {
 public:
  Run(SequenceScene& scene, FramesFile& plan, const SequenceOptions& options)
      : scene_(scene), plan_(plan), options_(options), extract_options_(options.extract) {
    from_ = to_ = scene.start;
    trails_.start(options.trail_seconds);
    trails_.see(*to_);
  }

  SequenceResult run(const StopSignal& stop);

 private:
  using Outcome = std::optional<SequenceResult>;  ///< empty: continue

  Outcome verify_kept(const StopSignal& stop);
  Outcome simulate_to(uint64_t tick, const StopSignal& stop);
  Outcome make_frame(uint64_t k, const StopSignal& stop);
  Outcome draw(FrameRecord& record);
  void collect_written();
  Status save_list();

  SequenceScene& scene_;
  FramesFile& plan_;
  const SequenceOptions& options_;
  std::optional<PngWriter> writer_;  ///< exists while run() is active
  ShapeMeshes meshes_;
  ExtractOptions extract_options_;
  Trails trails_;
  std::shared_ptr<const Frame> from_, to_;  ///< the two newest ticks
  std::vector<FrameRecord> submitted_;      ///< drawn, but maybe not written yet
  Clock::time_point list_saved_ = Clock::now();
  bool uniform_reported_ = false;
};

Run::Outcome Run::simulate_to(uint64_t tick, const StopSignal& stop) {
  const Timed timed(plan_.times.simulate);
  while (scene_.world.tick() < tick) {
    if (stop.requested()) return SequenceResult{SequenceEnd::stopped, {}};
    auto next = scene_.advance(scene_.world, tick);
    if (!next) return SequenceResult{end_by(next.error()), next.error()};
    from_ = std::exchange(to_, *std::move(next));
    trails_.see(*to_);
  }
  return {};
}

Run::Outcome Run::verify_kept(const StopSignal& stop) {
  if (plan_.frames.empty()) return {};
  FrameRecord& last = plan_.frames.back();
  if (auto end = simulate_to(frame_time(last.index, plan_.fps, plan_.rate).last_tick(), stop))
    return end;
  if (scene_.world.state_hash() == last.state_hash) return {};
  return SequenceResult{
      SequenceEnd::diverged,
      {ErrorCode::internal,
       fmt::format("the state at frame {} is not the one of the interrupted run", last.index),
       (options_.folder / "frames.json").string(),
       "the scene, its assets or the program changed: use --force"}};
}

Run::Outcome Run::draw(FrameRecord& record) {
  const auto cannot = [](const Error& e) { return SequenceResult{SequenceEnd::cannot_draw, e}; };
  {
    const Timed timed(plan_.times.extract);
    const double s = record.at.exact() ? 1 : record.at.s();
    scene_.look.camera = scene_.camera(*from_, *to_, s);
    const auto& said = extract_options_.microscope_said;
    if (options_.extract.microscope && (!said || said->tick != to_->tick))
      extract_options_.microscope_said = ask_world(scene_.world, *options_.extract.microscope);
    extract(*from_, *to_, s, extract_options_, meshes_, scene_.look);
    trails_.draw(*from_, *to_, s, scene_.look);
  }
  {
    const Timed timed(plan_.times.draw);
    const auto report = scene_.renderer.render(scene_.look, plan_.width, plan_.height);
    if (!report) return cannot(report.error());
    record.draw_hash = report->draws.hash;
  }
  Image image;
  {
    const Timed timed(plan_.times.wait);
    image = writer_->take_buffer();
  }
  {
    const Timed timed(plan_.times.read_back);
    if (auto status = scene_.renderer.read_back(image); !status) return cannot(status.error());
  }
  const bool kept = !options_.folder.empty();
  writer_->submit(std::move(image), kept ? options_.folder / frame_name(record.index) : fs::path(),
                  record.index);
  return {};
}

Run::Outcome Run::make_frame(uint64_t k, const StopSignal& stop) {
  FrameRecord record;
  record.index = k;
  record.at = frame_time(k, plan_.fps, plan_.rate);
  record.time = frame_seconds(k, plan_.fps);
  if (auto end = simulate_to(record.at.last_tick(), stop)) return end;
  {
    const Timed timed(plan_.times.simulate);
    record.state_hash = scene_.world.state_hash();
  }
  if (auto end = draw(record)) return end;
  submitted_.push_back(record);
  ++plan_.times.frames;
  return {};
}

void Run::collect_written() {
  for (const WrittenImage& w : writer_->take_written()) {
    FrameRecord record = submitted_[w.index - submitted_.front().index];
    record.image_hash = w.hash;
    plan_.frames.push_back(record);
    plan_.times.encode += w.seconds;
    if (plan_.times.first_frame == 0) plan_.times.first_frame = since(options_.program_start);
    if (w.uniform && !uniform_reported_ && options_.log) {
      uniform_reported_ = true;
      options_.log(LogLevel::warning,
                   frame_name(w.index) +
                       " has one colour only: look at the camera, or try another --context "
                       "(`tumble doctor` tells which work)");
    }
  }
}

Status Run::save_list() {
  list_saved_ = Clock::now();
  if (options_.folder.empty()) return {};
  return write_frames_file(options_.folder, plan_);
}

SequenceResult Run::run(const StopSignal& stop) {
  scene_.world.stop_with(&stop.flag());
  const auto start = Clock::now();
  SequenceResult result;
  if (auto end = verify_kept(stop)) return *end;
  plan_.times = {};
  std::unique_ptr<VideoPipe> video;
  if (!options_.video.empty()) {
    auto started = VideoPipe::start(options_.video, plan_.width, plan_.height, plan_.fps);
    if (!started) return {SequenceEnd::cannot_write, started.error()};
    video = *std::move(started);
  }
  writer_.emplace(3, std::move(video));
  if (!options_.folder.empty()) {
    remove_temporary_files(options_.folder);
    remove_frames_from(options_.folder, plan_.frames.size());
  }
  // Written first, so that an unwritable folder is detected before rendering.
  if (auto listed = save_list(); !listed) return {SequenceEnd::cannot_write, listed.error()};
  for (uint64_t k = plan_.frames.size(); k < plan_.frames_wanted; ++k) {
    if (stop.requested()) {
      result.end = SequenceEnd::stopped;
      break;
    }
    if (auto end = make_frame(k, stop)) {
      result = *end;
      break;
    }
    collect_written();
    if (!writer_->status()) break;
    if (options_.progress) options_.progress(k + 1);
    // Saved regularly, so that even a run that is killed can be resumed.
    if (since(list_saved_) > 2 && !save_list()) break;
  }
  Status written = writer_->finish();
  collect_written();
  plan_.times.total = since(start);
  const Status listed = save_list();
  if (written) written = listed;
  if (!written) return {SequenceEnd::cannot_write, written.error()};
  return result;
}

}  // namespace

Result<uint64_t> frames_to_keep(const SequenceOptions& options, const FramesFile& plan,
                                std::vector<FrameRecord>& kept) {
  kept.clear();
  if (options.folder.empty()) return 0;
  if (auto made = make_folder(options.folder); !made) return made.error();
  const auto existing = existing_frame(options.folder);
  if (existing && !options.resume && !options.force)
    return Error{ErrorCode::io, "there are frames already", existing->string(),
                 "--resume goes on with them, --force overwrites them"};
  if (existing && options.resume && !options.force) {
    const auto earlier = read_frames_file(options.folder);
    if (!earlier)
      return Error{ErrorCode::io, "cannot go on: " + earlier.error().message, earlier.error().place,
                   "choose another folder, or --force, which overwrites the frames there"};
    if (earlier->run != plan.run)
      return Error{ErrorCode::io, "these are frames of another run (scene, settings, size or rate)",
                   existing->string(), "choose another folder, or --force"};
    kept = earlier->frames;
    for (FrameRecord& frame : kept) frame.at = frame_time(frame.index, plan.fps, plan.rate);
    // A frame that is truncated, replaced or missing is drawn again, and so are all frames after
    // it.
    const auto broken = std::find_if(kept.begin(), kept.end(), [&](const FrameRecord& frame) {
      return !is_whole(options.folder, frame);
    });
    kept.erase(broken, kept.end());
  }
  return kept.size();
}

SequenceResult run_sequence(SequenceScene& scene, FramesFile& plan, const SequenceOptions& options,
                            const StopSignal& stop) {
  return Run(scene, plan, options).run(stop);
}

}  // namespace tumble
