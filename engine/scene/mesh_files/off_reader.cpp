#include "engine/scene/mesh_files/polygon_file.hpp"

#include <charconv>
#include <string_view>

#include <fmt/format.h>

// The object file format of Geomview: "OFF", counts, a line per vertex, a line per face. Colours
// and normals at the end of a line are ignored.
namespace tumble {
namespace {

class Lines {
 public:
  explicit Lines(std::string_view text) : rest_(text) {}

  size_t left() const { return rest_.size(); }
  int number() const { return number_; }

  /// The next line that contains something besides a comment; false at the end.
  bool next(std::string_view& line) {
    while (!rest_.empty()) {
      const size_t end = std::min(rest_.find('\n'), rest_.size());
      line = rest_.substr(0, end);
      rest_.remove_prefix(std::min(end + 1, rest_.size()));
      ++number_;
      line = line.substr(0, line.find('#'));
      const size_t start = line.find_first_not_of(" \t\r");
      if (start == std::string_view::npos) continue;
      line.remove_prefix(start);
      return true;
    }
    return false;
  }

 private:
  std::string_view rest_;
  int number_ = 0;
};

/// Removes the first number from a line. If an integer is expected, a word such as 1e308 is
/// rejected, instead of taking its first digits.
template <class T>
bool take(std::string_view& line, T& value) {
  line.remove_prefix(std::min(line.find_first_not_of(" \t\r"), line.size()));
  if (!line.empty() && line.front() == '+') line.remove_prefix(1);
  const auto [end, error] = std::from_chars(line.data(), line.data() + line.size(), value);
  if (error != std::errc{}) return false;
  line.remove_prefix(size_t(end - line.data()));
  return line.empty() || line.front() == ' ' || line.front() == '\t' || line.front() == '\r';
}

}  // namespace

Result<PolygonFile> read_off(const std::filesystem::path& file) {
  const auto bytes = read_mesh_bytes(file);
  if (!bytes) return bytes.error();
  Lines lines(*bytes);
  const auto fault = [&](std::string message) {
    return mesh_file_fault(file, fmt::format("line {}: {}", lines.number(), std::move(message)));
  };
  std::string_view line;
  if (!lines.next(line)) return fault("the file is empty");
  const size_t key = line.substr(0, 8).find("OFF");
  if (key == std::string_view::npos) return fault("an OFF file starts with 'OFF'");
  const std::string_view kind = line.substr(0, key);
  if (kind.find('4') != std::string_view::npos || kind.find('n') != std::string_view::npos) {
    return fault("only three-dimensional OFF files are read");
  }
  line.remove_prefix(key + 3);
  if (line.find("BINARY") != std::string_view::npos) return fault("binary OFF files are not read");
  if (line.find_first_not_of(" \t\r") == std::string_view::npos && !lines.next(line)) {
    return fault("the counts are missing");
  }
  uint64_t vertices = 0, faces = 0;
  if (!take(line, vertices) || !take(line, faces)) return fault("the counts are no numbers");
  // A vertex takes at least six bytes, a face four.
  if (vertices > most_mesh_elements || faces > most_mesh_elements ||
      vertices > lines.left() / 6 + 1 || faces > lines.left() / 4 + 1) {
    return fault(fmt::format("{} vertices and {} faces are declared, but only {} bytes follow",
                             vertices, faces, lines.left()));
  }
  PolygonFile out;
  out.begin_part(file.stem().string());
  for (uint64_t i = 0; i < vertices; ++i) {
    Vec3 p;
    if (!lines.next(line)) return fault(fmt::format("the file ends at vertex {}", i));
    for (int k = 0; k < 3; ++k) {
      if (!take(line, p[k])) return fault(fmt::format("vertex {} has no three coordinates", i));
    }
    out.vertices.push_back(p);
  }
  for (uint64_t i = 0; i < faces; ++i) {
    if (!lines.next(line)) return fault(fmt::format("the file ends at face {}", i));
    uint32_t count = 0;
    if (!take(line, count) || count > line.size()) {
      return fault(fmt::format("face {} has no sensible number of corners", i));
    }
    for (uint32_t k = 0; k < count; ++k) {
      int64_t v = 0;
      if (!take(line, v)) {
        return fault(fmt::format("face {} has fewer whole numbers of corners than it says", i));
      }
      out.corners.push_back(v >= 0 && v < 0xffffffff ? uint32_t(v) : 0xffffffffu);
    }
    out.end_polygon();
  }
  return out;
}

}  // namespace tumble
