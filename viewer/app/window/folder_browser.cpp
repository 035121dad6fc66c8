#include "viewer/app/window/folder_browser.hpp"

#include <algorithm>
#include <cctype>
#include <iterator>
#include <string_view>
#include <utility>

namespace tumble {
namespace fs = std::filesystem;
namespace {

constexpr size_t most_entries = 2000;  // limit of the list's length

std::string lower_case(std::string text) {
  for (char& c : text) c = char(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

}  // namespace

bool can_be_opened(const fs::path& file) {
  constexpr std::string_view endings[] = {".json", ".jsonc", ".tumble", ".zip", ".urdf", ".xml",
                                          ".mjcf", ".obj",   ".stl",    ".ply", ".off",  ".gltf",
                                          ".glb",  ".dae",   ".3ds",    ".fbx"};
  return std::ranges::find(endings, lower_case(file.extension().string())) != std::end(endings);
}

FolderView look_through(const fs::path& folder) {
  FolderView out;
  std::error_code error;
  const fs::path whole = fs::weakly_canonical(folder, error);
  out.path = whole.string();
  for (fs::directory_iterator it(whole, error), end; !error && it != end; it.increment(error)) {
    const std::string name = it->path().filename().string();
    if (name.starts_with('.') || out.entries.size() >= most_entries) continue;
    std::error_code none;
    const bool is_folder = it->is_directory(none);
    if (is_folder || can_be_opened(name)) out.entries.push_back({name, is_folder});
  }
  if (error) out.fault = error.message();
  std::ranges::sort(out.entries, {}, [](const FolderView::Entry& e) {
    return std::pair(!e.folder, lower_case(e.name));
  });
  return out;
}

}  // namespace tumble
