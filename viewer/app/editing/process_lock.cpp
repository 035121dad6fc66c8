#include "viewer/app/editing/process_lock.hpp"

#include <cerrno>
#include <utility>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

namespace tumble {
namespace {

/// Whether the name still leads to the opened file: the owner of a lock removes its file on
/// release, and another process may have opened the file before that.
bool still_named(const std::filesystem::path& file, int descriptor) {
  struct stat opened {
  }, named{};
  return fstat(descriptor, &opened) == 0 && stat(file.c_str(), &named) == 0 &&
         opened.st_ino == named.st_ino && opened.st_dev == named.st_dev;
}

}  // namespace

std::optional<ProcessLock> ProcessLock::take(const std::filesystem::path& file) {
  while (true) {
    const int descriptor = open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600);
    if (descriptor < 0) return std::nullopt;
    // If files cannot be locked, as on some network file systems, each process works as if it were
    // alone.
    if (flock(descriptor, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
      close(descriptor);
      return std::nullopt;
    }
    if (still_named(file, descriptor)) return ProcessLock(file, descriptor);
    close(descriptor);
  }
}

ProcessLock::ProcessLock(ProcessLock&& other) noexcept
    : file_(std::move(other.file_)), descriptor_(std::exchange(other.descriptor_, -1)) {}

ProcessLock& ProcessLock::operator=(ProcessLock&& other) noexcept {
  if (this == &other) return *this;
  release();
  file_ = std::move(other.file_);
  descriptor_ = std::exchange(other.descriptor_, -1);
  return *this;
}

void ProcessLock::release() {
  if (descriptor_ < 0) return;
  std::error_code none;
  std::filesystem::remove(file_, none);  // while the lock is still held
  close(std::exchange(descriptor_, -1));
}

}  // namespace tumble
