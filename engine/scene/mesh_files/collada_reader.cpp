#include "engine/scene/mesh_files/polygon_file.hpp"

#include <charconv>
#include <cstdint>
#include <optional>
#include <string_view>

#include <fmt/format.h>

// The library reads Collada, but trusts every count: a wrong one makes it read out of bounds or
// fill memory for minutes. So the counts are checked first, tag by tag.
namespace tumble {
namespace {

/// The value of attribute `name` in the text of a tag; empty if it is missing.
std::optional<uint64_t> number_attribute(std::string_view tag, std::string_view name) {
  for (size_t at = tag.find(name); at != std::string_view::npos; at = tag.find(name, at + 1)) {
    const bool starts = at > 0 && (tag[at - 1] == ' ' || tag[at - 1] == '\t' ||
                                   tag[at - 1] == '\n' || tag[at - 1] == '\r');
    size_t p = tag.find_first_not_of(" \t\r\n", at + name.size());
    if (!starts || p == std::string_view::npos || tag[p] != '=') continue;
    p = tag.find_first_not_of(" \t\r\n", p + 1);
    if (p == std::string_view::npos || (tag[p] != '"' && tag[p] != '\'')) continue;
    p = tag.find_first_not_of(" \t\r\n", p + 1);
    if (p == std::string_view::npos) return UINT64_MAX;
    uint64_t value = 0;
    const auto [end, error] = std::from_chars(tag.data() + p, tag.data() + tag.size(), value);
    return error == std::errc{} ? value : UINT64_MAX;
  }
  return std::nullopt;
}

/// The number of values, separated by white space, in a text.
uint64_t count_values(std::string_view text) {
  uint64_t n = 0;
  bool inside = false;
  for (const char c : text) {
    const bool space = c == ' ' || c == '\t' || c == '\n' || c == '\r';
    n += !space && !inside;
    inside = !space;
  }
  return n;
}

/// The name of a tag without its namespace.
std::string_view tag_name(std::string_view tag) {
  const std::string_view name = tag.substr(0, tag.find_first_of(" \t\r\n/"));
  const size_t colon = name.find(':');
  return colon == std::string_view::npos ? name : name.substr(colon + 1);
}

/// The fault in the counts of a Collada text; empty if there is none.
std::string count_fault(std::string_view xml) {
  uint64_t values = 0;  // number of values in the last array read
  for (size_t at = xml.find('<'); at != std::string_view::npos; at = xml.find('<', at + 1)) {
    const size_t end = xml.find('>', at);
    if (end == std::string_view::npos) return "a tag has no end";
    const std::string_view tag = xml.substr(at + 1, end - at - 1), name = tag_name(tag);
    for (const char* attribute : {"count", "stride", "offset"}) {
      const auto n = number_attribute(tag, attribute);
      if (n && *n > xml.size()) {
        return fmt::format("<{}> has a {} that {} bytes cannot hold", name, attribute, xml.size());
      }
    }
    if (name.ends_with("_array")) {
      const size_t close = std::min(xml.find('<', end), xml.size());
      values = tag.ends_with('/') ? 0 : count_values(xml.substr(end + 1, close - end - 1));
      const uint64_t declared = number_attribute(tag, "count").value_or(0);
      if (declared != values) {
        return fmt::format("<{}> declares {} values and holds {}", name, declared, values);
      }
    } else if (name == "accessor") {
      const uint64_t stride = number_attribute(tag, "stride").value_or(1);
      const uint64_t count = number_attribute(tag, "count").value_or(0);
      const uint64_t offset = number_attribute(tag, "offset").value_or(0);
      if (count > 0 && (stride > values || count > (values - std::min(offset, values)) /
                                                       std::max(stride, uint64_t{1}))) {
        return fmt::format("an <accessor> takes {} times {} values of {}", count, stride, values);
      }
    }
  }
  return {};
}

}  // namespace

Result<PolygonFile> read_collada(const std::filesystem::path& file) {
  const auto xml = read_mesh_bytes(file);
  if (!xml) return xml.error();
  if (const std::string wrong = count_fault(*xml); !wrong.empty()) {
    return mesh_file_fault(file, wrong);
  }
  return read_with_assimp(file);
}

}  // namespace tumble
