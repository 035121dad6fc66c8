// Every folder of the engine and the viewer says what lives there, and no README names a source
// that has gone. Reference: the tree itself.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <string>
#include <vector>

#include <doctest/doctest.h>

namespace fs = std::filesystem;

namespace {

const fs::path root = TUMBLE_SOURCE_DIR;

std::string text_of(const fs::path& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// Calls f with what lies below the folders of sources.
template <class F>
void for_each_entry(const F& f) {
  for (const char* top : {"engine", "viewer", "tests"})
    for (const auto& entry : fs::recursive_directory_iterator(root / top)) f(entry.path());
}

}  // namespace

TEST_CASE("every folder of engine and viewer has a README, or its parent's describes it") {
  int folders = 0;
  for (const char* top : {"engine", "viewer"})
    for (const auto& entry : fs::recursive_directory_iterator(root / top)) {
      if (!entry.is_directory()) continue;
      ++folders;
      const fs::path& folder = entry.path();
      const std::string name = "`" + folder.filename().string() + "/`";
      const bool described =
          fs::exists(folder / "README.md") ||
          text_of(folder.parent_path() / "README.md").find(name) != std::string::npos;
      CHECK_MESSAGE(described, folder.string());
    }
  CHECK(folders > 50);
}

TEST_CASE("no README names a source that is not there") {
  std::vector<std::string> sources;
  std::vector<fs::path> readmes{root / "README.md", root / "scenes/README.md"};
  for_each_entry([&](const fs::path& path) {
    const fs::path extension = path.extension();
    if (extension == ".hpp" || extension == ".cpp")
      sources.push_back("/" + fs::relative(path, root).generic_string());
    if (path.filename() == "README.md") readmes.push_back(path);
  });
  // Capital letters, and x or X_ for a name that is to be chosen, stand in "how to add one".
  const std::regex named("`(?:\\.\\./)*([a-z0-9_/]+\\.[ch]pp)`"), example("(.*[/_])?x\\.[ch]pp");
  int names = 0;
  for (const fs::path& readme : readmes) {
    const std::string text = text_of(readme);
    for (std::sregex_iterator it(text.begin(), text.end(), named), end; it != end; ++it) {
      const std::string name = (*it)[1];
      if (std::regex_match(name, example)) continue;
      ++names;
      const bool there = std::any_of(sources.begin(), sources.end(),
                                     [&](const std::string& s) { return s.ends_with("/" + name); });
      CHECK_MESSAGE(there, readme.string(), " names ", name);
    }
  }
  CHECK(names > 100);
}
