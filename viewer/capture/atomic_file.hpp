#pragma once
#include "engine/core/result.hpp"

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace tumble {

/// Writes a file that appears whole or not at all: it is written under a temporary name beside the
/// final one, then renamed. An earlier file of that name stays until then; a link stays too, and
/// what it leads to is written. Errors (ErrorCode::io) name the path and the cause; no temporary
/// file is left.
Status write_file(const std::filesystem::path& path, std::span<const std::byte> content);
Status write_file(const std::filesystem::path& path, std::string_view content);

/// The same for a file written piece by piece: it appears under its name with commit(); if it is
/// destroyed before, nothing is left. The first failure is kept and returned by commit().
class FileWriter {
 public:
  /// An empty path opens nothing: the content is dropped and commit() succeeds.
  explicit FileWriter(std::filesystem::path path);
  ~FileWriter();
  FileWriter(const FileWriter&) = delete;
  FileWriter& operator=(const FileWriter&) = delete;

  /// False for an empty path: the content would be dropped.
  bool wanted() const { return !path_.empty(); }
  void append(std::string_view text);
  /// The first failure so far; ok if there is none.
  Status status() const { return status_; }
  Status commit();

 private:
  void flush();
  void fail(std::string_view doing, int error);

  std::filesystem::path path_;    ///< as named by the caller, for messages
  std::filesystem::path target_;  ///< behind links
  std::filesystem::path part_;
  std::string buffer_;
  Status status_;
  int fd_ = -1;
  bool in_place_ = false;  ///< devices, pipes and standard output are written without renaming
};

/// The content of a file; fails for folders and for files above `max_bytes`.
Result<std::string> read_file(const std::filesystem::path& path,
                              size_t max_bytes = size_t{1} << 30);

/// Creates a folder with its parents; fails if it cannot be made, or the path is not a folder.
Status make_folder(const std::filesystem::path& path);

/// Deletes the temporary files that a killed run has left in a folder.
void remove_temporary_files(const std::filesystem::path& folder);

}  // namespace tumble
