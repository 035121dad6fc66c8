#include "viewer/app/recorder.hpp"

#include "viewer/capture/atomic_file.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace tumble {

Status Recorder::start(Session& session, const std::filesystem::path& parent,
                       const std::string& scene, const std::string& renderer) {
  std::error_code ignored;
  int number = 0;
  do {
    folder_ =
        parent / fmt::format("tumble-{}-sequence-{:03}", scene.empty() ? "scene" : scene, number++);
  } while (std::filesystem::exists(folder_, ignored) && number < 100000);
  if (Status s = make_folder(folder_); !s) return s;
  was_paused_ = session.paused();
  session.set_paused(true);
  file_ = FramesFile{};
  file_.scene = scene;
  file_.renderer = renderer;
  file_.context = "window";
  file_.fps = {60, 1};
  writer_ = std::make_unique<PngWriter>();
  first_tick_ = session.view().to->tick;
  return {};
}

void Recorder::advance(Session& session, bool own_thread) {
  if (file_.frames.empty()) {
    first_tick_ = session.view().to->tick;
    return;
  }
  const SessionView now = session.view();
  const uint64_t due = first_tick_ + frame_time(file_.frames.size(), file_.fps, now.to->rate).tick;
  const int64_t ticks = int64_t(due) - int64_t(now.to->tick);
  if (ticks > 0) session.step(ticks);
  if (own_thread)
    session.call([](World&) { return 0; }).wait();
  else
    (void)session.advance(0);
}

Status Recorder::add(Renderer& renderer, const Frame& frame, const Camera& camera,
                     uint64_t draw_hash) {
  if (Status s = writer_->status(); !s) {
    writer_.reset();
    return s;
  }
  Image image = writer_->take_buffer();
  if (Status s = renderer.read_back(image); !s) {
    writer_.reset();
    return s;
  }
  const uint64_t index = file_.frames.size();
  file_.width = image.width;
  file_.height = image.height;
  file_.camera = camera;
  file_.rate = frame.rate;
  FrameRecord record;
  record.index = index;
  record.at.tick = frame.tick;
  record.time = frame.time;
  record.draw_hash = draw_hash;
  record.image_hash = image_hash(image);
  file_.frames.push_back(record);
  writer_->submit(std::move(image), folder_ / frame_name(index), index);
  return {};
}

Status Recorder::stop(Session& session) {
  session.set_paused(was_paused_);
  return finish();
}

Status Recorder::finish() {
  if (!writer_) return {};
  const Status written = writer_->finish();
  writer_.reset();
  if (!written) return written;
  file_.frames_wanted = file_.frames.size();
  return write_frames_file(folder_, file_);
}

}  // namespace tumble
