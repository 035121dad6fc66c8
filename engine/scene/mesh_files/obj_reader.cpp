#include "engine/scene/mesh_files/polygon_file.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <string_view>

#include <fmt/format.h>

// Object files of Alias|Wavefront ("Advanced Visualizer" manual, appendix B1): positions `v`, faces
// `f`, and `o`, `g` and `usemtl`, which begin parts. All other statements are ignored. Numbers are
// read as doubles with all their digits.
namespace tumble {
namespace {

constexpr size_t most_obj_parts = 1'000'000;

/// The statements of a file in turn: lines without comments, joined with their continuations after
/// a backslash.
class ObjStatements {
 public:
  explicit ObjStatements(std::string& text) : text_(text) {
    if (text.starts_with("\xef\xbb\xbf")) at_ = 3;  // UTF-8 byte order mark
  }

  size_t line() const { return line_; }  ///< line where the last statement begins

  /// Reads the next statement; false at the end.
  bool next(std::string_view& statement) {
    while (at_ < text_.size()) {
      const size_t start = at_;
      line_ = lines_ + 1;
      size_t last = start, end = pass_line();
      while (at_ < text_.size() && goes_on(last, end)) {
        std::fill(text_.begin() + std::ptrdiff_t(end) - 1, text_.begin() + std::ptrdiff_t(at_),
                  ' ');
        last = at_;
        end = pass_line();
      }
      statement = std::string_view(text_).substr(start, end - start);
      statement = statement.substr(0, statement.find('#'));
      if (statement.find_first_not_of(" \t") != std::string_view::npos) return true;
    }
    return false;
  }

 private:
  /// Goes to the next line, for any kind of line end, and returns where this line ends.
  size_t pass_line() {
    const size_t end = std::min(text_.find_first_of("\r\n", at_), text_.size());
    at_ = std::min(end + (text_.compare(end, 2, "\r\n") == 0 ? 2 : 1), text_.size());
    ++lines_;
    return end;
  }
  bool goes_on(size_t start, size_t end) const {
    const std::string_view line = std::string_view(text_).substr(start, end - start);
    return line.ends_with('\\') && line.find('#') == std::string_view::npos;
  }

  std::string& text_;
  size_t at_ = 0, lines_ = 0, line_ = 0;
};

/// Removes the first word from the text and returns it; empty at the end.
std::string_view take_word(std::string_view& rest) {
  rest.remove_prefix(std::min(rest.find_first_not_of(" \t"), rest.size()));
  const std::string_view word = rest.substr(0, rest.find_first_of(" \t"));
  rest.remove_prefix(word.size());
  return word;
}

/// Whether the whole word is a number that T can represent.
template <class T>
bool is_number(std::string_view word, T& value) {
  if (word.starts_with('+')) word.remove_prefix(1);
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  return error == std::errc{} && end == word.data() + word.size();
}

class ObjReader {
 public:
  ObjReader(const std::filesystem::path& file, std::string& text)
      : file_(file), statements_(text), name_(file.stem().string()) {}

  Result<PolygonFile> read() {
    std::string_view rest;
    while (statements_.next(rest)) {
      const std::string_view key = take_word(rest);
      Status s;
      if (key == "v") s = add_vertex(rest);
      if (key == "f") s = add_face(rest);
      if (key == "o" || key == "g") begin_part(name_, rest);
      if (key == "usemtl") begin_part(material_, rest);
      if (!s) return s.error();
    }
    if (last_corner_ > all_.vertices.size())
      return fault(last_corner_line_,
                   fmt::format("a face has the corner {}, but there are {} vertices", last_corner_,
                               all_.vertices.size()));
    return separated();
  }

 private:
  Error fault(size_t line, std::string message) const {
    Error out = mesh_file_fault(file_, std::move(message));
    out.place += fmt::format(":{}", line);
    return out;
  }
  Error fault(std::string message) const { return fault(statements_.line(), std::move(message)); }
  Error too_many() const {
    return fault(
        fmt::format("the file holds more than {} vertices or corners of faces, or {} parts",
                    most_mesh_elements, most_obj_parts));
  }

  /// `x y z`, `x y z w`, or a position with colours, which are ignored.
  Status add_vertex(std::string_view rest) {
    std::array<double, 4> x{0, 0, 0, 1};
    for (size_t k = 0; k < 4; ++k) {
      const std::string_view word = take_word(rest);
      if (k == 3 && (word.empty() || !take_word(rest).empty())) break;
      if (word.empty()) return fault("a vertex has fewer than three coordinates");
      if (!is_number(word, x[k]) || !std::isfinite(x[k]))
        return fault(fmt::format("the coordinate '{}' is not finite or no number", word));
    }
    if (x[3] == 0) return fault("a vertex of weight 0 is at no place");
    if (all_.vertices.size() == most_mesh_elements) return too_many();
    all_.vertices.push_back(Vec3(x[0], x[1], x[2]) / x[3]);
    return {};
  }

  /// Corners `v`, `v/vt`, `v//vn`, `v/vt/vn`, counted from 1, or from -1 backwards.
  Status add_face(std::string_view rest) {
    const size_t first = all_.corners.size();
    for (std::string_view word; !(word = take_word(rest)).empty();) {
      const std::string_view number = word.substr(0, word.find('/'));
      int64_t v = 0;
      if (!is_number(number, v) ||
          word.find_first_not_of("0123456789-+/", number.size()) != std::string_view::npos)
        return fault(fmt::format("'{}' is no corner of a face", word));
      if (v == 0) return fault("a face has the corner 0, but vertices are counted from 1");
      const auto there = int64_t(all_.vertices.size());
      if (v < -there)
        return fault(fmt::format("a face has the corner {}, but only {} vertices stand before it",
                                 v, there));
      if (v < 0) v += there + 1;
      if (size_t(v) > last_corner_) {
        last_corner_ = size_t(v);
        last_corner_line_ = statements_.line();
      }
      if (all_.corners.size() == 4 * most_mesh_elements) return too_many();
      all_.corners.push_back(uint32_t(v - 1));  // an index that is too large is rejected at the end
    }
    if (all_.corners.size() - first < 3) {  // a point or a line
      all_.corners.resize(first);
      return {};
    }
    if (part_begins_) all_.begin_part(name_);
    part_begins_ = false;
    if (all_.parts.size() > most_obj_parts) return too_many();
    all_.end_polygon();
    return {};
  }

  void begin_part(std::string& what, std::string_view rest) {
    rest.remove_prefix(std::min(rest.find_first_not_of(" \t"), rest.size()));
    rest = rest.substr(0, rest.find_last_not_of(" \t") + 1);
    part_begins_ = part_begins_ || what != rest;
    what = rest;
  }

  /// Gives each part vertices of its own, in the order in which its faces refer to them.
  Result<PolygonFile> separated() const {
    PolygonFile out;
    constexpr uint32_t none = std::numeric_limits<uint32_t>::max();
    std::vector<uint32_t> part_of(all_.vertices.size(), none), place(all_.vertices.size());
    for (size_t p = 0; p < all_.parts.size(); ++p) {
      out.begin_part(all_.parts[p].name);
      const size_t end =
          p + 1 < all_.parts.size() ? all_.parts[p + 1].first_polygon : all_.polygon_count();
      for (size_t f = all_.parts[p].first_polygon; f < end; ++f) {
        for (size_t k = all_.polygon_first[f]; k < all_.polygon_first[f + 1]; ++k) {
          const uint32_t v = all_.corners[k];
          if (part_of[v] != p) {
            part_of[v] = uint32_t(p);
            place[v] = uint32_t(out.vertices.size());
            out.vertices.push_back(all_.vertices[v]);
          }
          out.corners.push_back(place[v]);
        }
        out.end_polygon();
        if (out.vertices.size() > most_mesh_elements) return too_many();
      }
    }
    return out;
  }

  const std::filesystem::path& file_;
  ObjStatements statements_;
  std::string name_, material_;
  bool part_begins_ = true;
  PolygonFile all_;  ///< all vertices of the file; parts may refer to any of them
  /// The largest index, and the line of its first use.
  size_t last_corner_ = 0, last_corner_line_ = 0;
};

}  // namespace

Result<PolygonFile> read_obj(const std::filesystem::path& file) {
  auto bytes = read_mesh_bytes(file);
  if (!bytes) return bytes.error();
  return ObjReader(file, *bytes).read();
}

}  // namespace tumble
