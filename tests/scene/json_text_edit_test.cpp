// Reference: texts written by hand, and parse_json() of what comes out.
#include "engine/scene/saving/json_text_edit.hpp"

#include <doctest/doctest.h>

using namespace tumble;

namespace {

JsonTextEdit::Path path(std::string_view text) {
  return *split_path(text);
}

std::string set(std::string text, std::string_view where, std::string_view value) {
  JsonTextEdit edit(std::move(text));
  REQUIRE(edit.set(path(where), value));
  return edit.text();
}

std::string removed(std::string text, std::string_view where) {
  JsonTextEdit edit(std::move(text));
  REQUIRE(edit.remove(path(where)));
  return edit.text();
}

constexpr const char* scene = R"({
  // what it is
  "title": "a } \" {", /* kept */
  "bodies": {
    "ball": { "mass": 2, "at": [0, 1, 2] }, // round
    "box": {
      "mass": 3,
      "list": [ {"a": 1}, { "a": 2 } ] // behind
    }
  }
}
)";

}  // namespace

TEST_CASE("a value is replaced and nothing else") {
  std::string expected = scene;
  expected.replace(expected.find("\"mass\": 2") + 8, 1, "2.5");
  CHECK(set(scene, "bodies.ball.mass", "2.5") == expected);
  expected = scene;
  expected.replace(expected.find("\"a\": 2") + 5, 1, "\"x\"");
  CHECK(set(scene, "bodies.box.list[1].a", "\"x\"") == expected);
  CHECK(*JsonTextEdit(scene).value(path("title")) == R"("a } \" {")");
  CHECK_FALSE(JsonTextEdit(scene).value(path("bodies.cone")));
}

TEST_CASE("a new member is the last, laid out as those before it") {
  CHECK(set("{}", "a.b", "1") == R"({ "a": { "b": 1 } })");
  CHECK(set(R"({"a": 1})", "b", "2") == R"({"a": 1, "b": 2})");
  CHECK(set("{\n  \"a\": 1 // one\n}", "b", "2") == "{\n  \"a\": 1, // one\n  \"b\": 2\n}");
  CHECK(set("{\n  \"a\": 1}", "b", "2") == "{\n  \"a\": 1,\n  \"b\": 2}");
  std::string expected = scene;
  const std::string behind = "// behind";
  expected.insert(expected.find(behind) + behind.size(), "\n      \"look\": { \"x\": 1 }");
  expected.insert(expected.find(" // behind"), ",");
  CHECK(set(scene, "bodies.box.look.x", "1") == expected);
  expected = scene;
  expected.insert(expected.find(" }, // round"), ", \"type\": \"static\"");
  CHECK(set(scene, "bodies.ball.type", "\"static\"") == expected);
  JsonTextEdit edit(scene);
  CHECK_FALSE(edit.set(path("title.x"), "1"));
  CHECK_FALSE(edit.set(path("bodies.box.list[7].a"), "1"));
  CHECK(edit.text() == scene);
}

TEST_CASE("a member goes with its line and its comma") {
  CHECK(removed(R"({"a": 1, "b": 2})", "a") == R"({"b": 2})");
  CHECK(removed(R"({"a": 1, "b": 2})", "b") == R"({"a": 1})");
  CHECK(removed(R"({ "a": 1 })", "a") == "{ }");
  CHECK(removed("{\n  \"a\": 1,\n  \"b\": 2\n}", "b") == "{\n  \"a\": 1\n}");
  CHECK(removed("{\n  \"a\": 1,\n  \"b\": 2\n}", "a") == "{\n  \"b\": 2\n}");
  std::string expected = scene;
  const size_t from = expected.find(",\n      \"list\"");
  expected.erase(from, expected.find(" // behind") - from);
  const std::string left = removed(scene, "bodies.box.list");
  FaultList faults;
  const auto tree = parse_json(left, "x.json", faults);
  REQUIRE(tree.has_value());
  CHECK(tree->find("bodies")->find("box")->keys == std::vector<std::string>{"mass"});
  CHECK(left.find("// behind") != std::string::npos);
  CHECK_FALSE(JsonTextEdit(scene).remove(path("bodies.cone")));
}

TEST_CASE("a key is renamed to any text, and the text stays JSON") {
  JsonTextEdit edit(R"({"a": 1})");
  REQUIRE(edit.rename(path("a"), "b\"c"));
  CHECK(edit.text() == R"({"b\"c": 1})");
}

TEST_CASE("an item changes places with the next one, and takes the comment behind it along") {
  const auto swapped = [](const std::string& text, size_t item) {
    JsonTextEdit edit(text);
    REQUIRE(edit.swap_with_next(at_index(path("list"), item)));
    return edit.text();
  };
  CHECK(swapped(R"({"list": [1,  [2, 3], 4] })", 0) == R"({"list": [[2, 3],  1, 4] })");
  CHECK(swapped(R"({"list": [1, 2, /* last */ 3 ]})", 1) == R"({"list": [1, 3, /* last */ 2 ]})");
  CHECK(swapped("{\"list\": [\n  // three\n  1, // one\n  2\n]}", 0) ==
        "{\"list\": [\n  // three\n  2,\n  1 // one\n]}");
  CHECK(swapped("{\"list\": [\n  1,\n  { \"a\": 2 } // two\n]}", 0) ==
        "{\"list\": [\n  { \"a\": 2 }, // two\n  1\n]}");
  // Behind a comment nothing may follow on its line.
  CHECK(swapped("{\"list\": [1, 2 // two\n]}", 0) == "{\"list\": [2, 1 // two\n]}");
  CHECK(swapped("{\"list\": [1, // one\n 2] }", 0) == "{\"list\": [2, // one\n 1] }");
  JsonTextEdit edit(R"({"list": [1, 2], "a": { "b": 1, "c": 2 }})");
  CHECK_FALSE(edit.swap_with_next(at_index(path("list"), 1)));
  CHECK_FALSE(edit.swap_with_next(at_index(path("a"), 0)));
  CHECK_FALSE(edit.swap_with_next(path("a.b")));
}
