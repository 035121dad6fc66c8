#include "engine/scene/visitors/json_text.hpp"

#include <nlohmann/json.hpp>

namespace tumble {
namespace {

using Json = nlohmann::ordered_json;

/// Appends a value on one line, with spaces after commas and colons.
void one_line(const Json& value, std::string& out) {
  if (!value.is_structured() || value.empty()) {
    out += value.dump(-1, ' ', false, Json::error_handler_t::replace);
    return;
  }
  out += value.is_array() ? "[" : "{ ";
  bool first = true;
  for (const auto& item : value.items()) {
    if (!first) out += ", ";
    first = false;
    if (value.is_object()) out += Json(item.key()).dump() + ": ";
    one_line(item.value(), out);
  }
  out += value.is_array() ? "]" : " }";
}

void indented(const Json& value, size_t indent, size_t used, std::string& out) {
  constexpr size_t width = 100;
  std::string line;
  one_line(value, line);
  if (!value.is_structured() || value.empty() || used + line.size() <= width) {
    out += line;
    return;
  }
  const bool array = value.is_array();
  const std::string margin(indent + 2, ' ');
  out += array ? "[\n" : "{\n";
  size_t left = value.size();
  for (const auto& item : value.items()) {
    const std::string key = array ? std::string() : Json(item.key()).dump() + ": ";
    out += margin + key;
    indented(item.value(), indent + 2, margin.size() + key.size() + 1, out);
    out += --left > 0 ? ",\n" : "\n";
  }
  out += std::string(indent, ' ') + (array ? "]" : "}");
}

}  // namespace

std::string pretty(const Json& value) {
  std::string out;
  indented(value, 0, 0, out);
  return out + "\n";
}

}  // namespace tumble
