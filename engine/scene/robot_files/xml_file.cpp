#include "engine/scene/robot_files/xml_file.hpp"

#include <cstring>
#include <fstream>
#include <sstream>

#include <fmt/format.h>
#include <tinyxml2.h>
#include <zlib.h>

namespace tumble {
namespace {

namespace fs = std::filesystem;

constexpr size_t max_bytes = size_t{64} << 20;
constexpr int max_depth = 90;

struct EndInflate {
  z_stream* stream;
  ~EndInflate() { inflateEnd(stream); }
};

/// Decompresses gzip; after a fault the text is empty.
std::string unpacked(const std::string& packed, const RobotPlace& at, RobotLog& log) {
  z_stream stream{};
  constexpr int gzip_window = 15 + 16;  // zlib: adding 16 selects the gzip header
  if (inflateInit2(&stream, gzip_window) != Z_OK) {
    log.fault(at, "cannot be unpacked");
    return {};
  }
  const EndInflate end{&stream};
  std::string out;
  std::vector<unsigned char> in(packed.begin(), packed.end()), chunk(size_t{1} << 16);
  stream.next_in = in.data();
  stream.avail_in = uInt(in.size());
  int state = Z_OK;
  while (state == Z_OK && out.size() <= max_bytes) {
    stream.next_out = chunk.data();
    stream.avail_out = uInt(chunk.size());
    state = inflate(&stream, Z_NO_FLUSH);
    out.append(chunk.begin(), chunk.end() - std::ptrdiff_t(stream.avail_out));
    if (state == Z_OK && stream.avail_in == 0 && stream.avail_out > 0) break;
  }
  if (state == Z_STREAM_END) return out;
  log.fault(at, out.size() > max_bytes
                    ? fmt::format("has more than {} bytes when it is unpacked", max_bytes)
                    : "is a damaged or cut gzip file (unpack it with gunzip to see where)");
  return {};
}

XmlElement copy_of(const tinyxml2::XMLElement& from, const std::shared_ptr<const std::string>& file,
                   int depth, RobotLog& log) {
  XmlElement out;
  out.name = from.Name();
  out.at = {file, from.GetLineNum()};
  for (const auto* a = from.FirstAttribute(); a; a = a->Next())
    out.attributes.emplace_back(a->Name(), a->Value());
  if (depth >= max_depth) {
    log.fault(out.at, fmt::format("elements are nested deeper than {}", max_depth));
    return out;
  }
  for (const auto* e = from.FirstChildElement(); e; e = e->NextSiblingElement())
    out.children.push_back(copy_of(*e, file, depth + 1, log));
  return out;
}

std::string cause(const tinyxml2::XMLDocument& document) {
  switch (document.ErrorID()) {
    case tinyxml2::XML_ERROR_EMPTY_DOCUMENT:
      return "has no element";
    case tinyxml2::XML_ERROR_MISMATCHED_ELEMENT:
      return "an element is closed by another's name, or not at all";
    case tinyxml2::XML_ERROR_PARSING_ATTRIBUTE:
      return "an attribute is not of the form name=\"value\", or is given twice";
    case tinyxml2::XML_ERROR_PARSING_ELEMENT:
      return "an element is not of the form <name ...>";
    case tinyxml2::XML_ELEMENT_DEPTH_EXCEEDED:
      return "elements are nested too deep";
    default:
      return std::string("is damaged (") + document.ErrorName() + ")";
  }
}

}  // namespace

const XmlElement* XmlElement::find(std::string_view child) const {
  for (const XmlElement& e : children)
    if (e.name == child) return &e;
  return nullptr;
}

std::optional<XmlElement> parse_xml(const std::string& text, const std::string& name,
                                    RobotLog& log) {
  const auto file = std::make_shared<const std::string>(name);
  tinyxml2::XMLDocument document;
  document.Parse(text.data(), text.size());
  const tinyxml2::XMLElement* root = document.Error() ? nullptr : document.RootElement();
  if (!root) {
    log.fault({file, document.ErrorLineNum()}, text.empty() ? "the file is empty"
                                               : document.Error()
                                                   ? "not well-formed XML: " + cause(document)
                                                   : "has no element");
    return std::nullopt;
  }
  XmlElement out = copy_of(*root, file, 0, log);
  if (!log.ok()) return std::nullopt;
  return out;
}

std::optional<XmlElement> read_xml(const fs::path& path, RobotLog& log) {
  const RobotPlace at{std::make_shared<const std::string>(path.string()), 0};
  std::error_code error;
  if (!fs::is_regular_file(path, error)) {
    log.fault(at, "there is no such file");
    return std::nullopt;
  }
  if (fs::file_size(path, error) > max_bytes) {
    log.fault(at, fmt::format("has more than {} bytes", max_bytes));
    return std::nullopt;
  }
  std::ifstream in(path, std::ios::binary);
  std::ostringstream content;
  content << in.rdbuf();
  std::string text = std::move(content).str();
  if (!in) {
    log.fault(at, text.empty() ? "is empty or cannot be read" : "cannot be read");
    return std::nullopt;
  }
  if (text.starts_with("\x1f\x8b")) {
    text = unpacked(text, at, log);
    if (!log.ok()) return std::nullopt;
  }
  return parse_xml(text, path.string(), log);
}

}  // namespace tumble
