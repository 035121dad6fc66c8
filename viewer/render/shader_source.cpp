#include "viewer/render/shader_source.hpp"

#include <fstream>
#include <sstream>
#include <string_view>

namespace tumble {
namespace {

constexpr int deepest_include = 8;
constexpr std::string_view include_key = "#include \"";

}  // namespace

Result<const std::string*> ShaderSources::text_of(const std::string& name) {
  const auto known = texts_.find(name);
  if (known != texts_.end()) return &known->second;
  const std::filesystem::path file = folder_ / name;
  std::ifstream in(file);
  std::ostringstream text;
  if (!in || !(text << in.rdbuf()))
    return Error{ErrorCode::io, "shader cannot be read", file.string(), "reinstall Tumble"};
  return &(texts_[name] = std::move(text).str());
}

Status ShaderSources::append(const std::string& name, int depth, std::string& out) {
  if (depth > deepest_include)
    return Error{ErrorCode::parse, "includes go in a circle", (folder_ / name).string(), ""};
  const auto text = text_of(name);
  if (!text) return text.error();
  std::istringstream in(**text);
  std::string line;
  while (std::getline(in, line)) {
    if (!line.starts_with(include_key)) {
      out += line + "\n";
      continue;
    }
    const size_t begin = include_key.size();
    if (Status s = append(line.substr(begin, line.find('"', begin) - begin), depth + 1, out); !s)
      return s;
  }
  return {};
}

Result<std::string> ShaderSources::load(const std::string& name) {
  std::string text;
  if (Status s = append(name, 0, text); !s) return s.error();
  return text;
}

}  // namespace tumble
