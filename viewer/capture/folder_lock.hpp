#pragma once
#include "engine/core/result.hpp"

#include <filesystem>

namespace tumble {

/// Locks a folder for one run of the program, so that two runs do not replace each other's files.
/// It is a lock of the system (flock(2) on the folder itself): it leaves no file behind and ends
/// with the process, even if that is killed.
class FolderLock {
 public:
  /// Fails with ErrorCode::io if another run has locked the folder, or if it cannot be opened. On
  /// file systems without locks it succeeds without locking.
  static Result<FolderLock> take(const std::filesystem::path& folder);

  FolderLock(FolderLock&& other) noexcept;
  FolderLock& operator=(FolderLock&& other) noexcept;
  ~FolderLock();

 private:
  explicit FolderLock(int fd) : fd_(fd) {}
  int fd_ = -1;
};

}  // namespace tumble
