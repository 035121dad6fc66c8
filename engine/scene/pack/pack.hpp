#pragma once
#include "engine/core/result.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace tumble {

/// A file of a pack: its name there, with '/' between folders, and its content.
struct PackFile {
  std::string name;
  std::string bytes;
};

/// Limits for reading a pack.
struct PackLimits {
  size_t entries = 4096;
  uint64_t bytes = uint64_t(1) << 30;  ///< size of all files together
  /// Greatest ratio of unpacked to packed size, beyond the first 16 MiB; meshes as text have about
  /// ten [-].
  uint64_t ratio = 100;
};

/// The name of the replay in a pack.
constexpr const char* pack_replay_name = "replay.bin";

/// The files of a pack for a scene given by name or path, with all files that it needs. For a mesh
/// or robot file, the scene made from it is included. `text` replaces the content of the scene's
/// file. Errors: those of reading the scene.
Result<std::vector<PackFile>> pack_files(const std::string& scene,
                                         const std::optional<std::string>& text = {});

/// Writes an archive of these files, whole or not at all. The same files give the same bytes.
Status write_pack(const std::filesystem::path& file, const std::vector<PackFile>& files);

/// Whether a file begins as a ZIP archive does.
bool is_pack_file(const std::filesystem::path& file);

/// Reads an archive; everything that its entries claim is checked.
Result<std::vector<PackFile>> read_pack(const std::filesystem::path& file,
                                        const PackLimits& limits = {});

/// Unpacks an archive to a folder of the user's cache, unless it is there already, and returns the
/// path of its scene.
Result<std::filesystem::path> unpack(const std::filesystem::path& file);
/// The folder in which unpack() puts packs. Files there belong to the cache and must not be edited.
std::filesystem::path pack_folder();

}  // namespace tumble
