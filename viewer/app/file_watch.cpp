#include "viewer/app/file_watch.hpp"

#include "viewer/capture/atomic_file.hpp"

#include <utility>

namespace tumble {
namespace {

constexpr double seconds_between_looks = 0.25;

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
  if (!file_.empty()) seen_ = stamp();
}

std::optional<std::string> FileWatch::look(double dt) {
  since_look_ += dt;
  if (file_.empty() || since_look_ < seconds_between_looks) return std::nullopt;
  since_look_ = 0;
  const auto now = stamp();
  if (now != seen_) {
    seen_ = now;
    settling_ = true;
    return std::nullopt;
  }
  if (!std::exchange(settling_, false) || !now) return std::nullopt;
  auto text = read_file(file_);
  if (!text || *text == known_) return std::nullopt;
  known_ = *text;
  return *std::move(text);
}

}  // namespace tumble
