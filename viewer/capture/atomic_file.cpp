#include "viewer/capture/atomic_file.hpp"

#include "engine/core/part_file.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <system_error>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

namespace tumble {
namespace fs = std::filesystem;
namespace {

std::string cure_of(int error) {
  switch (error) {
    case ENOSPC:
    case EDQUOT:
      return "free some space, or write elsewhere";
    case EACCES:
    case EPERM:
    case EROFS:
      return "choose a folder that you may write to";
    case EFBIG:
      return "raise the file size limit (ulimit -f)";
    case ENOENT:
      return "create the folder first";
    default:
      return {};
  }
}

Error io_error(const fs::path& path, std::string_view doing, int error) {
  return {ErrorCode::io, fmt::format("cannot {}: {}", doing, std::strerror(error)), path.string(),
          doing == "open" || doing == "read" ? std::string() : cure_of(error)};
}

/// Whether standard output goes to this file, as /dev/stdout or under its own name.
bool is_stdout(const fs::path& path) {
  struct stat named {
  }, ours{};
  return ::stat(path.c_str(), &named) == 0 && ::fstat(STDOUT_FILENO, &ours) == 0 &&
         named.st_dev == ours.st_dev && named.st_ino == ours.st_ino;
}

/// Writes all bytes; returns 0 or errno.
int write_all(int fd, std::span<const std::byte> content) {
  while (!content.empty()) {
    const ssize_t n = ::write(fd, content.data(), content.size());
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return errno;
    content = content.subspan(size_t(n));
  }
  return 0;
}

}  // namespace

FileWriter::FileWriter(fs::path path) : path_(std::move(path)) {
  if (path_.empty()) return;
  // Devices and pipes must be written in place: a rename would replace them. So must the file that
  // standard output goes to: what is printed there later would be lost with the replaced one.
  std::error_code code;
  const auto type = fs::status(path_, code);
  const bool printed = is_stdout(path_);
  in_place_ = printed || (fs::exists(type) && !fs::is_regular_file(type));
  target_ = in_place_ ? path_ : behind_links(path_);
  part_ = in_place_ ? path_ : part_of(target_);
  if (fs::is_directory(type)) {
    fail("write", EISDIR);
    return;
  }
  fd_ = printed ? ::fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, 0)
                : ::open(part_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (fd_ < 0) fail("create", errno);
}

FileWriter::~FileWriter() {
  if (fd_ < 0) return;
  ::close(fd_);
  if (!in_place_) ::unlink(part_.c_str());
}

void FileWriter::fail(std::string_view doing, int error) {
  if (status_) status_ = io_error(path_, doing, error);
}

void FileWriter::append(std::string_view text) {
  if (fd_ < 0 || !status_) return;
  buffer_ += text;
  if (buffer_.size() > (1 << 18)) flush();
}

void FileWriter::flush() {
  if (const int error = write_all(fd_, std::as_bytes(std::span(buffer_)))) fail("write", error);
  buffer_.clear();
}

Status FileWriter::commit() {
  if (fd_ < 0) return status_;
  flush();
  if (::close(fd_) != 0) fail("write", errno);
  fd_ = -1;
  if (status_ && !in_place_ && ::rename(part_.c_str(), target_.c_str()) != 0) fail("write", errno);
  if (!status_ && !in_place_) ::unlink(part_.c_str());
  return status_;
}

Status write_file(const fs::path& path, std::span<const std::byte> content) {
  return write_file(
      path, std::string_view(reinterpret_cast<const char*>(content.data()), content.size()));
}

Status write_file(const fs::path& path, std::string_view content) {
  if (path.empty())
    return Error{ErrorCode::invalid_argument, "an empty file name", {}, "name a file"};
  FileWriter file(path);
  file.append(content);
  return file.commit();
}

Result<std::string> read_file(const fs::path& path, size_t max_bytes) {
  std::FILE* file = std::fopen(path.c_str(), "rbe");
  if (!file) return io_error(path, "open", errno);
  std::string content;
  char block[1 << 16];
  int error = 0;
  while (error == 0) {
    const size_t n = std::fread(block, 1, sizeof block, file);
    if (n == 0) {
      if (std::ferror(file)) error = errno ? errno : EIO;
      break;
    }
    content.append(block, n);
    if (content.size() > max_bytes) error = EFBIG;
  }
  std::fclose(file);
  if (error != 0) return io_error(path, "read", error);
  return content;
}

Status make_folder(const fs::path& path) {
  std::error_code code;
  fs::create_directories(path, code);
  if (code) return io_error(path, "create the folder", code.value());
  if (!fs::is_directory(path, code)) return io_error(path, "create the folder", ENOTDIR);
  return {};
}

void remove_temporary_files(const fs::path& folder) {
  std::error_code code;
  for (fs::directory_iterator it(folder, code), end; !code && it != end; it.increment(code)) {
    std::error_code ignored;
    if (it->path().filename().string().starts_with(part_prefix)) fs::remove(it->path(), ignored);
  }
}

}  // namespace tumble
