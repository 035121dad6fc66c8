#include "engine/scene/saving/merge_texts.hpp"

#include "engine/scene/saving/common_lines.hpp"

#include <algorithm>
#include <span>

namespace tumble {
namespace {

using Lines = std::vector<std::string_view>;

/// What a text has instead of some lines of the base that follow each other.
struct Change {
  size_t begin = 0, end = 0;                ///< the lines of the base; equal: lines are added
  std::span<const std::string_view> lines;  ///< in their place

  bool operator==(const Change& other) const {
    return begin == other.begin && end == other.end && std::ranges::equal(lines, other.lines);
  }
};

std::vector<Change> changes(const Lines& base, const Lines& changed) {
  std::vector<CommonLine> shared = common_lines(base, changed);
  shared.push_back({base.size(), changed.size()});
  std::vector<Change> out;
  size_t i = 0, j = 0;
  for (const CommonLine& line : shared) {
    if (i < line.a || j < line.b)
      out.push_back({i, line.a, std::span(changed).subspan(j, line.b - j)});
    i = line.a + 1, j = line.b + 1;
  }
  return out;
}

/// Whether two changes are to the same lines, or add lines at the same place.
bool meet(const Change& a, const Change& b) {
  if (a.begin == b.begin)
    return (!a.lines.empty() && !b.lines.empty()) || (a.end > a.begin && b.end > b.begin);
  const Change &first = a.begin < b.begin ? a : b, &second = a.begin < b.begin ? b : a;
  return second.begin < first.end;
}

}  // namespace

std::optional<std::string> merge_texts(const std::string& base, const std::string& ours,
                                       const std::string& theirs) {
  const Lines b = lines_of_text(base), o = lines_of_text(ours), t = lines_of_text(theirs);
  std::vector<Change> all = changes(b, o);
  for (const Change& other : changes(b, t)) {
    if (std::ranges::find(all, other) != all.end()) continue;
    for (const Change& own : all)
      if (meet(own, other)) return std::nullopt;
    all.push_back(other);
  }
  // What only adds comes before what replaces the line there.
  std::ranges::sort(all, {}, [](const Change& c) { return std::pair(c.begin, c.end); });
  std::string out;
  const auto put = [&](std::span<const std::string_view> lines) {
    for (const std::string_view line : lines) out.append(line).append("\n");
  };
  size_t done = 0;
  for (const Change& c : all) {
    put(std::span(b).subspan(done, c.begin - done));
    put(c.lines);
    done = c.end;
  }
  put(std::span(b).subspan(done));
  const std::string& last = theirs == base ? ours : theirs;
  if (!out.empty() && !last.ends_with('\n')) out.pop_back();
  return out;
}

}  // namespace tumble
