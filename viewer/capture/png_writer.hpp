#pragma once
#include "engine/core/result.hpp"
#include "viewer/capture/video_pipe.hpp"
#include "viewer/render/image.hpp"

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

namespace tumble {

/// The outcome of one submitted picture.
struct WrittenImage {
  uint64_t index = 0;
  uint64_t hash = 0;     ///< image_hash() of the picture
  size_t bytes = 0;      ///< size of the file
  double seconds = 0;    ///< encoding and writing [s]
  bool uniform = false;  ///< a single colour, as broken drivers draw
};

/// Encodes and writes pictures on a thread of its own, with a bounded queue: take_buffer() waits
/// while all buffers are in use. Files appear whole or not at all. After the first failure the
/// other pictures are dropped, and status() gives the reason. If there is a video, each picture is
/// also added to it.
class PngWriter {
 public:
  explicit PngWriter(size_t buffers = 3, std::unique_ptr<VideoPipe> video = nullptr);
  ~PngWriter();
  PngWriter(const PngWriter&) = delete;
  PngWriter& operator=(const PngWriter&) = delete;

  /// An image whose memory is reused; waits until one is free.
  Image take_buffer();
  /// Queues a taken image; its alpha is dropped. With an empty file name it is only added to the
  /// video.
  void submit(Image image, std::filesystem::path file, uint64_t index);
  /// Waits until everything submitted has been written or has failed; completes the video.
  Status finish();
  Status status() const;
  /// What was written since the last call, in order.
  std::vector<WrittenImage> take_written();

 private:
  struct Job {
    Image image;
    std::filesystem::path file;
    uint64_t index;
  };
  void run();
  Result<WrittenImage> write(const Job& job, Image& rgb) const;
  Status write_file_of(const Job& job, const Image& rgb, WrittenImage& done) const;

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<Image> free_;
  std::deque<Job> queue_;
  std::vector<WrittenImage> written_;
  Status status_;
  bool busy_ = false;
  bool quit_ = false;
  std::unique_ptr<VideoPipe> video_;  ///< null: none
  std::thread thread_;
};

}  // namespace tumble
