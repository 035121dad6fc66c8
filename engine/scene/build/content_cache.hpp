#pragma once
#include "engine/core/bytes.hpp"
#include "engine/geometry/triangle_mesh.hpp"

#include <filesystem>
#include <optional>

namespace tumble {

/// Cache of computed results by the content of their input: a folder that several processes may use
/// at once. A file is written atomically under the hash of everything that determines its content,
/// including the version of the method; a damaged file, or one of another key, counts as missing.
/// If the folder cannot be read or written, nothing is cached.
class ContentCache {
 public:
  /// A folder of this name under tumble in $XDG_CACHE_HOME, or ~/.cache (XDG Base Directory
  /// Specification); empty if neither is known.
  static std::filesystem::path usual_folder(std::string_view name);

  /// With an empty folder nothing is cached.
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
