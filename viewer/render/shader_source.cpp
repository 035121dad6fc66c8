#include "viewer/render/shader_source.hpp"

#include <fstream>

namespace tumble {
namespace {

constexpr int deepest_include = 8;

Status append(const std::filesystem::path& file, int depth, std::string& out) {
  if (depth > deepest_include)
    return Error{ErrorCode::parse, "includes go in a circle", file.string(), ""};
  std::ifstream in(file);
  if (!in) return Error{ErrorCode::io, "shader cannot be read", file.string(), "reinstall Tumble"};
  const std::string key = "#include \"";
  std::string line;
  while (std::getline(in, line)) {
    if (line.rfind(key, 0) != 0) {
      out += line + "\n";
      continue;
    }
    const std::string name = line.substr(key.size(), line.find('"', key.size()) - key.size());
    if (Status s = append(file.parent_path() / name, depth + 1, out); !s) return s;
  }
  return {};
}

}  // namespace

Result<std::string> load_shader(const std::filesystem::path& file) {
  std::string text;
  if (Status s = append(file, 0, text); !s) return s.error();
  return text;
}

}  // namespace tumble
