#pragma once
#include "engine/scene/fault.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tumble {

/// A JSON value that knows its line. Members keep the order of the file.
struct JsonNode {
  enum class Kind : uint8_t { null, boolean, integer, number, string, array, object };
  Kind kind = Kind::null;
  bool boolean = false;
  bool negative = false;   ///< of an integer
  int line = 0;            ///< 1-based; 0: an override of the command line
  double number = 0;       ///< of integers and numbers
  uint64_t magnitude = 0;  ///< of an integer, exact
  std::string string;
  std::vector<JsonNode> items;    ///< of an array, or the values of an object
  std::vector<std::string> keys;  ///< of an object, as many as items

  bool is(Kind k) const { return kind == k; }
  bool is_number() const { return kind == Kind::integer || kind == Kind::number; }
  const JsonNode* find(std::string_view key) const;
  JsonNode* find(std::string_view key);
};

/// "a number", "an object", ...
std::string_view to_string(JsonNode::Kind kind);
/// The value as short text for messages: `-1`, `"abc"`, `an object`.
std::string brief(const JsonNode& node);

struct JsonLimits {
  size_t max_bytes = size_t{16} << 20;
  size_t max_values = 1'000'000;
  int max_depth = 48;
};

/// Parses JSON with comments. Syntax faults, repeated keys, numbers beyond double, too deep
/// nesting and exceeded limits are added to `faults`; after a syntax fault there is no tree.
std::optional<JsonNode> parse_json(std::string_view text, const std::string& file,
                                   FaultList& faults, const JsonLimits& limits = {});

/// One step of a path: a key or an index.
struct PathStep {
  std::string key;
  std::optional<size_t> index;
};
/// "bodies.brick[3].mass" -> bodies, brick, [3], mass; nothing when it is malformed.
std::optional<std::vector<PathStep>> split_path(std::string_view path);

/// Line of the value at `path`, or of the nearest value around it that exists.
int line_of(const JsonNode& root, std::string_view path);

}  // namespace tumble
