#pragma once
#include "engine/core/result.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace tumble {

struct SceneDescription;
struct SceneRequest;

/// The files that a command reads, and those that it writes. They are compared before anything is
/// written, under whatever names they go: by links, or as another path of the same file. Empty
/// names are left out, and so are devices and pipes, which lose nothing when they are written.
class FileRoles {
 public:
  FileRoles& reads(const std::filesystem::path& file);
  /// The scene's file, given by path or name, the robot files that it names, and the replay.
  FileRoles& reads(const SceneRequest& request);
  /// The mesh files of a scene.
  FileRoles& reads(const SceneDescription& scene);
  /// A file or folder, and the option that names it.
  FileRoles& writes(const std::string& option, const std::filesystem::path& file);

  /// An error if an output is read too, or if two outputs are the same: one would be lost.
  Status apart() const;

 private:
  struct Output {
    std::string option;
    std::filesystem::path file;
  };
  std::vector<std::filesystem::path> inputs_;
  std::vector<Output> outputs_;
};

}  // namespace tumble
