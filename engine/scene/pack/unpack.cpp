#include "engine/core/hash.hpp"
#include "engine/scene/pack/pack.hpp"
#include "engine/scene/resources.hpp"

#include <algorithm>
#include <fstream>

#include <fmt/format.h>
#include <unistd.h>

namespace tumble {
namespace fs = std::filesystem;
namespace {

/// The only scene file at the top level of a pack.
Result<std::string> scene_in(const fs::path& file, const std::vector<PackFile>& files) {
  std::string found;
  for (const PackFile& f : files) {
    if (f.name.find('/') != std::string::npos || !f.name.ends_with(".json")) continue;
    if (!found.empty())
      return Error{ErrorCode::parse, "holds two scenes, '" + found + "' and '" + f.name + "'",
                   file.string(), "leave one at the top of the archive"};
    found = f.name;
  }
  if (!found.empty()) return found;
  return Error{ErrorCode::parse, "holds no scene: there is no .json file at its top", file.string(),
               "make packs by `tumble pack SCENE -o FILE`"};
}

Status write_all(const fs::path& folder, const std::vector<PackFile>& files) {
  std::error_code error;
  for (const PackFile& f : files) {
    const fs::path to = folder / f.name;
    fs::create_directories(to.parent_path(), error);
    std::ofstream out(to, std::ios::binary);
    out.write(f.bytes.data(), std::streamsize(f.bytes.size()));
    if (!out.flush())
      return Error{ErrorCode::io, "cannot be written", to.string(),
                   "see whether the folder may be written, and has room"};
  }
  return {};
}

/// Whether a folder has all files with the right contents, which may have been deleted or changed.
bool holds(const fs::path& folder, const std::vector<PackFile>& files) {
  return std::ranges::all_of(files, [&](const PackFile& f) {
    std::error_code error;
    const fs::path at = folder / f.name;
    if (!fs::is_regular_file(fs::symlink_status(at, error)) ||
        fs::file_size(at, error) != f.bytes.size())
      return false;
    std::string bytes(f.bytes.size(), '\0');
    std::ifstream in(at, std::ios::binary);
    in.read(bytes.data(), std::streamsize(bytes.size()));
    return in && bytes == f.bytes;
  });
}

}  // namespace

fs::path pack_folder() {
  const fs::path cache = user_folder("XDG_CACHE_HOME", ".cache");
  std::error_code none;
  if (cache.empty())
    return fs::temp_directory_path(none) / fmt::format("tumble-{}", getuid()) / "packs";
  return cache / "tumble" / "packs";
}

Result<fs::path> unpack(const fs::path& file) {
  const auto files = read_pack(file);
  if (!files) return files.error();
  const auto scene = scene_in(file, *files);
  if (!scene) return scene.error();
  uint64_t hash = 0;
  for (const PackFile& f : *files) {
    hash = hash_bytes(f.name.data(), f.name.size(), hash);
    hash = hash_bytes(f.bytes.data(), f.bytes.size(), hash);
  }
  const fs::path folder = pack_folder() / hash_text(hash);
  std::error_code error;
  if (holds(folder, *files)) return folder / *scene;
  // Written to a temporary folder and renamed as a whole, since another program may unpack the same
  // pack at the same time. An incomplete folder is moved away first.
  fs::path beside = folder, damaged = folder;
  beside += fmt::format(".{}", getpid());
  damaged += fmt::format(".{}.damaged", getpid());
  const Status written = write_all(beside, *files);
  if (written) {
    fs::rename(folder, damaged, error);
    fs::rename(beside, folder, error);
  }
  const bool there = holds(folder, *files);
  fs::remove_all(beside, error);
  fs::remove_all(damaged, error);
  if (!written) return written.error();
  if (there) return folder / *scene;
  return Error{ErrorCode::io, "cannot be unpacked", folder.string(),
               "see whether the folder may be written, and has room"};
}

}  // namespace tumble
