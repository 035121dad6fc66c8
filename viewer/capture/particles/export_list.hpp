#pragma once
#include "engine/core/result.hpp"
#include "viewer/capture/frame_clock.hpp"

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace tumble {

/// The entry of one frame in particles.json.
struct ExportRecord {
  uint64_t index = 0;
  uint64_t state_hash = 0;                ///< of the last tick that the frame needs
  std::map<std::string, uint64_t> files;  ///< hashes of the files' contents, by name
};

/// The content of particles.json.
struct ExportList {
  std::string version, scene, run, format;
  Fraction fps{30, 1};
  TickRate rate;
  uint64_t frames_wanted = 0;
  std::vector<std::string> systems;  ///< names of the systems as parts of file names
  std::vector<ExportRecord> frames;
};

inline constexpr const char* export_list_name = "particles.json";

/// "water_000042.ply"
std::string export_file_name(const std::string& stem, uint64_t index, const std::string& ending);
/// Whether a file name has this form, with any number.
bool is_export_file_name(const std::string& name, const std::string& stem,
                         const std::string& ending);
/// Names of systems as parts of file names, all different: each character other than an ASCII
/// letter, a digit, '-', '_' or '.' becomes '_', and a name that is already used gets a number.
std::vector<std::string> file_stems(const std::vector<std::string>& names);

/// Writes DIR/particles.json, whole or not at all.
Status write_export_list(const std::filesystem::path& folder, const ExportList& list);
/// Reads what is needed to resume: run and frames.
Result<ExportList> read_export_list(const std::filesystem::path& folder);
/// The number of leading frames whose files exist and match the list.
size_t whole_frames(const std::filesystem::path& folder, const ExportList& list);

}  // namespace tumble
