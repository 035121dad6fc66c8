#pragma once
#include "engine/core/result.hpp"

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace tumble {

/// The scene that opens when none is named.
constexpr std::string_view default_scene = "demolition";

/// Names of the scenes that come with Tumble, sorted; empty when they are not installed.
std::vector<std::string> scene_names();

/// The path of a scene given by a file name or by the name of one that comes with Tumble. The error
/// for an unknown name lists the known ones.
Result<std::filesystem::path> find_scene(std::string_view name_or_file);

}  // namespace tumble
