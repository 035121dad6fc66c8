// Damaged robot files: each is read, or refused with a file and a cause; what is read can be built
// into a scene or is refused there. Reference: that nothing else happens.
#include "engine/core/random.hpp"
#include "engine/world/world.hpp"
#include "tests/scene/robots/robot_text.hpp"
#include "tests/scene/robots/whole_robots.hpp"

#include <iterator>

using namespace tumble;
using namespace tumble::test;

namespace {

/// Numbers, names and whole elements change places.
std::string mutated(std::string text, Random& random) {
  static const char* const pieces[] = {"0",   "-1",    "1e12", "nan",   "1e-300", "",    "a",
                                       "b",   "\"",    "<",    "/>",    "0 0 0",  "1 2", "&#0;",
                                       "0x1", "world", "free", "fixed", "1e999"};
  const uint32_t changes = 1 + random.below(4);
  for (uint32_t i = 0; i < changes && !text.empty(); ++i) {
    const size_t at = random.below(uint32_t(text.size()));
    switch (random.below(5)) {
      case 0: {
        const size_t open = text.find('"', at);
        const size_t close = open == std::string::npos ? open : text.find('"', open + 1);
        if (close != std::string::npos)
          text.replace(open + 1, close - open - 1,
                       pieces[random.below(uint32_t(std::size(pieces)))]);
        break;
      }
      case 1:
        text[at] = char(random.below(256));
        break;
      case 2:
        text.erase(at, 1 + random.below(40));
        break;
      case 3: {
        const std::string part = text.substr(at, 1 + random.below(200));
        text.insert(random.below(uint32_t(text.size())), part);
        break;
      }
      default:
        text.resize(at);
    }
  }
  return text;
}

struct Outcomes {
  int read = 0, refused = 0, built = 0;
};

void judge(const std::string& text, const std::string& name, Outcomes& out) {
  ReadRobot r = robot_of_text(text, name);
  if (r.log.ok()) {
    RobotParts parts = make_robot(r.model, {}, r.log);
    if (r.log.ok()) {
      ++out.read;
      WorldDef extras;
      extras.threads = 1;
      std::vector<Fault> faults;
      const auto built = build_world(parts.scene, extras, nullptr, &faults);
      CHECK((built.ok() || !faults.empty()));
      out.built += built.ok();
      if (built) CHECK(built->world->step().ok());
    }
  }
  if (!r.log.ok()) {
    ++out.refused;
    CHECK_FALSE(r.log.faults()[0].message.empty());
    CHECK(r.log.faults()[0].file == name);
  }
}

}  // namespace

TEST_CASE("damaged robot files are read or refused with a cause") {
  for (const auto& [text, name] :
       {std::pair(whole_urdf, "r.urdf"), std::pair(whole_mjcf, "m.xml")}) {
    const auto& shown_name = name;
    CAPTURE(shown_name);
    Outcomes whole;
    judge(text, name, whole);
    CHECK(whole.built == 1);
    Random random(20, uint64_t(name[0]));
    Outcomes out;
    const int count = scaled_count(400);
    for (int i = 0; i < count; ++i) {
      const std::string damaged = mutated(text, random);
      CAPTURE(damaged);
      judge(damaged, name, out);
    }
    CAPTURE(out.read);
    CAPTURE(out.built);
    if (count >= 100) {  // both happen often enough to mean something
      CHECK(out.read > count / 100);
      CHECK(out.refused > count / 5);
      CHECK(out.built > count / 100);
    }
  }
}
