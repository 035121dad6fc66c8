#pragma once
#include <filesystem>
#include <optional>

namespace tumble {

/// A lock on a name between processes (flock(2)): released by destruction, and by the system when
/// the process ends in any way. Its file is empty and is removed on release.
class ProcessLock {
 public:
  /// Empty if another process has it, or if the file cannot be made.
  static std::optional<ProcessLock> take(const std::filesystem::path& file);
  ProcessLock(ProcessLock&& other) noexcept;
  ProcessLock& operator=(ProcessLock&& other) noexcept;
  ~ProcessLock() { release(); }

 private:
  ProcessLock(std::filesystem::path file, int descriptor)
      : file_(std::move(file)), descriptor_(descriptor) {}
  void release();

  std::filesystem::path file_;
  int descriptor_ = -1;
};

}  // namespace tumble
