#include "engine/core/part_file.hpp"
#include "engine/scene/pack/pack.hpp"

#include <algorithm>
#include <cerrno>
#include <memory>

#include <minizip/zip.h>
#include <zlib.h>

namespace tumble {
namespace fs = std::filesystem;
namespace {

struct CloseZip {
  void operator()(void* archive) const { zipClose(archive, nullptr); }
};

bool add(void* archive, const PackFile& file) {
  zip_fileinfo info{};
  info.tmz_date.tm_year = 1980;  // a constant time, so that the same files give the same bytes
  info.tmz_date.tm_mday = 1;
  info.external_fa = uLong(0100644) << 16;
  constexpr uLong made_by_unix = 3 << 8 | 20;
  const int large = file.bytes.size() >= 0xffffffffu;
  if (zipOpenNewFileInZip4_64(archive, file.name.c_str(), &info, nullptr, 0, nullptr, 0, nullptr,
                              Z_DEFLATED, Z_DEFAULT_COMPRESSION, 0, -MAX_WBITS, DEF_MEM_LEVEL,
                              Z_DEFAULT_STRATEGY, nullptr, 0, made_by_unix, 0, large) != ZIP_OK)
    return false;
  constexpr size_t piece = 1 << 24;
  for (size_t at = 0; at < file.bytes.size(); at += piece) {
    const size_t count = std::min(piece, file.bytes.size() - at);
    if (zipWriteInFileInZip(archive, file.bytes.data() + at, unsigned(count)) != ZIP_OK)
      return false;
  }
  return zipCloseFileInZip(archive) == ZIP_OK;
}

}  // namespace

Status write_pack(const fs::path& file, const std::vector<PackFile>& files) {
  std::error_code none;
  const auto type = fs::status(file, none);
  if (fs::exists(type) && !fs::is_regular_file(type))
    return Error{ErrorCode::io, "this is a folder, a device or a pipe, and a pack is a file",
                 file.string(), "name a file"};
  const auto failed = [&](std::error_code cause) -> Status {
    return Error{ErrorCode::io,
                 "the pack cannot be written" + (cause ? ": " + cause.message() : std::string()),
                 file.string(), "see whether its folder exists, has room and may be written to"};
  };
  const fs::path target = behind_links(file), part = part_of(target);
  errno = 0;
  const auto cause = [] { return std::error_code(errno, std::generic_category()); };
  std::unique_ptr<void, CloseZip> archive(zipOpen64(part.c_str(), APPEND_STATUS_CREATE));
  if (!archive) return failed(cause());
  bool good = true;
  for (const PackFile& f : files) good = good && add(archive.get(), f);
  good = zipClose(archive.release(), nullptr) == ZIP_OK && good;
  std::error_code error = good ? std::error_code() : cause();
  if (good) fs::rename(part, target, error);
  if (good && !error) return {};
  fs::remove(part, none);
  return failed(error);
}

}  // namespace tumble
