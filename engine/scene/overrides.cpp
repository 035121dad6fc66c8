#include "engine/scene/overrides.hpp"

#include "engine/core/text.hpp"
#include "engine/scene/description/material.hpp"

namespace tumble {
namespace {

using Kind = JsonNode::Kind;

JsonNode make_object() {
  JsonNode n;
  n.kind = Kind::object;
  return n;
}

JsonNode make_string(std::string text) {
  JsonNode n;
  n.kind = Kind::string;
  n.string = std::move(text);
  return n;
}

void set_lines_zero(JsonNode& node) {
  node.line = 0;
  for (JsonNode& item : node.items) set_lines_zero(item);
}

JsonNode parse_value(std::string_view text) {
  FaultList ignored;
  auto parsed = parse_json(text, {}, ignored);
  JsonNode value = parsed ? std::move(*parsed) : make_string(std::string(text));
  set_lines_zero(value);
  return value;
}

bool is_one_of(std::string_view word, std::initializer_list<std::string_view> list) {
  for (const auto w : list)
    if (w == word) return true;
  return false;
}

/// The key that a bare value at these path steps stands for.
std::string_view shorthand_of(const std::vector<PathStep>& steps, size_t i) {
  if (steps[i].key == "material" || (i == 1 && steps[0].key == "materials")) return "like";
  if (i == 1 && (steps[0].key == "meshes" || steps[0].key == "robots")) return "file";
  if (i == 1 && steps[0].key == "parameters") return "value";
  return {};
}

/// Follows a path and creates what is missing on it.
class Walk {
 public:
  Walk(JsonNode& root, std::vector<PathStep> steps) : node_(&root), steps_(std::move(steps)) {}

  /// The node to be assigned, or null with `message` set.
  JsonNode* run() {
    rewrite_copies();
    for (size_t i = 0; i < steps_.size(); ++i)
      if (!descend(i)) return nullptr;
    // "parameters.n=3" keeps the limits and the doc of an {"value": ...} declaration.
    if (steps_.size() == 2 && steps_[0].key == "parameters" && node_->is(Kind::object))
      if (JsonNode* value = node_->find("value")) return value;
    return node_;
  }
  const std::string& message() const { return message_; }

 private:
  /// bodies.brick[3].mass is stored as bodies.brick.copies.3.mass.
  void rewrite_copies() {
    if (steps_.size() < 3 || steps_[0].key != "bodies" || !steps_[2].index) return;
    const size_t index = *steps_[2].index;
    steps_[2] = {std::to_string(index), std::nullopt};
    steps_.insert(steps_.begin() + 2, PathStep{"copies", std::nullopt});
  }

  bool descend(size_t i) {
    const PathStep& step = steps_[i];
    if (step.index) return element(*step.index);
    if (node_->is(Kind::array) && node_->items.size() == 3 && step.key.size() == 1 &&
        step.key[0] >= 'x' && step.key[0] <= 'z')
      return element(size_t(step.key[0] - 'x'));
    if (!node_->is(Kind::object) && !become_object(i)) return false;
    if (JsonNode* next = node_->find(step.key)) {
      node_ = next;
      return true;
    }
    return create(i);
  }

  bool element(size_t index) {
    if (node_->is(Kind::object) && index == 0) return true;  // a single value for a list
    if (!node_->is(Kind::array) || index >= node_->items.size()) {
      message_ = node_->is(Kind::array) ? "index " + std::to_string(index) + " of an array of " +
                                              std::to_string(node_->items.size())
                                        : "has no elements; give the whole value";
      return false;
    }
    node_ = &node_->items[index];
    return true;
  }

  bool become_object(size_t i) {
    const std::string_view key = i > 0 ? shorthand_of(steps_, i - 1) : std::string_view{};
    if (key.empty() || node_->is(Kind::array)) {
      message_ = "'" + steps_[i].key + "' is not a part of " + brief(*node_);
      return false;
    }
    JsonNode object = make_object();
    object.line = node_->line;
    object.keys.emplace_back(key);
    object.items.push_back(std::move(*node_));
    *node_ = std::move(object);
    return true;
  }

  bool create(size_t i) {
    const std::string& key = steps_[i].key;
    const bool named =
        i == 1 && is_one_of(steps_[0].key, {"bodies", "materials", "meshes", "joints", "forces",
                                            "particles", "cameras", "parameters", "robots"});
    JsonNode made = i + 1 < steps_.size() ? make_object() : JsonNode{};
    if (named) {
      bool built_in = false;
      if (steps_[0].key == "materials")
        for (const auto& [name, material] : built_in_materials()) built_in |= name == key;
      if (!built_in) {
        message_ = unknown_name("name", key, node_->keys) + " (in " + steps_[0].key + ")";
        return false;
      }
      made.keys.emplace_back("like");
      made.items.push_back(make_string(key));
    }
    node_->keys.push_back(key);
    node_->items.push_back(std::move(made));
    node_ = &node_->items.back();
    return true;
  }

  JsonNode* node_;
  std::vector<PathStep> steps_;
  std::string message_;
};

}  // namespace

void apply_override(JsonNode& root, const std::string& assignment, FaultList& faults) {
  const size_t equals = assignment.find('=');
  const std::string path = assignment.substr(0, equals);
  const auto steps = split_path(path);
  if (equals == std::string::npos || !steps) {
    faults.add({"--set", 0, {}, "'" + assignment + "' is not of the form path=value"});
    return;
  }
  Walk walk(root, *steps);
  JsonNode* target = walk.run();
  if (!target) {
    faults.add({"--set", 0, path, walk.message()});
    return;
  }
  *target = parse_value(std::string_view(assignment).substr(equals + 1));
}

}  // namespace tumble
