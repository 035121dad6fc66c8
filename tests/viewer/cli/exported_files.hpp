#pragma once
#include <array>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include <fmt/format.h>

/// Readers of exported files that share nothing with what writes them.
namespace tumble::exported {

inline std::string file_text(const std::filesystem::path& file) {
  std::ostringstream out;
  out << std::ifstream(file, std::ios::binary).rdbuf();
  return out.str();
}

inline std::string fmt_time(double time) {
  return fmt::format("time {} s", time);
}

inline std::string export_name(const std::string& stem, size_t frame) {
  return fmt::format("{}_{:06d}.ply", stem, frame);
}

/// A binary little-endian PLY file: scalar properties of vertices as columns, faces of triangles.
struct PlyFile {
  bool good = false;
  std::string header;
  size_t vertices = 0;
  std::map<std::string, std::vector<double>> columns;
  std::vector<std::array<int32_t, 3>> faces;
};

inline PlyFile read_ply(const std::filesystem::path& path) {
  PlyFile out;
  const std::string bytes = file_text(path);
  const std::string last = "end_header\n";
  const size_t found = bytes.find(last);
  if (!bytes.starts_with("ply\nformat binary_little_endian 1.0\n") || found == std::string::npos)
    return out;
  out.header = bytes.substr(0, found);
  size_t faces = 0, at = found + last.size();
  std::vector<std::pair<std::string, std::string>> properties;
  std::istringstream lines(out.header);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string word, type, name;
    words >> word >> type >> name;
    if (word == "element" && type == "vertex") out.vertices = std::stoul(name);
    if (word == "element" && type == "face") faces = std::stoul(name);
    if (word == "property" && type != "list") properties.emplace_back(type, name);
  }
  const auto take = [&](auto value) {
    if (at + sizeof value <= bytes.size()) std::memcpy(&value, bytes.data() + at, sizeof value);
    at += sizeof value;
    return value;
  };
  for (const auto& [type, name] : properties) out.columns[name];
  for (size_t i = 0; i < out.vertices; ++i)
    for (const auto& [type, name] : properties)
      out.columns[name].push_back(type == "double"  ? take(0.0)
                                  : type == "uchar" ? double(take(uint8_t{0}))
                                                    : double(take(uint32_t{0})));
  for (size_t i = 0; i < faces; ++i) {
    if (take(uint8_t{0}) != 3) return out;
    out.faces.push_back({take(int32_t{0}), take(int32_t{0}), take(int32_t{0})});
  }
  out.good = at == bytes.size();
  return out;
}

struct XmlNode {
  std::string name, text;
  std::map<std::string, std::string> attributes;
  std::vector<std::unique_ptr<XmlNode>> children;

  /// All below with this name, in order.
  std::vector<const XmlNode*> all(const std::string& wanted) const {
    std::vector<const XmlNode*> out;
    for (const auto& child : children) {
      if (child->name == wanted) out.push_back(child.get());
      for (const XmlNode* below : child->all(wanted)) out.push_back(below);
    }
    return out;
  }
};

/// XML without entities and CDATA; the document is the node without a name. Throws
/// std::runtime_error for what is not well formed.
inline XmlNode read_xml(const std::string& text) {
  const auto need = [](bool fine) {
    if (!fine) throw std::runtime_error("not well-formed XML");
  };
  XmlNode document;
  std::vector<XmlNode*> open = {&document};
  for (size_t at = 0; at < text.size();) {
    const size_t tag = text.find('<', at);
    open.back()->text += text.substr(at, tag - at);
    if (tag == std::string::npos) break;
    if (text.compare(tag, 4, "<!--") == 0 || text.compare(tag, 2, "<?") == 0) {
      const std::string end = text[tag + 1] == '?' ? "?>" : "-->";
      at = text.find(end, tag);
      need(at != std::string::npos);
      at += end.size();
      continue;
    }
    const size_t end = text.find('>', tag);
    need(end != std::string::npos);
    std::string inside = text.substr(tag + 1, end - tag - 1);
    at = end + 1;
    if (inside[0] == '/') {
      need(open.size() > 1 && inside.substr(1) == open.back()->name);
      open.pop_back();
      continue;
    }
    const bool empty = inside.back() == '/';
    if (empty) inside.pop_back();
    auto node = std::make_unique<XmlNode>();
    size_t k = inside.find_first_of(" \n");
    node->name = inside.substr(0, k);
    while (k != std::string::npos &&
           (k = inside.find_first_not_of(" \n", k)) != std::string::npos) {
      const size_t equals = inside.find("=\"", k);
      need(equals != std::string::npos);
      const size_t quote = inside.find('"', equals + 2);
      need(quote != std::string::npos);
      node->attributes[inside.substr(k, equals - k)] =
          inside.substr(equals + 2, quote - equals - 2);
      k = quote + 1;
    }
    open.back()->children.push_back(std::move(node));
    if (!empty) open.push_back(open.back()->children.back().get());
  }
  need(open.size() == 1);
  return document;
}

/// An unstructured grid whose arrays are inline and in base64 behind 8 bytes of their length.
struct VtuFile {
  std::string fault;  ///< empty: fine
  size_t points = 0, cells = 0;
  std::map<std::string, std::pair<std::string, std::string>> arrays;  ///< type, bytes

  template <class T>
  std::vector<T> array(const std::string& name) const {
    const auto& [type, bytes] = arrays.at(name);
    const std::string expected = std::is_floating_point_v<T> ? "Float"
                                 : std::is_signed_v<T>       ? "Int"
                                                             : "UInt";
    if (type != expected + std::to_string(8 * sizeof(T))) return {};
    std::vector<T> out(bytes.size() / sizeof(T));
    if (!out.empty()) std::memcpy(out.data(), bytes.data(), out.size() * sizeof(T));
    return out;
  }
};

inline std::string bytes_of_base64(const std::string& text) {
  std::string out;
  uint32_t bits = 0;
  int count = 0;
  for (const char c : text) {
    uint32_t value = 0;
    if (c >= 'A' && c <= 'Z')
      value = uint32_t(c - 'A');
    else if (c >= 'a' && c <= 'z')
      value = uint32_t(c - 'a' + 26);
    else if (c >= '0' && c <= '9')
      value = uint32_t(c - '0' + 52);
    else if (c == '+')
      value = 62;
    else if (c == '/')
      value = 63;
    else
      continue;
    bits = (bits << 6) | value;
    count += 6;
    if (count >= 8) out += char((bits >> (count -= 8)) & 255);
  }
  return out;
}

inline VtuFile read_vtu(const std::filesystem::path& path) {
  VtuFile out;
  try {
    const XmlNode xml = read_xml(file_text(path));
    const auto& file = xml.children.at(0)->attributes;
    if (file.at("type") != "UnstructuredGrid" || file.at("byte_order") != "LittleEndian" ||
        file.at("header_type") != "UInt64")
      out.fault = "another kind of file";
    const XmlNode& piece = *xml.all("Piece").at(0);
    out.points = std::stoul(piece.attributes.at("NumberOfPoints"));
    out.cells = std::stoul(piece.attributes.at("NumberOfCells"));
    for (const XmlNode* array : piece.all("DataArray")) {
      const std::string bytes = bytes_of_base64(array->text);
      uint64_t length = 0;
      if (bytes.size() >= 8) std::memcpy(&length, bytes.data(), 8);
      if (array->attributes.at("format") != "binary" || bytes.size() != 8 + length)
        out.fault = "length of " + array->attributes.at("Name");
      out.arrays[array->attributes.at("Name")] = {array->attributes.at("type"), bytes.substr(8)};
    }
  } catch (const std::exception& e) {
    out.fault = e.what();
  }
  return out;
}

}  // namespace tumble::exported
