#pragma once
#include "engine/core/result.hpp"

#include <filesystem>
#include <string>

namespace tumble {

/// The text of a shader with each `#include "file"` replaced by that file of the same folder. Fails
/// for a file that cannot be read or includes itself, and names it.
Result<std::string> load_shader(const std::filesystem::path& file);

}  // namespace tumble
