#pragma once
#include "engine/core/result.hpp"

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace tumble {

/// Writes a file that appears whole or not at all: to a temporary name beside it, then renamed. An
/// earlier file of that name stays until then. Errors (ErrorCode::io) name the path and the cause,
/// and leave nothing behind.
Status write_file(const std::filesystem::path& path, std::span<const std::byte> content);
Status write_file(const std::filesystem::path& path, std::string_view content);

/// The same for a file that grows piece by piece: it appears under its name with commit(), and
/// leaves nothing behind when destroyed before. The first failure is kept and given by commit().
class FileWriter {
 public:
  /// Nothing is opened for an empty path; then everything is dropped and commit() succeeds.
  explicit FileWriter(std::filesystem::path path);
  ~FileWriter();
  FileWriter(const FileWriter&) = delete;
  FileWriter& operator=(const FileWriter&) = delete;

  /// False for an empty path: nobody will read it.
  bool wanted() const { return !path_.empty(); }
  void append(std::string_view text);
  /// Why it cannot be written so far; ok when all is well.
  Status status() const { return status_; }
  Status commit();

 private:
  void flush();
  void fail(std::string_view doing, int error);

  std::filesystem::path path_, part_;
  std::string buffer_;
  Status status_;
  int fd_ = -1;
  bool in_place_ = false;  ///< devices and pipes are written as they are
};

/// The whole of a file; fails for folders and for files above `max_bytes`.
Result<std::string> read_file(const std::filesystem::path& path,
                              size_t max_bytes = size_t{1} << 30);

/// Creates a folder with its parents; fails when it cannot be made or is something else.
Status make_folder(const std::filesystem::path& path);

/// Deletes what a killed run left half written in a folder.
void remove_temporary_files(const std::filesystem::path& folder);

}  // namespace tumble
