// Three-way merges of texts. Reference: changes made to the base by the test itself, at places of
// which it knows whether they meet.
#include "engine/scene/saving/merge_texts.hpp"

#include "engine/core/random.hpp"
#include "engine/scene/saving/changed_lines.hpp"
#include "tests/support/scale.hpp"

#include <string>
#include <vector>

#include <doctest/doctest.h>
#include <fmt/format.h>

using namespace tumble;

namespace {

/// Lines by place; a place may be empty or have several, where something was removed or added.
std::string text_of(const std::vector<std::string>& places) {
  std::string out;
  for (const std::string& lines : places) out += lines;
  return out;
}

std::string changed(Random& r, const std::string& line, char who) {
  const uint64_t kind = r.below(3);
  if (kind == 0) return {};
  const std::string added = fmt::format("{} {}\n", who, r.below(1000000));
  return kind == 1 ? added : line + added;
}

}  // namespace

TEST_CASE("merge: changes of both at different places are all there, whatever they are") {
  Random r(4711);
  for (int n = 0; n < test::scaled_count(2000); ++n) {
    std::vector<std::string> base;
    const uint64_t lines = 3 + r.below(40);
    for (uint64_t i = 0; i < lines; ++i) base.push_back(fmt::format("line {}\n", i));
    auto ours = base, theirs = base, both = base;
    // A line that nobody touched stands between two changes.
    for (size_t i = r.below(3); i < lines; i += 2 + r.below(4)) {
      std::vector<std::string>& who = r.below(2) ? ours : theirs;
      who[i] = both[i] = changed(r, base[i], &who == &ours ? 'o' : 't');
    }
    const auto merged = merge_texts(text_of(base), text_of(ours), text_of(theirs));
    REQUIRE(merged.has_value());
    CHECK(*merged == text_of(both));
    CHECK(merge_texts(text_of(base), text_of(theirs), text_of(ours)) == merged);
  }
}

TEST_CASE("merge: the same line changed in two ways does not merge, in the same way it does") {
  const std::string base = "a\nb\nc\n";
  CHECK_FALSE(merge_texts(base, "a\nours\nc\n", "a\ntheirs\nc\n"));
  CHECK_FALSE(merge_texts(base, "a\nc\n", "a\ntheirs\nc\n"));
  CHECK_FALSE(merge_texts(base, "a\nb\nours\nc\n", "a\nb\ntheirs\nc\n"));
  // Of lines that follow each other, one is removed here and one is changed there.
  CHECK(merge_texts(base, "a\nc\n", "a\nb\ntheirs\n") == "a\ntheirs\n");
  CHECK(merge_texts(base, "a\nb\ntheirs\n", "a\nc\n") == "a\ntheirs\n");
  CHECK(merge_texts(base, "ours\nb\nc\n", "a\ntheirs\nc\n") == "ours\ntheirs\nc\n");
  // Lines added within what the other has removed.
  CHECK_FALSE(merge_texts(base, "", "a\ntheirs\nb\nc\n"));
  CHECK_FALSE(merge_texts(base, "c\n", "a\ntheirs\nc\n"));
  CHECK(merge_texts(base, "a\nboth\nc\n", "a\nboth\nc\n") == "a\nboth\nc\n");
  CHECK(merge_texts(base, base, "other") == "other");
  CHECK(merge_texts(base, "other\n", base) == "other\n");
  CHECK(merge_texts("", "", "") == "");
  CHECK(merge_texts("", "a\n", "") == "a\n");
  // An end of the last line is as the one has it who changed the text.
  CHECK(merge_texts("a\nb", "a\nb", "a\nc\n") == "a\nc\n");
  CHECK(merge_texts("a\nb\n", "x\nb\n", "a\nb\n") == "x\nb\n");
}

TEST_CASE("changed lines: the old ones of a place come before the new ones") {
  CHECK(changed_lines("a\nb\nc\nd\n", "a\nx\ny\nd\n") ==
        std::vector<std::string>{"- 2: b", "- 3: c", "+ 2: x", "+ 3: y"});
  CHECK(changed_lines("a\nb\n", "a\nb\n").empty());
}
