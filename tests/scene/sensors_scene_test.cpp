// Sensors in scenes: what is built, and faults with their line. References: counts and places
// written out here.
#include "engine/scene/build.hpp"
#include "engine/scene/saving/scene_edits.hpp"
#include "engine/world/world.hpp"
#include "tests/scene/scene_text.hpp"
#include "tests/support/why_not.hpp"

#include <algorithm>

#include <fmt/format.h>

using namespace tumble;

namespace {

const std::string sensed_bodies =
    "\"bodies\": {\"ball\": {\"shape\": {\"type\": \"sphere\", \"radius\": 0.1}, \"position\": "
    "[0, 1, 0]}, \"cup\": {\"shape\": {\"type\": \"box\", \"size\": [0.1, 0.1, 0.1]}, "
    "\"position\": "
    "[4, 1, 0], \"repeat\": {\"type\": \"stack\", \"count\": 3, \"step\": [1, 0, 0]}}},\n";

SceneRead read_sensor(const std::string& keys) {
  return read_scene(scene_with(sensed_bodies + "\"sensors\": {\"it\": {" + keys + "}}"),
                    data_file("x.json"));
}

BuiltScene built_sensor(const std::string& keys) {
  const SceneRead read = read_sensor(keys);
  REQUIRE_MESSAGE(read.ok(), all_text(read.faults));
  WorldDef extras;
  extras.threads = 1;
  auto made = build_world(read.scene, extras);
  REQUIRE_MESSAGE(made.ok(), test::why_not(made));
  return std::move(*made);
}

/// "line: path: message" of the only fault.
std::string sensor_fault(const std::string& keys) {
  const SceneRead read = read_sensor(keys);
  std::vector<Fault> faults = read.faults;
  if (read.ok()) CHECK_FALSE(build_world(read.scene, {}, nullptr, &faults).ok());
  INFO(all_text(faults));
  REQUIRE(faults.size() == 1);
  return std::to_string(faults[0].line) + ": " + faults[0].path + ": " + faults[0].message;
}

const SensorFrame& named_sensor(const BuiltScene& s, const Frame& frame, const std::string& name) {
  REQUIRE(s.sensors.contains(name));
  REQUIRE(frame.sensors);
  const auto found = std::ranges::find(*frame.sensors, s.sensors.at(name), &SensorFrame::id);
  REQUIRE(found != frame.sensors->end());
  return *found;
}

}  // namespace

TEST_CASE("sensors of a scene: forms, places, lists") {
  BuiltScene s = built_sensor(
      "\"type\": \"gate\", \"size\": [2, 3], \"position\": [0, 5, 0], \"euler_deg\": [90, 0, 0], "
      "\"span\": 0.25, \"bodies\": [\"cup\"]");
  SensorDef def = *s.world->sensor(s.sensors.at("it"));
  CHECK(def.shape.form == SensorForm::rectangle);
  CHECK(def.shape.half == Vec3(1, 0, 1.5));
  CHECK(def.pose.direction(Vec3::UnitY()).z() == doctest::Approx(1));
  CHECK(def.span == 0.25);
  CHECK(def.only_bodies.size() == 3);
  s = built_sensor("\"type\": \"region\", \"radius\": 1, \"height\": 4, \"body\": \"cup[1]\"");
  def = *s.world->sensor(s.sensors.at("it"));
  CHECK(def.shape.form == SensorForm::cylinder);
  CHECK(def.shape.half.y() == 2);
  CHECK(def.carrier == s.bodies.at("cup[1]"));
  const auto frame = s.world->frame();
  CHECK(named_sensor(s, *frame, "it").pose.x.x() == doctest::Approx(5));
  CHECK(named_sensor(s, *frame, "it").inside ==
        std::vector<BodyId>{s.bodies.at("cup[0]"), s.bodies.at("cup[2]")});
  s = built_sensor("\"type\": \"region\", \"size\": [1, 1, 1], \"takes\": \"bodies\"");
  CHECK_FALSE(s.world->sensor(s.sensors.at("it"))->particles);
}

TEST_CASE("many sensors at once, in steps, and on the copies of a body") {
  BuiltScene s = built_sensor(
      "\"type\": \"gate\", \"radius\": 0.4, \"position\": [1, 0.5, 0], \"count\": 4, \"step\": "
      "[-1, "
      "0, 0]");
  CHECK(s.sensors.size() == 4);
  for (int n = 0; n < 60; ++n) REQUIRE(s.world->step().ok());
  const auto frame = s.world->frame();
  for (int k = 0; k < 4; ++k)
    CHECK(named_sensor(s, *frame, "it[" + std::to_string(k) + "]").backward == (k == 1 ? 1 : 0));
  s = built_sensor("\"type\": \"contact\", \"a\": \"cup[i + 1]\", \"b\": \"ball\", \"count\": 2");
  CHECK(s.world->sensor(s.sensors.at("it[1]"))->a == s.bodies.at("cup[2]"));
  CHECK(s.world->sensor(s.sensors.at("it[1]"))->b == s.bodies.at("ball"));
}

TEST_CASE("faults of sensors say where") {
  CHECK(sensor_fault("\"type\": \"gate\"").find("3: sensors.it: a gate has a radius or a size") ==
        0);
  CHECK(sensor_fault("\"type\": \"gate\", \"size\": [1, 1, 1]").find("must be 2 numbers, got 3") !=
        std::string::npos);
  CHECK(sensor_fault("\"type\": \"gate\",\n\"radius\": 0").find("4: sensors.it.radius: ") == 0);
  CHECK(sensor_fault("\"type\": \"region\", \"size\": [1, 1, 1], \"height\": 1")
            .find("sensors.it.height: ") != std::string::npos);
  CHECK(sensor_fault("\"type\": \"region\", \"size\": [1, 1, 1], \"radius\": 1")
            .find("a region has a size, or") != std::string::npos);
  CHECK(sensor_fault("\"type\": \"region\", \"radius\": 1, \"body\": \"cap\"")
            .find("did you mean 'cup'") != std::string::npos);
  CHECK(sensor_fault("\"type\": \"region\", \"radius\": 1, \"bodies\": [\"ball\", \"cap\"]")
            .find("sensors.it.bodies[1]: ") != std::string::npos);
  CHECK(sensor_fault("\"type\": \"region\", \"radius\": 1, \"particles\": [\"mud\"]")
            .find("sensors.it.particles[0]: ") != std::string::npos);
  CHECK(sensor_fault("\"type\": \"contact\", \"a\": \"cup[i + 2]\", \"count\": 2")
            .find("sensors.it.a: there is no copy 3") != std::string::npos);
  CHECK(sensor_fault("\"type\": \"contact\", \"a\": \"ball\", \"b\": \"ball\"")
            .find("sensors.it.b: a and b are the same body") != std::string::npos);
  CHECK(sensor_fault("\"type\": \"contact\", \"b\": \"ball\"").find("sensors.it") !=
        std::string::npos);
}

TEST_CASE("a radial distribution takes each system once, of boxes of one size") {
  const auto fault = [](const char* systems, double edge_of_b) {
    const std::string box = R"("list": [{"position": [0, 0, 0]}], "periodic_box": {"size": )";
    const SceneRead read = read_scene(
        scene_with(
            "\"particles\": {\"a\": {" + box + "[2, 2, 2], \"centre\": [1, 0, 0]}}, \"b\": {" +
            box + fmt::format("[2, 2, {}]", edge_of_b) +
            "}}},\n\"sensors\": {\"it\": {\"type\": \"radial_distribution\", \"range\": 0.5, "
            "\"particles\": " +
            systems + "}}"),
        data_file("x.json"));
    std::vector<Fault> faults = read.faults;
    if (read.ok()) (void)build_world(read.scene, {}, nullptr, &faults);
    return all_text(faults);
  };
  CHECK(fault(R"(["a", "b"])", 2) == "");
  CHECK(fault(R"(["a", "a"])", 2).find("sensors.it.particles[1]: 'a' is named twice") !=
        std::string::npos);
  CHECK(fault(R"(["a", "b"])", 3).find("sensors.it.particles[1]: its periodic box is of another") !=
        std::string::npos);
}

TEST_CASE("a removed body takes its sensors out of the file") {
  const std::string text =
      scene_with(sensed_bodies +
                 "\"sensors\": {\n\"on\": {\"type\": \"contact\", \"a\": \"ball\"},\n"
                 "\"off\": {\"type\": \"region\", \"radius\": 1}\n}");
  const std::vector<SceneEdit> edits = {RemovedBody{"ball"}};
  const auto saved = save_edits(text, data_file("x.json"), edits);
  REQUIRE_MESSAGE(saved.ok(), test::why_not(saved));
  CHECK(saved->text.find("\"on\"") == std::string::npos);
  CHECK(saved->text.find("\"off\"") != std::string::npos);
}
