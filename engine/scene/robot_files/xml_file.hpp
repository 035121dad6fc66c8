#pragma once
#include "engine/scene/robot_files/robot_log.hpp"

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tumble {

/// An element of an XML file.
struct XmlElement {
  std::string name;
  RobotPlace at;
  std::vector<std::pair<std::string, std::string>> attributes;
  std::vector<XmlElement> children;

  const XmlElement* find(std::string_view child) const;
};

/// The root element of an XML file, which may be compressed by gzip. Faults: it cannot be read or
/// decompressed, is too large, or is not well-formed XML (with the line).
std::optional<XmlElement> read_xml(const std::filesystem::path& file, RobotLog& log);
/// The same for a text in memory; `name` is the file's name in faults.
std::optional<XmlElement> parse_xml(const std::string& text, const std::string& name,
                                    RobotLog& log);

}  // namespace tumble
