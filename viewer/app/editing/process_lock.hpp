#pragma once
#include <filesystem>
#include <optional>

namespace tumble {

/// A lock on a name that other running processes see: given back with its destruction, and by the
/// system when the process ends in whatever way (flock(2)). Its file is empty and goes with it.
class ProcessLock {
 public:
  /// Nothing while somebody else has it, or where there can be no such file.
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
