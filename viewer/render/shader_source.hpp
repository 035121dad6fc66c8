#pragma once
#include "engine/core/result.hpp"

#include <filesystem>
#include <string>

namespace tumble {

/// The text of a shader with its `#include "file"` lines replaced by the files beside it. Fails
/// naming the file that cannot be read, or that includes itself.
Result<std::string> load_shader(const std::filesystem::path& file);

}  // namespace tumble
