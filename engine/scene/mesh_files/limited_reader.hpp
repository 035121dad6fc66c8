#pragma once
#include "engine/scene/mesh_files/polygon_file.hpp"

#include <cstdint>

namespace tumble {

/// Limits for reading one file.
struct ReadingLimits {
  double seconds = 10;                 ///< CPU time; three times as much wall time [s]
  uint64_t bytes = uint64_t{1} << 30;  ///< memory beyond what the program uses already
};
/// Limits for a file of this size, generous for any valid file of any format.
ReadingLimits reading_limits(uint64_t file_bytes);

/// Whether this build limits readers: see read_limited().
bool reads_in_a_process_of_its_own();
/// Runs an untrusted reader (one of a library, which may crash, hang or exhaust memory on damaged
/// files) in a forked process, and receives its result. Whatever happens to that process, this one
/// continues, with an error that says what happened. Builds with sanitizers read in this process,
/// since their allocators, unlike the C library's, may be locked by another thread during the fork,
/// and they reserve the address space.
Result<PolygonFile> read_limited(const std::filesystem::path& file,
                                 Result<PolygonFile> (*read)(const std::filesystem::path&),
                                 const ReadingLimits& limits);

}  // namespace tumble
