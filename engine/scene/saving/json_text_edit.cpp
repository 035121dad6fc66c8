#include "engine/scene/saving/json_text_edit.hpp"

#include "engine/core/text.hpp"

#include <algorithm>
#include <array>

#include <nlohmann/json.hpp>

namespace tumble {
namespace {

constexpr std::string_view spaces = " \t\r\n";

std::string json_quoted(std::string_view text) {
  return nlohmann::json(std::string(text)).dump();
}

}  // namespace

/// The position after spaces and comments.
size_t JsonTextEdit::skip_space(size_t at) const {
  const std::string_view text = text_;
  for (;;) {
    at = std::min(text.find_first_not_of(spaces, at), text.size());
    if (text.substr(at, 2) == "//") {
      at = std::min(text.find('\n', at), text.size());
    } else if (text.substr(at, 2) == "/*") {
      const size_t end = text.find("*/", at + 2);
      at = end == text.npos ? text.size() : end + 2;
    } else {
      return at;
    }
  }
}

size_t JsonTextEdit::skip_string(size_t at) const {
  for (++at; at < text_.size() && text_[at] != '"'; ++at)
    if (text_[at] == '\\') ++at;
  return at + 1;
}

/// The position after the value that begins at `at`.
size_t JsonTextEdit::skip_value(size_t at) const {
  if (text_[at] == '"') return skip_string(at);
  if (text_[at] != '{' && text_[at] != '[')
    return std::min(text_.find_first_of(" \t\r\n,]}/", at), text_.size());
  int depth = 0;
  for (; at < text_.size(); at = skip_space(at)) {
    const char c = text_[at];
    if (c == '"') {
      at = skip_string(at);
      continue;
    }
    depth += c == '{' || c == '[' ? 1 : c == '}' || c == ']' ? -1 : 0;
    ++at;
    if (depth == 0) return at;
  }
  return text_.size();
}

std::vector<JsonTextEdit::Member> JsonTextEdit::members(Span object) const {
  std::vector<Member> out;
  for (size_t at = skip_space(object.begin + 1); at < object.end && text_[at] == '"';) {
    Member m;
    m.key = {at, skip_string(at)};
    m.name = nlohmann::json::parse(text_.substr(m.key.begin, m.key.end - m.key.begin));
    m.value.begin = skip_space(skip_space(m.key.end) + 1);  // after the colon
    m.value.end = skip_value(m.value.begin);
    at = skip_space(m.value.end);
    if (at < object.end && text_[at] == ',') at = skip_space(at + 1);
    out.push_back(std::move(m));
  }
  return out;
}

std::vector<JsonTextEdit::Span> JsonTextEdit::items(Span array) const {
  std::vector<Span> out;
  for (size_t at = skip_space(array.begin + 1); at + 1 < array.end;) {
    out.push_back({at, skip_value(at)});
    at = skip_space(out.back().end);
    if (at < array.end && text_[at] == ',') at = skip_space(at + 1);
  }
  return out;
}

std::optional<JsonTextEdit::Span> JsonTextEdit::child(Span parent, const PathStep& step) const {
  if (step.index) {
    if (text_[parent.begin] != '[') return std::nullopt;
    const auto all = items(parent);
    return *step.index < all.size() ? std::optional(all[*step.index]) : std::nullopt;
  }
  if (text_[parent.begin] != '{') return std::nullopt;
  for (const Member& m : members(parent))
    if (m.name == step.key) return m.value;
  return std::nullopt;
}

std::optional<JsonTextEdit::Span> JsonTextEdit::find(const Path& path, size_t count) const {
  const size_t begin = skip_space(0);
  std::optional<Span> at = Span{begin, skip_value(begin)};
  for (size_t i = 0; i < count && at; ++i) at = child(*at, path[i]);
  return at;
}

std::optional<std::string_view> JsonTextEdit::value(const Path& path) const {
  const auto at = find(path, path.size());
  if (!at) return std::nullopt;
  return std::string_view(text_).substr(at->begin, at->end - at->begin);
}

bool JsonTextEdit::set(const Path& path, std::string_view value) {
  if (const auto at = find(path, path.size())) {
    text_.replace(at->begin, at->end - at->begin, value);
    return true;
  }
  size_t known = path.size() - 1;
  while (!find(path, known)) --known;
  const Span parent = *find(path, known);
  if (text_[parent.begin] != '{') return false;
  std::string nested(value);
  for (size_t i = path.size() - 1; i > known; --i) {
    if (path[i].index) return false;
    nested = "{ " + json_quoted(path[i].key) + ": " + nested + " }";
  }
  if (path[known].index) return false;
  add_member(parent, path[known].key, nested);
  return true;
}

size_t JsonTextEdit::line_begin(size_t at) const {
  const size_t end = at == 0 ? std::string::npos : text_.rfind('\n', at - 1);
  return end == std::string::npos ? 0 : end + 1;
}

size_t JsonTextEdit::line_end(size_t at) const {
  return std::min(text_.find('\n', at), text_.size());
}

bool JsonTextEdit::blank(size_t begin, size_t end) const {
  return std::string_view(text_).substr(begin, end - begin).find_first_not_of(spaces) ==
         std::string_view::npos;
}

/// On a line of its own if the last member begins one, with the same indentation.
void JsonTextEdit::add_member(Span object, std::string_view name, std::string_view value) {
  const std::string member = json_quoted(name) + ": " + std::string(value);
  const auto all = members(object);
  if (all.empty()) {
    text_.replace(object.begin, object.end - object.begin, "{ " + member + " }");
    return;
  }
  const Member& last = all.back();
  const size_t line = line_begin(last.key.begin);
  const bool own_line = blank(line, last.key.begin);
  const size_t next = skip_space(last.value.end);
  const bool comma = text_[next] == ',';  // a trailing comma, which some writers add
  if (!own_line) {
    text_.insert(comma ? next + 1 : last.value.end, (comma ? " " : ", ") + member);
    return;
  }
  const std::string indent = text_.substr(line, last.key.begin - line);
  // A comment after the last member stays with it, if the line ends before the object does.
  size_t at = line_end(comma ? next : last.value.end);
  if (at >= object.end) at = comma ? next + 1 : last.value.end;
  text_.insert(at, "\n" + indent + member);
  if (!comma) text_.insert(last.value.end, ",");
}

bool JsonTextEdit::append(const Path& array, std::string_view value) {
  const auto around = find(array, array.size());
  if (!around || text_[around->begin] != '[') return false;
  const std::vector<Span> all = items(*around);
  const std::string item(value);
  if (all.empty()) {
    text_.replace(around->begin, around->end - around->begin, "[" + item + "]");
    return true;
  }
  const Span last = all.back();
  const size_t line = line_begin(last.begin);
  const std::string between =
      blank(line, last.begin) ? ",\n" + text_.substr(line, last.begin - line) : ", ";
  const size_t next = skip_space(last.end);
  if (text_[next] == ',') text_.erase(next, 1);  // a trailing comma, which some writers add
  text_.insert(last.end, between + item);
  return true;
}

JsonTextEdit::Span JsonTextEdit::comment_after(size_t end) const {
  const size_t next = skip_space(end);
  const size_t comma = text_[next] == ',' ? next + 1 : end;
  size_t to = line_end(comma);
  if (to > comma && text_[to - 1] == '\r') --to;  // ends the line, not the comment
  const size_t begin = std::min(text_.find_first_not_of(" \t", comma), to);
  const bool comment = text_.compare(begin, 2, "//") == 0;
  return comment ? Span{comma, to} : Span{comma, comma};
}

bool JsonTextEdit::swap_with_next(const Path& item) {
  if (item.empty() || !item.back().index) return false;
  const auto around = find(item, item.size() - 1);
  if (!around || text_[around->begin] != '[') return false;
  const std::vector<Span> all = items(*around);
  const size_t which = *item.back().index;
  if (which + 1 >= all.size()) return false;
  std::array<Span, 4> parts = {all[which], comment_after(all[which].end), all[which + 1],
                               comment_after(all[which + 1].end)};
  // A comment would hide what follows it on a line, and stays where not both items end theirs.
  const auto ends_line = [&](const Span& s) { return blank(s.end, line_end(s.end)); };
  if (!ends_line(parts[1]) || !ends_line(parts[3]))
    for (const size_t k : {size_t{1}, size_t{3}}) parts[k].end = parts[k].begin;
  const auto text = [&](size_t k) {
    return text_.substr(parts[k].begin, parts[k].end - parts[k].begin);
  };
  const std::array<std::string, 4> instead = {text(2), text(3), text(0), text(1)};
  for (size_t k = 4; k-- > 0;)
    text_.replace(parts[k].begin, parts[k].end - parts[k].begin, instead[k]);
  return true;
}

bool JsonTextEdit::rename(const Path& path, std::string_view key) {
  if (path.empty() || path.back().index) return false;
  const auto around = find(path, path.size() - 1);
  if (!around || text_[around->begin] != '{') return false;
  for (const Member& member : members(*around)) {
    if (member.name != path.back().key) continue;
    text_.replace(member.key.begin, member.key.end - member.key.begin, json_quoted(key));
    return true;
  }
  return false;
}

bool JsonTextEdit::remove(const Path& path) {
  if (path.empty()) return false;
  const auto around = find(path, path.size() - 1);
  if (!around) return false;
  std::vector<Span> all;
  size_t which = size_t(-1);
  if (path.back().index && text_[around->begin] == '[') {
    all = items(*around);
    which = *path.back().index;
  } else if (!path.back().index && text_[around->begin] == '{') {
    for (const Member& member : members(*around)) {
      if (member.name == path.back().key) which = all.size();
      all.push_back({member.key.begin, member.value.end});
    }
  }
  if (which >= all.size()) return false;
  erase_one(all, which);
  return true;
}

/// Removes one of the members or items of a value, with its comma, and with its line if it has one
/// of its own.
void JsonTextEdit::erase_one(const std::vector<Span>& all, size_t which) {
  auto [begin, end] = all[which];
  const size_t next = skip_space(end);
  const bool last = which + 1 == all.size();
  if (text_[next] == ',') end = next + 1;
  const size_t from = line_begin(begin), to = line_end(end);
  if (blank(from, begin) && blank(end, to)) {
    begin = from;
    end = std::min(to + 1, text_.size());
  } else if (!last) {
    end = std::min(text_.find_first_not_of(" \t", end), text_.size());
  } else {
    while (begin > 0 && (text_[begin - 1] == ' ' || text_[begin - 1] == '\t')) --begin;
  }
  text_.erase(begin, end - begin);
  // The item before it becomes the last one, and loses its comma.
  if (last && which > 0 && text_[skip_space(all[which - 1].end)] == ',')
    text_.erase(skip_space(all[which - 1].end), 1);
}

}  // namespace tumble
