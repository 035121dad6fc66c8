#include "viewer/app/window/file_watch.hpp"

#include "viewer/capture/atomic_file.hpp"

#include <chrono>
#include <utility>

namespace tumble {
namespace {

constexpr double seconds_between_looks = 0.25;

/// A file missing in this many consecutive polls has been removed, not just rewritten.
constexpr int looks_before_gone = 4;

/// File systems stamp files by a clock with a resolution of some milliseconds (up to two seconds on
/// FAT): a file written very recently may be written again without a change of its stamp. Such a
/// stamp proves nothing (git calls such a file "racily clean"), and the file is read.
constexpr std::chrono::seconds coarsest_clock{2};

}  // namespace

std::optional<FileWatch::Stamp> FileWatch::stamp() const {
  std::error_code none;
  const auto time = std::filesystem::last_write_time(file_, none);
  if (none) return std::nullopt;
  const auto size = std::filesystem::file_size(file_, none);
  if (none) return std::nullopt;
  return Stamp{time, size};
}

void FileWatch::open(std::filesystem::path file, std::string known) {
  *this = FileWatch{};
  file_ = std::move(file);
  known_ = std::move(known);
  if (file_.empty()) return;
  seen_ = stamp();
  to_read_ = true;
}

std::optional<std::string> FileWatch::look(double dt) {
  since_look_ += dt;
  if (file_.empty() || since_look_ < seconds_between_looks) return std::nullopt;
  since_look_ = 0;
  const auto now = stamp();
  missed_ = now ? 0 : missed_ + 1;
  if (missed_ == looks_before_gone) gone_ = true;
  if (now != seen_) {
    seen_ = now;
    to_read_ = true;
    return std::nullopt;
  }
  if (!now) return std::nullopt;
  const auto age = std::chrono::file_clock::now() - now->time;
  if (!std::exchange(to_read_, age < coarsest_clock)) return std::nullopt;
  auto text = read_file(file_);
  if (!text || *text == known_) return std::nullopt;
  known_ = *text;
  return *std::move(text);
}

}  // namespace tumble
