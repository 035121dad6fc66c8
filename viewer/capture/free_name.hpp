#pragma once
#include <filesystem>
#include <string_view>

namespace tumble {

/// The first of FOLDER/STEM-000ENDING, FOLDER/STEM-001ENDING, ... that does not exist.
std::filesystem::path free_name(const std::filesystem::path& folder, std::string_view stem,
                                std::string_view ending);

}  // namespace tumble
