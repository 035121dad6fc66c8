#pragma once
#include "engine/core/result.hpp"

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace tumble {

/// Writes a file that appears whole or not at all: to a temporary name beside it, then renamed. An
/// earlier file of that name stays until then. Errors (ErrorCode::io) name the path and the cause,
/// and leave nothing behind.
Status write_file(const std::filesystem::path& path, std::span<const std::byte> content);
Status write_file(const std::filesystem::path& path, std::string_view content);

/// The whole of a file; fails for folders and for files above `max_bytes`.
Result<std::string> read_file(const std::filesystem::path& path,
                              size_t max_bytes = size_t{1} << 30);

/// Creates a folder with its parents; fails when it cannot be made or is something else.
Status make_folder(const std::filesystem::path& path);

/// Deletes what a killed run left half written in a folder.
void remove_temporary_files(const std::filesystem::path& folder);

}  // namespace tumble
