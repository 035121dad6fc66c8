#pragma once
#include "engine/core/result.hpp"
#include "viewer/capture/frame_clock.hpp"

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace tumble {

/// One frame of an export as particles.json tells of it.
struct ExportRecord {
  uint64_t index = 0;
  uint64_t state_hash = 0;                ///< of the last tick that the frame needs
  std::map<std::string, uint64_t> files;  ///< hashes of their bytes, by name
};

/// Everything that particles.json says.
struct ExportList {
  std::string version, scene, run, format;
  Fraction fps{30, 1};
  TickRate rate;
  uint64_t frames_wanted = 0;
  std::vector<std::string> systems;  ///< their names in file names
  std::vector<ExportRecord> frames;
};

inline constexpr const char* export_list_name = "particles.json";

/// "water_000042.ply"
std::string export_file_name(const std::string& stem, uint64_t index, const std::string& ending);
/// Whether a file has such a name, whatever its number.
bool is_export_file_name(const std::string& name, const std::string& stem,
                         const std::string& ending);
/// Names of systems as parts of file names, all different: what is not a letter of ASCII, a digit,
/// '-', '_' or '.' becomes '_', and what is there already gets a number.
std::vector<std::string> file_stems(const std::vector<std::string>& names);

/// Writes DIR/particles.json, whole or not at all.
Status write_export_list(const std::filesystem::path& folder, const ExportList& list);
/// Reads back what resuming needs: run and frames.
Result<ExportList> read_export_list(const std::filesystem::path& folder);
/// How many of the first frames are on disk as the list tells.
size_t whole_frames(const std::filesystem::path& folder, const ExportList& list);

}  // namespace tumble
