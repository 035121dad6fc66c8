#include "engine/scene/json_tree.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace tumble {
namespace {

/// The parser's position in the text.
struct Progress {
  int line = 1;
  bool last_was_newline = false;
};

/// Input iterator that counts the lines it passes: nlohmann-json keeps no positions, but calls its
/// handler right after the last character of each token.
class CountingIterator {
 public:
  using iterator_category = std::input_iterator_tag;
  using value_type = char;
  using difference_type = std::ptrdiff_t;
  using pointer = const char*;
  using reference = const char&;

  CountingIterator(const char* at, Progress* progress) : at_(at), progress_(progress) {}
  reference operator*() const { return *at_; }
  CountingIterator& operator++() {
    progress_->last_was_newline = *at_ == '\n';
    progress_->line += progress_->last_was_newline ? 1 : 0;
    ++at_;
    return *this;
  }
  CountingIterator operator++(int) {
    CountingIterator old = *this;
    ++*this;
    return old;
  }
  friend bool operator==(const CountingIterator& a, const CountingIterator& b) {
    return a.at_ == b.at_;
  }

 private:
  const char* at_;
  Progress* progress_;
};

/// The parser's message without its technical parts: of "[json.exception.parse_error.101] parse
/// error at line 1, column 2: syntax error while parsing object - unexpected X; expected Y" only
/// the last part is kept.
std::string plain_message(std::string_view what) {
  if (const size_t at = what.find("] "); at != std::string_view::npos) what.remove_prefix(at + 2);
  if (what.starts_with("parse error"))
    if (const size_t at = what.find(": "); at != std::string_view::npos) what.remove_prefix(at + 2);
  if (what.starts_with("syntax error"))
    if (const size_t at = what.find(" - "); at != std::string_view::npos)
      what.remove_prefix(at + 3);
  std::string text = "not valid JSON: " + std::string(what);
  if (const size_t at = text.find("; expected "); at != std::string::npos)
    text.replace(at, 2, ", ");
  if (const size_t at = text.find("; last read: "); at != std::string::npos)
    text.replace(at, 13, ", after ");
  return text;
}

/// Builds the tree from the parser's events.
class JsonTreeBuilder {
 public:
  using json = nlohmann::json;

  JsonTreeBuilder(const std::string& file, Progress& progress, FaultList& faults,
                  const JsonLimits& limits)
      : file_(file), progress_(progress), faults_(faults), limits_(limits) {}

  JsonNode take() { return std::move(root_); }

  bool null() { return scalar({}, false); }
  bool boolean(bool value) {
    JsonNode n;
    n.kind = JsonNode::Kind::boolean;
    n.boolean = value;
    return scalar(std::move(n), false);
  }
  bool number_integer(json::number_integer_t value) {
    JsonNode n;
    n.kind = JsonNode::Kind::integer;
    n.negative = value < 0;
    n.magnitude = value < 0 ? uint64_t{0} - uint64_t(value) : uint64_t(value);
    n.number = double(value);
    return scalar(std::move(n), true);
  }
  bool number_unsigned(json::number_unsigned_t value) {
    JsonNode n;
    n.kind = JsonNode::Kind::integer;
    n.magnitude = value;
    n.number = double(value);
    return scalar(std::move(n), true);
  }
  bool number_float(json::number_float_t value, const std::string&) {
    JsonNode n;
    n.kind = JsonNode::Kind::number;
    n.number = value;
    return scalar(std::move(n), true);
  }
  bool string(std::string& value) {
    JsonNode n;
    n.kind = JsonNode::Kind::string;
    n.string = std::move(value);
    return scalar(std::move(n), false);
  }
  bool binary(json::binary_t&) { return false; }  // occurs only in binary formats
  bool start_object(std::size_t) { return open(JsonNode::Kind::object); }
  bool start_array(std::size_t) { return open(JsonNode::Kind::array); }
  bool end_object() { return close(); }
  bool end_array() { return close(); }
  bool key(std::string& value) {
    JsonNode& object = *stack_.back();
    // Only up to this size, since a quadratic search would take too long for a file of garbage.
    if (object.keys.size() < 20000 && object.find(value))
      fault("the key '" + value + "' is given twice in one object", token_line(false));
    object.keys.push_back(std::move(value));
    return true;
  }
  bool parse_error(std::size_t, const std::string&, const nlohmann::detail::exception& error) {
    fault(plain_message(error.what()), progress_.line);
    return false;
  }

 private:
  /// The parser recognises the end of a number at the character after it, which may be a line
  /// break.
  int token_line(bool number) const {
    return progress_.line - (number && progress_.last_was_newline ? 1 : 0);
  }
  void fault(std::string message, int line) { faults_.add({file_, line, {}, std::move(message)}); }

  JsonNode* add(JsonNode node) {
    if (++values_ > limits_.max_values) {
      fault(fmt::format("more than {} values in one file", limits_.max_values), progress_.line);
      return nullptr;
    }
    if (stack_.empty()) {
      root_ = std::move(node);
      return &root_;
    }
    stack_.back()->items.push_back(std::move(node));
    return &stack_.back()->items.back();
  }
  bool scalar(JsonNode node, bool number) {
    node.line = token_line(number);
    return add(std::move(node)) != nullptr;
  }
  bool open(JsonNode::Kind kind) {
    if (int(stack_.size()) >= limits_.max_depth) {
      fault(fmt::format("nested deeper than {} levels", limits_.max_depth), progress_.line);
      return false;
    }
    JsonNode node;
    node.kind = kind;
    node.line = progress_.line;
    JsonNode* added = add(std::move(node));
    if (added) stack_.push_back(added);
    return added != nullptr;
  }
  bool close() {
    stack_.pop_back();
    return true;
  }

  const std::string& file_;
  Progress& progress_;
  FaultList& faults_;
  const JsonLimits& limits_;
  JsonNode root_;
  std::vector<JsonNode*> stack_;  ///< open nodes; the last item of each is the next one
  size_t values_ = 0;
};

}  // namespace

const JsonNode* JsonNode::find(std::string_view key) const {
  for (size_t i = 0; i < keys.size() && i < items.size(); ++i)
    if (keys[i] == key) return &items[i];
  return nullptr;
}

JsonNode* JsonNode::find(std::string_view key) {
  return const_cast<JsonNode*>(static_cast<const JsonNode*>(this)->find(key));
}

std::string_view to_string(JsonNode::Kind kind) {
  switch (kind) {
    case JsonNode::Kind::null:
      return "null";
    case JsonNode::Kind::boolean:
      return "true or false";
    case JsonNode::Kind::integer:
    case JsonNode::Kind::number:
      return "a number";
    case JsonNode::Kind::string:
      return "a string";
    case JsonNode::Kind::array:
      return "an array";
    case JsonNode::Kind::object:
      return "an object";
  }
  return "a value";
}

std::string brief(const JsonNode& node) {
  switch (node.kind) {
    case JsonNode::Kind::boolean:
      return node.boolean ? "true" : "false";
    case JsonNode::Kind::integer:
      return (node.negative ? "-" : "") + std::to_string(node.magnitude);
    case JsonNode::Kind::number:
      return fmt::format("{:.6g}", node.number);
    case JsonNode::Kind::string:
      return "\"" + (node.string.size() > 40 ? node.string.substr(0, 37) + "..." : node.string) +
             "\"";
    case JsonNode::Kind::array:
      return fmt::format("an array of {}", node.items.size());
    default:
      return std::string(to_string(node.kind));
  }
}

std::optional<JsonNode> parse_json(std::string_view text, const std::string& file,
                                   FaultList& faults, const JsonLimits& limits) {
  if (text.size() > limits.max_bytes) {
    faults.add(
        {file,
         0,
         {},
         fmt::format("the file has {} bytes; at most {} are read", text.size(), limits.max_bytes)});
    return std::nullopt;
  }
  if (text.find_first_not_of(" \t\r\n") == std::string_view::npos) {
    faults.add({file, 1, {}, "the file is empty"});
    return std::nullopt;
  }
  Progress progress;
  JsonTreeBuilder builder(file, progress, faults, limits);
  const CountingIterator first(text.data(), &progress);
  const CountingIterator last(text.data() + text.size(), &progress);
  const bool ok = nlohmann::json::sax_parse(first, last, &builder,
                                            nlohmann::json::input_format_t::json, true, true);
  if (!ok) return std::nullopt;
  return builder.take();
}

std::optional<std::vector<PathStep>> split_path(std::string_view path) {
  std::vector<PathStep> steps;
  size_t i = 0;
  while (i < path.size()) {
    if (path[i] == '[') {
      size_t index = 0, digits = 0;
      for (++i; i < path.size() && path[i] >= '0' && path[i] <= '9' && digits < 9; ++i, ++digits)
        index = index * 10 + size_t(path[i] - '0');
      if (digits == 0 || i >= path.size() || path[i] != ']' || steps.empty()) return std::nullopt;
      ++i;
      steps.push_back({{}, index});
      if (i < path.size() && path[i] == '.') {
        if (++i == path.size()) return std::nullopt;
      } else if (i < path.size() && path[i] != '[') {
        return std::nullopt;
      }
      continue;
    }
    const size_t end = std::min(path.find_first_of(".[", i), path.size());
    if (end == i) return std::nullopt;
    steps.push_back({std::string(path.substr(i, end - i)), std::nullopt});
    i = end;
    if (i < path.size() && path[i] == '.' && ++i == path.size()) return std::nullopt;
  }
  if (steps.empty()) return std::nullopt;
  return steps;
}

int line_of(const JsonNode& root, std::string_view path) {
  const JsonNode* node = &root;
  const auto steps = split_path(path);
  if (!steps) return root.line;
  for (const PathStep& step : *steps) {
    const JsonNode* next = nullptr;
    if (!step.index) {
      next = node->find(step.key);
    } else if (node->is(JsonNode::Kind::array)) {
      next = *step.index < node->items.size() ? &node->items[*step.index] : nullptr;
    } else if (*step.index == 0) {
      next = node;  // a single value where a list is allowed
    }
    if (!next) break;
    node = next;
  }
  return node->line;
}

}  // namespace tumble
