#pragma once
#include "engine/core/bytes.hpp"
#include "engine/geometry/triangle_mesh.hpp"

#include <filesystem>
#include <optional>

namespace tumble {

/// What was computed before, by the content of what it was computed from: a folder that several
/// processes may use at once. A file appears whole or not at all under the hash of everything that
/// decides what is in it, the version of the method too; one that is damaged, or another's, is as
/// if it were not there. What cannot be read or written is as if there were no cache.
class ContentCache {
 public:
  /// A folder of this name under tumble in $XDG_CACHE_HOME, or ~/.cache (XDG Base Directory
  /// Specification); none where neither is known.
  static std::filesystem::path usual_folder(std::string_view name);

  /// An empty folder keeps nothing.
  ContentCache(std::filesystem::path folder, std::string extension)
      : folder_(std::move(folder)), extension_(std::move(extension)) {}

  const std::filesystem::path& folder() const { return folder_; }
  std::optional<Bytes> read(std::span<const std::byte> key) const;
  void write(std::span<const std::byte> key, std::span<const std::byte> content) const;

 private:
  std::filesystem::path file_of(std::span<const std::byte> key) const;

  std::filesystem::path folder_;
  std::string extension_;
};

/// Adds a mesh to a key.
void add_to_key(ByteWriter& key, const TriangleMesh& mesh);

}  // namespace tumble
