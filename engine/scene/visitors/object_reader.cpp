#include "engine/scene/visitors/object_reader.hpp"

#include "engine/core/text.hpp"

#include <algorithm>

namespace tumble {

std::string ObjectReader::at(std::string_view key) const {
  if (!shorthand_.empty()) return path_;
  return path_.empty() ? std::string(key) : path_ + "." + std::string(key);
}

const JsonNode* ObjectReader::take(const Parameter& p) {
  known_.emplace_back(p.name);
  if (!shorthand_.empty()) return p.name == shorthand_ ? &node_ : nullptr;
  const JsonNode* found = node_.find(p.name);
  if (!found && p.required)
    c_.fault(node_, path_, "the key '" + std::string(p.name) + "' is missing");
  return found;
}

void ObjectReader::check_name(const JsonNode& node, const std::string& path,
                              const std::string& name, bool number) {
  const auto digit = [](char c) { return c >= '0' && c <= '9'; };
  const auto letter = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
  };
  if (number) {
    if (name.empty() || name.size() > 9 || !std::all_of(name.begin(), name.end(), digit))
      c_.fault(node, path, "'" + name + "' is not the number of a copy");
    return;
  }
  const bool good =
      !name.empty() && letter(name[0]) && name.size() <= 64 &&
      std::all_of(name.begin(), name.end(), [&](char c) { return letter(c) || digit(c); });
  if (!good)
    c_.fault(node, path,
             "'" + name + "' is not a name: letters, digits and _, not starting with a digit");
}

void ObjectReader::finish() {
  if (lenient_ || !shorthand_.empty()) return;
  for (size_t i = 0; i < node_.keys.size() && i < node_.items.size(); ++i) {
    const std::string& key = node_.keys[i];
    if (std::find(known_.begin(), known_.end(), key) != known_.end()) continue;
    if (path_.empty() && key == "$schema") continue;
    c_.fault(node_.items[i], at(key), unknown_name("key", key, known_));
  }
}

}  // namespace tumble
