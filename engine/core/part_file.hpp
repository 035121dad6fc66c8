#pragma once
#include <filesystem>
#include <string_view>

namespace tumble {

/// Begin of the names of files that are still being written.
constexpr std::string_view part_prefix = ".tumble-part-";

/// The file that is written by this name: what it leads to where it is a link, whether or not that
/// exists yet. A rename to the name itself would replace the link.
std::filesystem::path behind_links(std::filesystem::path file);

/// The name beside a file under which it is written before it is renamed, unique to this process.
std::filesystem::path part_of(const std::filesystem::path& file);

}  // namespace tumble
