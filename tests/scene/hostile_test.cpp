// Damaged files: cut at every byte, bytes changed at random, keys and values swapped. The reference
// is the promise itself: a description or faults, never a crash, a hang or an exception; run under
// the address and undefined-behaviour checks by the gate.
#include "engine/core/random.hpp"
#include "engine/scene/writer.hpp"
#include "tests/scene/scene_text.hpp"

using namespace tumble;

namespace {

/// Reads; what reads well must also be writable.
bool survives(const std::string& text) {
  const SceneRead read = read_scene(text, "x.json");
  if (read.ok()) return !write_scene(read.scene).empty();
  for (const Fault& f : read.faults)
    if (f.message.empty() || f.text().empty()) return false;
  return true;
}

}  // namespace

TEST_CASE("cut at every byte") {
  const std::string text = file_text(data_file("everything.json"));
  REQUIRE(text.size() > 3000);
  const size_t step = size_t(std::max(1, 1000 / scaled_count(1000)));
  for (size_t n = 0; n < text.size(); n += step) {
    const SceneRead read = read_scene(std::string_view(text).substr(0, n), "x.json");
    // Only the whole object is a scene; its last byte but one is the closing brace.
    if (n + 2 <= text.size()) CHECK_FALSE(read.ok());
  }
}

TEST_CASE("random damage") {
  const std::string text = file_text(data_file("everything.json"));
  const std::string bytes = "{}[],:\"0123456789-+.eE$=/*\\ntrufalse \n\x80\xff";
  Random random(11);
  int read_well = 0, faulty = 0;
  const int count = scaled_count(10000);
  for (int i = 0; i < count; ++i) {
    std::string damaged = text;
    const uint32_t changes = 1 + random.below(4);
    for (uint32_t k = 0; k < changes; ++k) {
      const uint32_t at = random.below(uint32_t(damaged.size()));
      const uint32_t kind = random.below(4);
      if (kind == 0)
        damaged[at] = bytes[random.below(uint32_t(bytes.size()))];
      else if (kind == 1)
        damaged.erase(at, 1 + random.below(20));
      else if (kind == 2)
        damaged.insert(
            at, damaged.substr(random.below(uint32_t(damaged.size())), 1 + random.below(40)));
      else
        damaged[at] = char(damaged[at] ^ char(1 << random.below(7)));
    }
    CHECK(survives(damaged));
    const bool ok = read_scene(damaged, "x.json").ok();
    read_well += ok;
    faulty += !ok;
  }
  // Representative: some damage must pass (inside texts), most must not.
  if (count >= 2000) {
    CHECK(read_well > count / 200);
    CHECK(faulty > count / 2);
  }
}

TEST_CASE("structural damage: values replaced by values of another kind") {
  const std::string text = file_text(data_file("everything.json"));
  const std::string values[] = {"null",
                                "true",
                                "-1",
                                "1e300",
                                "\"\"",
                                "\"$n\"",
                                "[]",
                                "{}",
                                "[[[]]]",
                                "{\"type\": \"box\"}",
                                "18446744073709551615",
                                "-9223372036854775808",
                                "0.5",
                                "\"= n ^ 99999\"",
                                "[1, 2, 3]",
                                "[1e9, 1e9, 1e9]"};
  int cases = 0;
  // Behind every colon that is followed by a number, a string without spaces or a bracket.
  for (size_t at = text.find("\": "); at != std::string::npos; at = text.find("\": ", at + 1)) {
    size_t end = at + 3;
    int depth = 0;
    for (; end < text.size(); ++end) {
      const char c = text[end];
      if (c == '[' || c == '{') ++depth;
      if (c == ']' || c == '}') {
        if (depth == 0) break;
        --depth;
      }
      if (c == ',' && depth == 0) break;
    }
    for (const std::string& v : values) {
      if (scaled_count(100) < 100 && ++cases % 50 != 0) continue;
      CHECK(survives(text.substr(0, at + 3) + v + text.substr(end)));
    }
  }
}

TEST_CASE("many faults are cut short") {
  std::string members;
  for (int i = 0; i < 5000; ++i) members += "\"k" + std::to_string(i) + "\": 1,\n";
  const SceneRead read = read_scene(scene_with(members + "\"z\": 1"), "x.json");
  CHECK(read.faults.size() == 200);
}
