#pragma once
#include "tests/viewer/ui/laboratory.hpp"

#include <string>

namespace tumble::test {

/// A laboratory with a file of these bodies and what else is said.
struct Described : Laboratory {
  explicit Described(const std::string& members) {
    start = "{\n  \"tumble_scene\": 1, // mine\n" + members + "\n}\n";
    REQUIRE(write_file(file, std::string_view(start)).ok());
    rig.app->open(file);
    play("key B\nwait 3");  // nothing is to be built
    REQUIRE(rig.tick() == 0);
    rig.app->session().set_paused(true);
    start_hash = hash();
    play("key Shift+I\nwait 3");
  }
  void go(const std::string& place) {
    play("click description.way.0\nwait 2");
    std::string rest = place;
    while (!rest.empty()) {
      const size_t dot = rest.find('.');
      play("click description." + rest.substr(0, dot) + "\nwait 2");
      rest = dot == std::string::npos ? std::string() : rest.substr(dot + 1);
    }
  }
  void type_in(const std::string& key, const std::string& value) {
    play("click description." + key + "\nwait 2\nkey Ctrl+A\ntext " + value +
         "\nkey Enter\nwait 4");
  }
  /// Chooses a key from the list of absent ones, which is longer than its window: the wheel turns
  /// over whichever of its entries is seen.
  void add(const std::string& key) {
    play("click description.add\nwait 2");
    const auto seen = [&](const std::string& name) {
      return rig.app->locate("description.add." + name).has_value();
    };
    for (int n = 0; n < 20 && !seen(key); ++n)
      for (const char* over : {"title", "settings", "joints", "forces", "emitters", "sensors",
                               "lights", "type", "axis", "euler_deg", "drawn", "angular_velocity",
                               "mass", "centre", "colour", "gravity_scale", "precise", "colours"})
        if (seen(over)) {
          play("move description.add." + std::string(over) + "\nwait 1\nwheel -2\nwait 2");
          break;
        }
    play("click description.add." + key + "\nwait 4");
  }
  void choose(const std::string& key, const std::string& value, const char* list = "") {
    play("click description." + key + list + "\nwait 2\nclick description." + key + "." + value +
         "\nwait 4");
  }
  /// The file would be this now.
  std::string saved() {
    save();
    return content();
  }
  bool faulty() const { return rig.app->locate("description.faults").has_value(); }
};

inline const std::string two_bodies = R"(  "bodies": {
    "ground": { "type": "static", "shape": { "type": "half_space" }, "material": "wood" },
    "ball": { "shape": { "type": "sphere", "radius": 0.5 }, "position": [0, 2, 0] } // round
  },
  "cameras": { "main": { "position": [0, 2.5, 9], "target": [0, 1.5, 0] } })";

inline std::string with(std::string text, const std::string& from, const std::string& to) {
  const size_t at = text.find(from);
  REQUIRE(at != std::string::npos);
  return text.replace(at, from.size(), to);
}

}  // namespace tumble::test
