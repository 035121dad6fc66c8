#pragma once
#include "engine/scene/mesh_files/polygon_file.hpp"

#include <cstdint>

namespace tumble {

/// What reading one file may take.
struct ReadingLimits {
  double seconds = 10;                 ///< of processor; waiting, three times as much
  uint64_t bytes = uint64_t{1} << 30;  ///< of memory beyond what the program has already
};
/// Limits for a file of so many bytes: generous for a whole one, whatever its format.
ReadingLimits reading_limits(uint64_t file_bytes);

/// Whether this build limits readers: see read_limited().
bool reads_in_a_process_of_its_own();
/// Reads a file with a reader that is not to be trusted (of a foreign library: it may crash, hang
/// or take all memory on damaged files) in a forked process, and takes over what it found. Whatever
/// becomes of that process, this one goes on: an error that says what happened. Builds with
/// sanitizers read in this process: theirs are allocators that may be locked by another thread when
/// it forks, which the C library's never is, and they take the address space for themselves.
Result<PolygonFile> read_limited(const std::filesystem::path& file,
                                 Result<PolygonFile> (*read)(const std::filesystem::path&),
                                 const ReadingLimits& limits);

}  // namespace tumble
