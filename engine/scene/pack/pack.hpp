#pragma once
#include "engine/core/result.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace tumble {

/// A file of a pack: its name there, with '/' between folders, and its bytes.
struct PackFile {
  std::string name;
  std::string bytes;
};

/// How much a pack may hold.
struct PackLimits {
  size_t entries = 4096;
  uint64_t bytes = uint64_t(1) << 30;  ///< of all files together
  /// Bytes that come out for each that went in, beyond the first 16 MiB: texts of meshes have ten.
  uint64_t ratio = 100;
};

/// The name of the replay in a pack.
constexpr const char* pack_replay_name = "replay.bin";

/// A scene by name or path with all files that it needs, ready to be packed. Also a mesh or robot
/// file: then with the scene about it. `text` stands in place of what the scene's file holds.
/// Errors: what reading the scene finds.
Result<std::vector<PackFile>> pack_files(const std::string& scene,
                                         const std::optional<std::string>& text = {});

/// Writes an archive of these files, the same bytes for the same files; whole or not at all.
Status write_pack(const std::filesystem::path& file, const std::vector<PackFile>& files);

/// Whether a file begins as a ZIP archive does.
bool is_pack_file(const std::filesystem::path& file);

/// Reads an archive, checking everything that its entries claim.
Result<std::vector<PackFile>> read_pack(const std::filesystem::path& file,
                                        const PackLimits& limits = {});

/// Puts the files of an archive into a folder of the user's cache, unless they are there, and gives
/// the path of the scene.
Result<std::filesystem::path> unpack(const std::filesystem::path& file);
/// The folder below which unpack() puts packs; a file there is not its user's to change.
std::filesystem::path pack_folder();

}  // namespace tumble
