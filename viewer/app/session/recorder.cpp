#include "viewer/app/session/recorder.hpp"

#include "engine/world/world.hpp"
#include "viewer/capture/atomic_file.hpp"
#include "viewer/capture/free_name.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace tumble {

/// Makes a folder, or a video file, with an unused name.
Status Recorder::open_output() {
  constexpr Fraction fps{60, 1};
  const std::string scene = recording_.scene.empty() ? "scene" : recording_.scene;
  folder_ = free_name(recording_.parent,
                      fmt::format("tumble-{}-{}", scene, recording_.video ? "video" : "sequence"),
                      recording_.video ? ".mp4" : "");
  if (!recording_.video) {
    if (Status s = make_folder(folder_); !s) return s;
    writer_ = std::make_unique<PngWriter>();
    return {};
  }
  auto video = VideoPipe::start(folder_, recording_.width, recording_.height, fps);
  if (!video) return video.error();
  writer_ = std::make_unique<PngWriter>(3, *std::move(video));
  return {};
}

Status Recorder::start(Session& session, const Recording& recording) {
  recording_ = recording;
  if (Status s = open_output(); !s) return s;
  was_paused_ = session.paused();
  session.set_paused(true);
  coming_ = ask(session, true);
  from_ = to_ = {};
  file_ = FramesFile{};
  file_.version = recording.version;
  file_.scene = recording.scene;
  file_.renderer = recording.renderer;
  file_.context = "window";
  file_.width = recording.width;
  file_.height = recording.height;
  file_.fps = {60, 1};
  return {};
}

/// Requests frame and hash of the same moment, after all jobs posted before; if the tick is
/// `shown`, also the microscope's answer.
std::future<Recorder::Tick> Recorder::ask(Session& session, bool shown) const {
  auto promise = std::make_shared<std::promise<Tick>>();
  auto answer = promise->get_future();
  const auto setup = shown ? microscope_ : std::nullopt;
  session.ask(setup ? setup->algorithm : "", [promise, setup](const World& world) {
    Tick tick;
    {
      const Stoppable whole(nullptr);  // only the microscope's query may be cancelled
      tick.frame = world.frame();
      tick.hash = world.state_hash();
    }
    if (setup) tick.said = ask_world(world, *setup);
    promise->set_value(std::move(tick));
  });
  if (!recording_.own_thread) (void)session.advance(0);
  return answer;
}

void Recorder::advance(Session& session) {
  constexpr std::chrono::milliseconds patience(50);
  while (!to_.frame || to_.frame->tick < due()) {
    if (!coming_.valid()) {
      session.step(1);
      coming_ = ask(session, to_.frame->tick + 1 >= due());
    }
    if (coming_.wait_for(patience) != std::future_status::ready) return;
    Tick next = coming_.get();
    if (!to_.frame) {
      first_tick_ = next.frame->tick;
      file_.rate = next.frame->rate;
      from_ = to_ = std::move(next);
      continue;
    }
    // The tick failed or was cancelled; the session reports why.
    if (next.frame->tick <= to_.frame->tick) return;
    from_ = std::exchange(to_, std::move(next));
  }
}

void Recorder::show(SessionView& view) const {
  if (!active() || !to_.frame) return;
  const FrameTime at = next_time();
  view.from = at.exact() ? to_.frame : from_.frame;
  view.to = to_.frame;
  view.s = at.exact() ? 1 : at.s();
}

Status Recorder::add(Renderer& renderer, const Camera& camera, uint64_t draw_hash) {
  const auto over = [this](Error error) -> Status {
    (void)finish();
    return error;
  };
  if (Status s = writer_->status(); !s) return over(s.error());
  Image image = writer_->take_buffer();
  if (Status s = renderer.read_back(image); !s) return over(s.error());
  file_.camera = camera;
  FrameRecord record;
  record.index = frames();
  record.at = next_time();
  record.time = to_.frame->time;
  if (!record.at.exact())
    record.time = from_.frame->time + record.at.s() * (to_.frame->time - from_.frame->time);
  record.at.tick += first_tick_;
  record.state_hash = to_.hash;
  record.draw_hash = draw_hash;
  file_.frames.push_back(record);
  writer_->submit(std::move(image),
                  video() ? std::filesystem::path() : folder_ / frame_name(record.index),
                  record.index);
  return {};
}

Status Recorder::stop(Session& session) {
  session.set_paused(was_paused_);
  return finish();
}

/// Writes frames.json, which lists what is on disk, also after a failure.
Status Recorder::finish() {
  if (!writer_) return {};
  const Status written = writer_->finish();
  file_.frames_wanted = frames();
  size_t whole = 0;
  for (const WrittenImage& image : writer_->take_written())
    if (image.index == whole) file_.frames[whole++].image_hash = image.hash;
  file_.frames.resize(whole);
  writer_.reset();
  coming_ = {};
  if (video()) return written;
  const Status listed = write_frames_file(folder_, file_);
  return written ? listed : written;
}

}  // namespace tumble
