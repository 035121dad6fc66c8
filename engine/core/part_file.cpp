#include "engine/core/part_file.hpp"

#include <string>
#include <system_error>

#include <unistd.h>

namespace tumble {
namespace fs = std::filesystem;

fs::path behind_links(fs::path file) {
  constexpr int most_links = 40;  // as many as Linux follows
  std::error_code error;
  for (int i = 0; i < most_links && fs::is_symlink(fs::symlink_status(file, error)); ++i) {
    const fs::path target = fs::read_symlink(file, error);
    if (error) break;
    file = file.parent_path() / target;  // the target alone, where it is absolute
  }
  return file;
}

fs::path part_of(const fs::path& file) {
  return file.parent_path() /
         (std::string(part_prefix) + std::to_string(::getpid()) + "-" + file.filename().string());
}

}  // namespace tumble
