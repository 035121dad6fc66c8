#pragma once
#include "engine/core/result.hpp"
#include "engine/scene/json_tree.hpp"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tumble {

/// The text of a JSON file with comments, edited value by value: everything that is not edited
/// keeps its bytes, including comments, order and layout.
class JsonTextEdit {
 public:
  using Path = std::vector<PathStep>;

  /// `text` must have been parsed by parse_json() without faults.
  explicit JsonTextEdit(std::string text) : text_(std::move(text)) {}

  const std::string& text() const { return text_; }
  /// The text of a value, empty if there is none.
  std::optional<std::string_view> value(const Path& path) const;
  /// Replaces a value, or adds it as the last member of its object; missing objects on the path are
  /// created. False if something on the path is neither object nor array, or an item does not
  /// exist.
  bool set(const Path& path, std::string_view value);
  /// Removes a member of an object or an item of an array, with its line if it has one of its own.
  /// False if there is none.
  bool remove(const Path& path);
  /// Appends an item to an array. False if there is no array.
  bool append(const Path& array, std::string_view value);
  /// Exchanges an item of an array with the one after it, each with the comment that follows it on
  /// its line. False if there is none.
  bool swap_with_next(const Path& item);
  /// Renames the key of a member. False if there is none.
  bool rename(const Path& path, std::string_view key);

 private:
  struct Span {
    size_t begin = 0, end = 0;
  };
  struct Member {
    Span key, value;
    std::string name;
  };
  size_t skip_space(size_t at) const;
  size_t skip_string(size_t at) const;
  size_t skip_value(size_t at) const;
  std::vector<Member> members(Span object) const;
  std::vector<Span> items(Span array) const;
  std::optional<Span> child(Span parent, const PathStep& step) const;
  /// The value at the first `count` steps of a path.
  std::optional<Span> find(const Path& path, size_t count) const;
  /// The comment between an item and the end of its line; where it would stand if there is none.
  Span comment_after(size_t end) const;
  void erase_one(const std::vector<Span>& all, size_t which);
  void add_member(Span object, std::string_view name, std::string_view value);
  size_t line_begin(size_t at) const;
  size_t line_end(size_t at) const;
  bool blank(size_t begin, size_t end) const;

  std::string text_;
};

inline JsonTextEdit::Path operator/(JsonTextEdit::Path path, std::string_view key) {
  path.push_back({std::string(key), {}});
  return path;
}
inline JsonTextEdit::Path at_index(JsonTextEdit::Path path, size_t index) {
  path.push_back({{}, index});
  return path;
}

}  // namespace tumble
