#pragma once
#include "engine/core/result.hpp"

#include <filesystem>

namespace tumble {

/// Holds a folder for one run of the program, so that two do not replace each other's files. The
/// lock is the system's own (flock(2) of the folder itself): it leaves no file behind and ends with
/// the process, even one that is killed.
class FolderLock {
 public:
  /// Fails with ErrorCode::io when another run holds the folder, or when it cannot be opened. Where
  /// the file system knows no locks there is none.
  static Result<FolderLock> take(const std::filesystem::path& folder);

  FolderLock(FolderLock&& other) noexcept;
  FolderLock& operator=(FolderLock&& other) noexcept;
  ~FolderLock();

 private:
  explicit FolderLock(int fd) : fd_(fd) {}
  int fd_ = -1;
};

}  // namespace tumble
