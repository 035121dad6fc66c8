#include "viewer/capture/png_writer.hpp"

#include "viewer/capture/atomic_file.hpp"
#include "viewer/capture/png.hpp"

#include <chrono>

namespace tumble {
namespace {

/// Copies the RGB of an image with 3 or 4 channels into `rgb`, whose memory is reused.
void drop_alpha(const Image& from, Image& rgb) {
  rgb.width = from.width;
  rgb.height = from.height;
  rgb.channels = 3;
  const size_t n = size_t(from.width) * size_t(from.height);
  rgb.pixels.resize(3 * n);
  const size_t stride = size_t(from.channels);
  const uint8_t* in = from.pixels.data();
  uint8_t* out = rgb.pixels.data();
  for (size_t i = 0; i < n; ++i, in += stride, out += 3) {
    out[0] = in[0];
    out[1] = in[1];
    out[2] = in[2];
  }
}

}  // namespace

PngWriter::PngWriter(size_t buffers, std::unique_ptr<VideoPipe> video)
    : free_(buffers), video_(std::move(video)) {
  thread_ = std::thread([this] { run(); });
}

PngWriter::~PngWriter() {
  {
    std::lock_guard lock(mutex_);
    quit_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

Image PngWriter::take_buffer() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return !free_.empty(); });
  Image image = std::move(free_.back());
  free_.pop_back();
  return image;
}

void PngWriter::submit(Image image, std::filesystem::path file, uint64_t index) {
  {
    std::lock_guard lock(mutex_);
    queue_.push_back({std::move(image), std::move(file), index});
  }
  changed_.notify_all();
}

Status PngWriter::finish() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return queue_.empty() && !busy_; });
  if (video_ && status_) status_ = video_->finish();
  video_.reset();
  return status_;
}

Status PngWriter::status() const {
  std::lock_guard lock(mutex_);
  return status_;
}

std::vector<WrittenImage> PngWriter::take_written() {
  std::lock_guard lock(mutex_);
  return std::exchange(written_, {});
}

Status PngWriter::write_file_of(const Job& job, const Image& rgb, WrittenImage& done) const {
  if (job.file.empty()) return {};
  auto png = encode_png(rgb);
  if (!png) return png.error();
  done.bytes = png->size();
  return write_file(job.file, *png);
}

Result<WrittenImage> PngWriter::write(const Job& job, Image& rgb) const {
  const auto start = std::chrono::steady_clock::now();
  if (job.image.channels < 3)
    return Error{
        ErrorCode::invalid_argument, "a frame needs three channels", job.file.string(), {}};
  drop_alpha(job.image, rgb);
  WrittenImage done;
  if (video_)
    if (auto added = video_->add(rgb); !added) return added.error();
  if (auto written = write_file_of(job, rgb, done); !written) return written.error();
  done.index = job.index;
  done.hash = image_hash(rgb);
  done.uniform = is_uniform(rgb);
  done.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return done;
}

void PngWriter::run() {
  Image rgb;
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return quit_ || !queue_.empty(); });
    if (queue_.empty()) return;
    Job job = std::move(queue_.front());
    queue_.pop_front();
    busy_ = true;
    if (status_) {
      lock.unlock();
      auto done = write(job, rgb);
      lock.lock();
      if (done)
        written_.push_back(*done);
      else if (status_)
        status_ = done.error();
    }
    busy_ = false;
    free_.push_back(std::move(job.image));
    changed_.notify_all();
  }
}

}  // namespace tumble
