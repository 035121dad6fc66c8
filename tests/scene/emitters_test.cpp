// Emitters and sinks in scenes: what is built, and faults with their line. References: closed forms
// and counts written out here.
#include "engine/scene/build.hpp"
#include "engine/world/world.hpp"
#include "tests/scene/scene_text.hpp"
#include "tests/support/why_not.hpp"

#include <fmt/format.h>

using namespace tumble;

namespace {

/// "line: path: message" of the only fault of a scene.
std::string fault_of(const std::string& members) {
  const SceneRead read = read_scene(scene_with(members), data_file("x.json"));
  std::vector<Fault> faults = read.faults;
  if (read.ok()) {
    WorldDef extras;
    extras.threads = 1;
    CHECK_FALSE(build_world(read.scene, extras, nullptr, &faults).ok());
  }
  INFO(all_text(faults));
  REQUIRE(faults.size() == 1);
  return std::to_string(faults[0].line) + ": " + faults[0].path + ": " + faults[0].message;
}

std::string with_emitter(const std::string& keys) {
  return "\"particles\": {\"dust\": {\"fast\": true, \"mass\": 0.5}},\n"
         "\"bodies\": {\"box\": {\"shape\": {\"type\": \"box\", \"size\": [1, 1, 1]}}},\n"
         "\"meshes\": {\"tetra\": \"tetra.obj\"},\n"
         "\"emitters\": {\"jet\": {" +
         keys + "}}";
}

void check_fault(const std::string& keys, const std::string& expected) {
  const std::string fault = fault_of(with_emitter(keys));
  CHECK_MESSAGE(fault.find(expected) != std::string::npos, fault);
}

BuiltScene built(const std::string& members) {
  const SceneRead read = read_scene(scene_with(members), data_file("x.json"));
  REQUIRE_MESSAGE(read.ok(), all_text(read.faults));
  WorldDef extras;
  extras.threads = 1;
  auto made = build_world(read.scene, extras);
  REQUIRE_MESSAGE(made.ok(), test::why_not(made));
  return std::move(*made);
}

}  // namespace

TEST_CASE("an emitter takes what it is not told from its particle system") {
  BuiltScene s =
      built(with_emitter("\"particles\": \"dust\", \"rate\": 60, \"life\": 2, "
                         "\"position\": [0, 9, 0], \"speed\": {\"mean\": 1}"));
  for (int n = 0; n < 30; ++n) REQUIRE(s.world->step().ok());
  const ParticleSystem& dust = *s.world->particles(s.particles.at("dust"));
  REQUIRE(dust.size() == 30);
  CHECK(dust.mass[0] == 0.5);
  CHECK(dust.life[0] == 2);
  CHECK(dust.x[29].y() == doctest::Approx(9));
  CHECK(s.world->emitter(s.emitters.at("jet"))->made == 30);
}

TEST_CASE("every kind of shape can be written") {
  for (const char* shape : {"{\"type\": \"point\"}", "{\"type\": \"line\", \"length\": 2}",
                            "{\"type\": \"disc\", \"radius\": 1, \"inner_radius\": 0.5}",
                            "{\"type\": \"sphere\", \"radius\": 1, \"surface\": true}",
                            "{\"type\": \"box\", \"size\": [1, 2, 3]}",
                            "{\"type\": \"mesh_surface\", \"mesh\": \"tetra\"}",
                            "{\"type\": \"mesh_volume\", \"mesh\": \"tetra\"}"}) {
    CAPTURE(shape);
    BuiltScene s = built(with_emitter(
        std::string(
            "\"particles\": \"dust\", \"rate\": 600, \"life\": 2, \"direction\": \"outward\", "
            "\"shape\": ") +
        shape));
    for (int n = 0; n < 6; ++n) REQUIRE(s.world->step().ok());
    CHECK(s.world->frame()->stats.particles == 60);
  }
}

TEST_CASE("a body that is not present is there for emitters only") {
  BuiltScene s = built(
      "\"bodies\": {\"part\": {\"shape\": {\"type\": \"sphere\", \"radius\": 0.1}, \"mass\": 3, "
      "\"present\": false}},\n\"emitters\": {\"drop\": {\"body\": \"part\", \"rate\": 10, "
      "\"count\": 4}}");
  CHECK(s.world->frame()->stats.bodies == 0);
  for (int n = 0; n < 60; ++n) REQUIRE(s.world->step().ok());
  CHECK(s.world->frame()->stats.bodies == 4);
  const RigidBody* b = s.world->body(s.world->find_body("drop[2]"));
  REQUIRE(b);
  CHECK(b->mass == 3);
}

TEST_CASE("faults of emitters name line, cause and cure") {
  const std::string jet = "\n\"particles\": \"dust\", \"life\": 1,\n";
  check_fault(jet + "\"rate\": -3",
              "7: emitters.jet.rate: must be >= 0 and <= 1000000000 1/s, got -3");
  check_fault("\"particles\": \"dust\", \"rate\": 3,\n\"life\": 0",
              "6: emitters.jet.life: must be > 0 s, got 0 s");
  check_fault("\"particles\": \"dust\", \"rate\": 3,\n\"life\": {\"mean\": 1, \"spread\": 1.5}",
              "6: emitters.jet.life: must be > 0 s, but with this spread it may be -0.5 s");
  check_fault("\"particles\": \"dust\",\n\"rate\": 3",
              "6: emitters.jet.rate: makes more and more without end: give life, end, count or");
  check_fault(jet + "\"rate\": 1e9",
              "emitters.jet: there may be 1.01667e+09 of its particles at "
              "once; a scene may have 2000000 in all; a lower rate");
  check_fault(jet + "\"shape\": {\"type\": \"mesh_volume\", \"mesh\": \"cube\"}",
              "7: emitters.jet.shape.mesh: ");
  check_fault("\"particles\": \"dirt\", \"life\": 1", "emitters.jet.particles: ");
  check_fault("\"rate\": 1, \"life\": 1",
              "emitters.jet: an emitter has either particles or a body");
  check_fault("\"body\": \"box\", \"rate\": 1, \"count\": 3, \"mass\": 3", "emitters.jet.mass: ");
  check_fault("\"body\": \"box\", \"rate\": 1000, \"life\": 1000",
              "of its bodies at once; a scene may have 200000");
  check_fault(jet + "\"carrier\": \"cart\"", "emitters.jet.carrier: ");
  check_fault(jet + "\"end\": 0", "7: emitters.jet.end: must be after start");
  check_fault(jet + "\"shape\": {\"type\": \"disc\", \"radius\": 1, \"inner_radius\": 2}",
              "emitters.jet.shape.inner_radius: must be less than the radius");
  check_fault(jet + "\"events\": {\"event\": \"death\", \"emitter\": \"jet\"}",
              "emitters.jet: events lead from this emitter back to it");
  check_fault(jet + "\"events\": {\"event\": \"death\"}", "needs the name of an emitter");
  check_fault(jet + "\"events\": {\"event\": \"death\", \"emitter\": \"spark\"}",
              "emitters.jet.events[0].emitter: ");
}

TEST_CASE("emitters in each other are a fault where what they emit pushes, at one time") {
  const auto two = [](const std::string& system, const std::string& a, const std::string& b) {
    return "\"particles\": {\"p\": {" + system +
           "}}, \"emitters\": {\"a\": {\"particles\": \"p\", "
           "\"rate\": 10, \"life\": 1, " +
           a +
           "},\n\"b\": {\"particles\": \"p\", \"rate\": 10, "
           "\"life\": 1, " +
           b + "}}";
  };
  const std::string here = "\"position\": [0, 2, 0]", near = "\"position\": [0.01, 2, 0]",
                    far = "\"position\": [0.1, 2, 0]";
  const std::string disc = ", \"shape\": {\"type\": \"disc\", \"radius\": 0.05}";
  const std::string balls = "\"radius\": 0.02", fast = "\"fast\": true",
                    dust = "\"collide\": false";
  const std::string fault = fault_of(two(balls, here, near));
  CHECK_MESSAGE(
      fault.find("emitters.b: overlaps the emitter 'a' at (0.01, 2, 0)") != std::string::npos,
      fault);
  CHECK(fault_of(two(balls, here + disc, near)).find("overlaps") != std::string::npos);
  CHECK(fault_of(two("\"fluid\": {}", here, here)).find("overlaps") != std::string::npos);
  // Side by side, with nothing to push, one after the other, or of things that do not meet.
  built(two(balls, here, far));
  built(two(balls, here + disc, far + disc));
  built(two(fast, here, here));
  built(two(dust, here, here));
  built(two(balls, here + ", \"end\": 1", here + ", \"start\": 2"));
}

TEST_CASE("emitter values have the bounds of their unit") {
  check_fault("\"particles\": \"dust\", \"rate\": 1, \"life\": 1, \"radius\": 1e9",
              "emitters.jet.radius: must be <= 1000000 m, got 1000000000 m");
  check_fault(
      "\"particles\": \"dust\", \"rate\": 1, \"life\": 1, "
      "\"mass\": {\"mean\": 1e12, \"spread\": 5e11}",
      "emitters.jet.mass: must be <= 1e+12 kg, got 1.5e+12 kg");
  check_fault("\"particles\": \"dust\", \"rate\": 1, \"life\": 1, \"speed\": -2e6",
              "emitters.jet.speed: must be <= 1000000 m/s");
  const BuiltScene coulomb = built(
      "\"particles\": {\"ions\": {\"charge\": 1e-9, \"list\": [[0, 0, 0], [1, 0, 0]]}}, "
      "\"forces\": {\"f\": {\"type\": \"coulomb\"}}");
  CHECK(coulomb.forces.size() == 1);
}

TEST_CASE("what particles, emitters and sinks probably do not mean is said, and nothing else") {
  const std::string ground =
      "\"bodies\": {\"floor\": {\"type\": \"static\", \"shape\": {\"type\": \"half_space\"}}, "
      "\"wall\": {\"type\": \"static\", \"position\": [5, 1, 0], \"shape\": {\"type\": \"box\", "
      "\"size\": [1, 1, 1]}}}, ";
  const auto says = [&](const std::string& members, const std::string& sentence) {
    const auto lines = built(ground + members).warnings;
    INFO(members);
    std::string all;
    for (const std::string& line : lines) all += line + "\n";
    INFO(all);
    if (sentence.empty()) {
      CHECK(lines.empty());
    } else {
      REQUIRE(lines.size() == 1);
      CHECK(lines[0].find(sentence) != std::string::npos);
    }
  };
  const auto particles = [](const std::string& keys) { return "\"particles\": {" + keys + "}"; };
  const std::string list = "\"list\": [[0, 1, 0], [0.2, 1, 0]]";
  const std::string some = particles("\"p\": {" + list + "}");
  const auto emitter = [&](const std::string& keys) {
    return some + ", \"emitters\": {\"e\": {\"particles\": \"p\", \"life\": 1, \"speed\": 1, " +
           keys + "}}";
  };
  const auto water = [&](const std::string& keys) {
    return particles("\"w\": {\"fluid\": {" + keys +
                     "}, \"fill\": {\"type\": \"lattice\", "
                     "\"centre\": [0, 0.5, 0], \"size\": [0.2, 0.2, 0.2], \"spacing\": 0.05}}");
  };
  says(some, "");
  says(emitter("\"rate\": 10, \"position\": [0, 3, 0]"), "");
  says(water(""), "");
  says(particles("\"p\": {\"list\": [[0, 1, 0], [1, 1, 0], [0, 1, 0]]}"),
       "particles.p: 1 pair of particles begins on one place, the first at (0, 1, 0)");
  says(
      particles("\"w\": {\"fluid\": {}, \"fill\": {\"type\": \"lattice\", \"centre\": [0, 0.5, 0], "
                "\"size\": [0.2, 0.2, 0.2], \"spacing\": 0.05}}, \"x\": {\"fluid\": {}, \"fill\": "
                "{\"type\": \"lattice\", \"centre\": [0, 0.5, 0], \"size\": [0.2, 0.2, 0.2], "
                "\"spacing\": 0.05}}"),
      "particles.w: 125 pairs of particles begin on one place with 'x'");
  says(emitter("\"rate\": 10, \"position\": [5, 1, 0]"),
       "emitters.e: what leaves it begins inside the body 'wall' at (5, 1, 0)");
  says(some +
           ", \"emitters\": {\"e\": {\"body\": \"wall\", \"rate\": 1, \"at_most\": 3, "
           "\"position\": [5, 1, 0]}}",
       "emitters.e: what leaves it begins inside the body 'wall'");
  says(emitter("\"position\": [0, 3, 0]"), "emitters.e: nothing comes from it");
  says(emitter("\"rate\": 10, \"position\": [0, 3, 0], \"direction\": \"outward\""),
       "emitters.e.direction: has no effect");
  says(emitter("\"rate\": 10, \"position\": [0, 3, 0], \"colours\": [\"red\"], "
               "\"colour_over_life\": [\"red\", \"blue\"]"),
       "emitters.e.colours: has no effect");
  says(emitter("\"rate\": 10, \"position\": [0, 3, 0], \"opacity_over_life\": [1, 0]"),
       "emitters.e.opacity_over_life: has no effect");
  says(emitter("\"rate\": 10, \"position\": [0, 3, 0], \"size_over_life\": []"),
       "emitters.e.size_over_life: has no effect: the list is empty");
  says(some + ", \"sinks\": {\"s\": {\"type\": \"box\", \"size\": [100, 100, 100]}}",
       "sinks.s: all that it takes is in it at the start");
  says(emitter("\"rate\": 10, \"position\": [0, 3, 0]") +
           ", \"sinks\": {\"s\": {\"type\": \"sphere\", \"radius\": 0.1, \"position\": [0, 3, 0]}}",
       "sinks.s: takes at once what comes from the emitter 'e'");
  says(particles("\"p\": {" + list + ", \"look\": {\"style\": \"smoke\", \"clarity\": 1}}"),
       "particles.p.look.clarity: has no effect");
  says(particles("\"p\": {\"list\": [[0, 1, 0]], \"periodic_box\": {\"centre\": [0, 1, 0], "
                 "\"size\": [0.01, 0.01, 0.01]}}"),
       "less than a particle");
  says(particles("\"p\": {" + list +
                 ", \"periodic_box\": {\"centre\": [9, 1, 0], "
                 "\"size\": [1, 1, 1]}}"),
       "2 of 2 particles begin outside");
  says(water("\"sound_speed\": 100"), "particles.w.fluid.sound_speed: has no effect");
  says(water("\"solver\": \"wcsph\", \"density_error\": 0.001"),
       "particles.w.fluid.density_error: has no effect");
  says(water("\"solver\": \"wcsph\", \"sound_speed\": 0.01"),
       "particles.w.fluid.sound_speed: 0.01 m/s is less than ten times");
}

TEST_CASE("a fluid that would fall for ever is a fault, unless it is meant to") {
  const auto drop = [](const std::string& keys) {
    return "\"particles\": {\"w\": {" + keys +
           "\"fluid\": {}, \"fill\": {\"type\": \"lattice\", "
           "\"size\": [0.2, 0.2, 0.2], \"spacing\": 0.05}}}";
  };
  const std::string fault = fault_of(drop(""));
  CHECK_MESSAGE(fault.find("particles.w: nothing contains this fluid") != std::string::npos, fault);
  CHECK(fault.find("place bodies") != std::string::npos);
  built(drop("\"life\": 2, "));
  built(drop("\"gravity_scale\": 0, "));
  built("\"settings\": {\"gravity\": [0, 0, 0]}, " + drop(""));
}

TEST_CASE("a fluid of two spacings is a fault") {
  const auto two = [](double spacing) {
    return fmt::format(
        "\"particles\": {{\"w\": {{\"gravity_scale\": 0, \"fluid\": {{}}, \"fill\": ["
        "{{\"type\": \"lattice\", \"size\": [0.2, 0.2, 0.2], \"spacing\": 0.05}}, "
        "{{\"type\": \"lattice\", \"centre\": [0.3, 0, 0], \"size\": [0.2, 0.2, 0.2], "
        "\"spacing\": {}}}]}}}}",
        spacing);
  };
  built(two(0.05));
  built(two(0.06));
  const std::string fault = fault_of(two(0.1));
  CHECK_MESSAGE(fault.find("particles.w: particles of this fluid have spacings from 0.05 m to "
                           "0.1 m") != std::string::npos,
                fault);
  CHECK(fault.find("fill all of it with about the same \"spacing\"") != std::string::npos);
}

TEST_CASE("crowds by events are counted before the run, and collisions need to be looked for") {
  const auto two = [](const std::string& event, const std::string& dust) {
    return "\"particles\": {\"dust\": {" + dust +
           "}},\n\"emitters\": {\"spark\": {\"particles\": \"dust\", \"life\": 1},\n"
           "\"rocket\": {\"particles\": \"dust\", \"life\": 1, \"rate\": 5000, \"events\": " +
           event + "}}";
  };
  CHECK(fault_of(two("{\"event\": \"death\", \"emitter\": \"spark\", \"count\": 1000}", ""))
            .find("emitters.spark: there may be 5.084e+06 of its particles") != std::string::npos);
  CHECK(fault_of(two("{\"event\": \"collision\", \"emitter\": \"spark\"}", "\"fast\": true"))
            .find("emitters.spark: nothing bounds how many") != std::string::npos);
  CHECK(fault_of(two("{\"event\": \"collision\", \"dies\": true}", ""))
            .find("collisions of 'dust' are not looked for") != std::string::npos);
}

TEST_CASE("sinks in a scene: what they take, and their faults") {
  const std::string parts =
      "\"particles\": {\"dust\": {\"list\": [[0, 1, 0], [5, 1, 0]], \"collide\": false}},\n"
      "\"bodies\": {\"ball\": {\"shape\": {\"type\": \"sphere\", \"radius\": 0.1}, \"position\": "
      "[0, 1, 0]}},\n\"sinks\": {\"hole\": {";
  BuiltScene s = built(parts + "\"type\": \"box\", \"size\": [1, 9, 1]}}");
  REQUIRE(s.world->step().ok());
  CHECK(s.world->frame()->stats.particles == 1);
  CHECK(s.world->frame()->stats.bodies == 1);
  s = built(parts +
            "\"type\": \"sphere\", \"radius\": 3, \"outside\": true, \"takes\": \"both\"}}");
  REQUIRE(s.world->step().ok());
  CHECK(s.world->frame()->stats.particles == 1);
  CHECK(s.world->frame()->stats.bodies == 1);
  s = built(parts + "\"type\": \"plane\", \"position\": [0, 2, 0], \"takes\": \"bodies\"}}");
  REQUIRE(s.world->step().ok());
  CHECK(s.world->frame()->stats.particles == 2);
  CHECK(s.world->frame()->stats.bodies == 0);
  CHECK(fault_of(parts + "\"type\": \"sphere\",\n\"radius\": 0}}").find("5: sinks.hole.radius: ") ==
        0);
  CHECK(fault_of(parts + "\"type\": \"plane\", \"particles\": [\"dirt\"]}}")
            .find("sinks.hole.particles[0]: ") != std::string::npos);
}

TEST_CASE("a scene says how an emitter changes with its time, and what bodies give birth to") {
  BuiltScene s = built(
      "\"particles\": {\"dust\": {\"fast\": true}, \"sand\": {\"grains\": {}}},\n"
      "\"bodies\": {\"crate\": {\"present\": false, \"shape\": {\"type\": \"box\", \"size\": [1, "
      "1, 1]}}},\n"
      "\"emitters\": {\"puff\": {\"particles\": \"dust\", \"life\": 9},\n"
      "\"grit\": {\"particles\": \"sand\", \"rate\": 60, \"end\": 1, \"spin\": 4, \"life\": 9,\n"
      "\"shape\": {\"type\": \"disc\", \"radius\": 5},\n"
      "\"mass_over_life\": [1, 0.5],\n"
      "\"over_time\": [{\"time\": 0, \"rate\": 0}, {\"time\": 1, \"rate\": 1, \"colour\": "
      "\"#ff0000\"}]},\n"
      "\"drop\": {\"body\": \"crate\", \"rate\": 2, \"count\": 1, \"position\": [0, 50, 0], "
      "\"life\": 0.4,\n"
      "\"events\": [{\"event\": \"death\", \"emitter\": \"puff\", \"count\": 7}]}}");
  for (int n = 0; n < 60; ++n) REQUIRE(s.world->step().ok());
  CHECK(s.world->emitter(s.emitters.at("grit"))->made == 30);  // half of 60
  const ParticleSystem& sand = *s.world->particles(s.particles.at("sand"));
  REQUIRE(sand.size() == 30);
  CHECK(sand.spin[29].norm() == doctest::Approx(4));
  CHECK(sand.colour[29].x() == doctest::Approx(1));
  CHECK(sand.mass[0] < sand.born_mass[0]);
  CHECK(s.world->emitter(s.emitters.at("puff"))->made == 7);
}

TEST_CASE("values over time that cannot be are faults at their place") {
  const std::string jet = "\"particles\": \"dust\", \"rate\": 9, \"life\": 1, ";
  check_fault(jet + "\"over_time\": [{\"time\": 2}, {\"time\": 1}]",
              "emitters.jet.over_time[1].time: must be later than the one before");
  check_fault(jet + "\"over_time\": [{\"time\": 0, \"mass\": 0}]",
              "emitters.jet.over_time[0].mass");
  check_fault(jet + "\"spin\": 3", "emitters.jet.spin: the particles of 'dust' do not turn");
  check_fault(
      "\"body\": \"box\", \"rate\": 1, \"at_most\": 5, "
      "\"over_time\": [{\"time\": 0, \"radius\": 2}]",
      "emitters.jet.over_time[0].radius: is of particles only");
}
