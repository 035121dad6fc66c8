#include "engine/scene/mesh_files/polygon_file.hpp"

#include <array>
#include <bit>
#include <charconv>
#include <cstring>
#include <limits>
#include <optional>
#include <string_view>

#include <fmt/format.h>

// The Stanford polygon format (Turk 1994): a text header that declares elements and their
// properties, then their values as text or binary. Every count is checked against the remaining
// bytes before anything is allocated for it.
namespace tumble {
namespace {

enum class Type { i8, u8, i16, u16, i32, u32, f32, f64 };

std::optional<Type> type_named(std::string_view name) {
  using Entry = std::pair<std::string_view, Type>;
  static constexpr std::array<Entry, 16> names = {
      Entry{"char", Type::i8}, {"int8", Type::i8},     {"uchar", Type::u8},
      {"uint8", Type::u8},     {"short", Type::i16},   {"int16", Type::i16},
      {"ushort", Type::u16},   {"uint16", Type::u16},  {"int", Type::i32},
      {"int32", Type::i32},    {"uint", Type::u32},    {"uint32", Type::u32},
      {"float", Type::f32},    {"float32", Type::f32}, {"double", Type::f64},
      {"float64", Type::f64}};
  for (const auto& [text, type] : names) {
    if (text == name) return type;
  }
  return std::nullopt;
}

size_t size_of(Type t) {
  constexpr size_t sizes[] = {1, 1, 2, 2, 4, 4, 4, 8};
  return sizes[size_t(t)];
}

struct Property {
  std::string name;
  Type type = Type::f32;
  std::optional<Type> length;  // of a list
};

struct Element {
  std::string name;
  uint64_t count = 0;
  std::vector<Property> properties;
};

enum class Encoding { text, little, big };

/// Reads numbers in turn, text or binary; after the end it returns zeros and reports that.
class Values {
 public:
  Values(std::string_view bytes, Encoding encoding) : rest_(bytes), encoding_(encoding) {}

  bool failed() const { return failed_; }
  size_t left() const { return rest_.size(); }
  /// The least number of bytes of a value.
  size_t least(Type t) const { return encoding_ == Encoding::text ? 1 : size_of(t); }

  double next(Type t) { return encoding_ == Encoding::text ? text() : binary(t); }

 private:
  double text() {
    const auto start = rest_.find_first_not_of(" \t\r\n\v\f");
    rest_.remove_prefix(std::min(start, rest_.size()));
    if (!rest_.empty() && rest_.front() == '+') rest_.remove_prefix(1);
    double x = 0;
    const auto [end, error] = std::from_chars(rest_.data(), rest_.data() + rest_.size(), x);
    if (error == std::errc::invalid_argument) {
      failed_ = true;
      return 0;
    }
    const std::string_view token = rest_.substr(0, size_t(end - rest_.data()));
    rest_.remove_prefix(token.size());
    if (error == std::errc{}) return x;
    // Out of range: either too small to matter, or too large, which is rejected later.
    const bool small = token.find("e-") != token.npos || token.find("E-") != token.npos;
    return small ? 0 : std::numeric_limits<double>::infinity();
  }

  template <class T>
  static double as(const char* bytes) {
    T value;
    std::memcpy(&value, bytes, sizeof(T));
    return double(value);
  }

  double binary(Type t) {
    const size_t n = size_of(t);
    if (rest_.size() < n) {
      failed_ = true;
      return 0;
    }
    char bytes[8];
    const bool swap = (encoding_ == Encoding::big) == (std::endian::native == std::endian::little);
    for (size_t i = 0; i < n; ++i) bytes[i] = rest_[swap ? n - 1 - i : i];
    rest_.remove_prefix(n);
    switch (t) {
      case Type::i8:
        return as<int8_t>(bytes);
      case Type::u8:
        return as<uint8_t>(bytes);
      case Type::i16:
        return as<int16_t>(bytes);
      case Type::u16:
        return as<uint16_t>(bytes);
      case Type::i32:
        return as<int32_t>(bytes);
      case Type::u32:
        return as<uint32_t>(bytes);
      case Type::f32:
        return as<float>(bytes);
      case Type::f64:
        return as<double>(bytes);
    }
    return 0;
  }

  std::string_view rest_;
  Encoding encoding_;
  bool failed_ = false;
};

std::vector<std::string_view> words(std::string_view line) {
  std::vector<std::string_view> out;
  for (size_t at = 0;;) {
    at = line.find_first_not_of(" \t\r", at);
    if (at == std::string_view::npos) return out;
    const size_t end = std::min(line.find_first_of(" \t\r", at), line.size());
    out.push_back(line.substr(at, end - at));
    at = end;
  }
}

struct Header {
  std::optional<Encoding> encoding;
  std::vector<Element> elements;
};

/// Parses one line of the header; returns the message of a fault, or nothing.
std::string take_line(Header& header, const std::vector<std::string_view>& w) {
  if (w.empty() || w[0] == "comment" || w[0] == "obj_info" || w[0] == "ply") return {};
  if (w[0] == "format" && w.size() >= 2) {
    if (w[1] == "ascii") header.encoding = Encoding::text;
    if (w[1] == "binary_little_endian") header.encoding = Encoding::little;
    if (w[1] == "binary_big_endian") header.encoding = Encoding::big;
    return header.encoding ? "" : fmt::format("unknown format '{}'", w[1]);
  }
  if (w[0] == "element" && w.size() >= 3) {
    Element e;
    e.name = w[1];
    const auto [end, error] = std::from_chars(w[2].data(), w[2].data() + w[2].size(), e.count);
    if (error != std::errc{} || end != w[2].data() + w[2].size()) {
      return fmt::format("'{}' is no count of '{}'", w[2], w[1]);
    }
    header.elements.push_back(std::move(e));
    return {};
  }
  if (w[0] == "property" && !header.elements.empty()) {
    const bool list = w.size() >= 5 && w[1] == "list";
    if (!list && w.size() < 3) return "a property without type or name";
    Property p;
    if (list) {
      p.length = type_named(w[2]);
      if (!p.length) return fmt::format("unknown type '{}'", w[2]);
    }
    const auto type = type_named(w[list ? 3 : 1]);
    if (!type) return fmt::format("unknown type '{}'", w[list ? 3 : 1]);
    p.type = *type;
    p.name = w[list ? 4 : 2];
    header.elements.back().properties.push_back(std::move(p));
    return {};
  }
  return fmt::format("a header line starts with '{}'", w[0]);
}

/// Reads one element into `out`; returns the message of a fault, or nothing.
std::string take_element(const Element& e, Values& values, PolygonFile& out) {
  size_t least = 0;
  for (const Property& p : e.properties) least += values.least(p.length.value_or(p.type));
  if (least == 0) return {};  // nothing stored
  if (e.count > most_mesh_elements || e.count > values.left() / least) {
    return fmt::format("{} elements '{}' are declared, but only {} bytes follow", e.count, e.name,
                       values.left());
  }
  const bool vertex = e.name == "vertex", face = e.name == "face";
  if (vertex) {
    int axes = 0;
    for (const Property& p : e.properties) {
      axes += !p.length && (p.name == "x" || p.name == "y" || p.name == "z");
    }
    if (axes != 3) return "vertices have no x, y and z";
    out.vertices.reserve(e.count);
  }
  for (uint64_t i = 0; i < e.count; ++i) {
    Vec3 position = Vec3::Zero();
    for (const Property& p : e.properties) {
      if (!p.length) {
        const double x = values.next(p.type);
        if (p.name.size() == 1 && p.name[0] >= 'x' && p.name[0] <= 'z')
          position[p.name[0] - 'x'] = x;
        continue;
      }
      const double length = values.next(*p.length);
      if (!(length >= 0) || length > double(values.left() / values.least(p.type))) {
        return fmt::format("list '{}' of '{}' {} has length {}", p.name, e.name, i, length);
      }
      const bool corners = face && (p.name == "vertex_indices" || p.name == "vertex_index");
      for (uint64_t k = 0; k < uint64_t(length); ++k) {
        const double index = values.next(p.type);
        const bool number = index >= 0 && index < 4294967295.0;
        if (corners) out.corners.push_back(number ? uint32_t(index) : 0xffffffffu);
      }
      if (corners) out.end_polygon();
    }
    if (values.failed()) return fmt::format("the file ends in '{}' {}", e.name, i);
    if (vertex) out.vertices.push_back(position);
  }
  return {};
}

}  // namespace

Result<PolygonFile> read_ply(const std::filesystem::path& file) {
  const auto bytes = read_mesh_bytes(file);
  if (!bytes) return bytes.error();
  std::string_view rest = *bytes;
  if (!rest.starts_with("ply")) return mesh_file_fault(file, "a PLY file starts with 'ply'");
  Header header;
  for (int number = 1;; ++number) {
    const size_t end = rest.find('\n');
    if (end == std::string_view::npos) return mesh_file_fault(file, "the header has no end");
    const auto w = words(rest.substr(0, end));
    rest.remove_prefix(end + 1);
    if (!w.empty() && w[0] == "end_header") break;
    if (const std::string wrong = take_line(header, w); !wrong.empty()) {
      return mesh_file_fault(file, fmt::format("line {}: {}", number, wrong));
    }
  }
  if (!header.encoding) return mesh_file_fault(file, "the header names no format");
  PolygonFile out;
  out.begin_part(file.stem().string());
  Values values(rest, *header.encoding);
  for (const Element& e : header.elements) {
    const std::string wrong = take_element(e, values, out);
    if (!wrong.empty()) return mesh_file_fault(file, wrong);
  }
  return out;
}

}  // namespace tumble
