#pragma once
#include "engine/core/result.hpp"

#include <filesystem>
#include <map>
#include <string>

namespace tumble {

/// The shaders of one folder; files that many of them include are read once.
class ShaderSources {
 public:
  explicit ShaderSources(std::filesystem::path folder) : folder_(std::move(folder)) {}

  /// The text of a shader with each `#include "file"` replaced by that file of the same folder.
  /// Fails for a file that cannot be read or includes itself, and names it.
  Result<std::string> load(const std::string& name);

 private:
  Status append(const std::string& name, int depth, std::string& out);
  Result<const std::string*> text_of(const std::string& name);

  std::filesystem::path folder_;
  std::map<std::string, std::string> texts_;  ///< by name, as the files have them
};

}  // namespace tumble
