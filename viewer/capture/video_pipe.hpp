#pragma once
#include "engine/core/result.hpp"
#include "viewer/capture/frame_clock.hpp"
#include "viewer/render/image.hpp"

#include <filesystem>
#include <memory>
#include <string>

namespace tumble {

/// The path of a program in PATH; empty: it is not installed.
std::filesystem::path find_program(const std::string& name);

/// Passes pictures to the program ffmpeg, which makes a video of them. The file appears with
/// finish(), whole or not at all; otherwise nothing is left.
class VideoPipe {
 public:
  /// Starts ffmpeg. The format follows from the file's ending: .mp4, .mkv, .webm, .mov, .gif, ...
  /// Errors: ffmpeg is not installed (`unsupported`), the file cannot be written.
  static Result<std::unique_ptr<VideoPipe>> start(const std::filesystem::path& file, int width,
                                                  int height, Fraction fps);
  ~VideoPipe();
  VideoPipe(const VideoPipe&) = delete;
  VideoPipe& operator=(const VideoPipe&) = delete;

  /// Adds a picture with three channels and the given size. Waits while ffmpeg is busy.
  Status add(const Image& rgb);
  /// Waits until ffmpeg has ended; the file then has its name.
  Status finish();
  const std::filesystem::path& file() const { return file_; }

 private:
  VideoPipe() = default;
  Error failure(std::string what) const;
  int wait();

  std::filesystem::path file_, part_;
  int width_ = 0, height_ = 0;
  int socket_ = -1, complaints_ = -1;  ///< to ffmpeg's input; from its stderr
  int process_ = -1;
};

}  // namespace tumble
