// From descriptions to worlds. References: closed forms of mass, place and colour written out here;
// the copies' places come from repetition_test.
#include "engine/scene/build.hpp"

#include "engine/core/random.hpp"
#include "engine/scene/build/near_pairs.hpp"
#include "engine/scene/build/spring_limits.hpp"
#include "engine/scene/check.hpp"
#include "engine/scene/drop_in.hpp"
#include "engine/world/world.hpp"
#include "tests/scene/scene_text.hpp"
#include "tests/support/shape_reference.hpp"
#include "tests/support/why_not.hpp"

#include <filesystem>

#include <fmt/format.h>

using namespace tumble;

namespace {

constexpr double pi = 3.14159265358979323846;

BuiltScene built(const SceneRead& read) {
  INFO(all_text(read.faults));
  REQUIRE(read.ok());
  std::vector<Fault> faults;
  WorldDef extras;
  extras.threads = 1;
  auto made = build_world(read.scene, extras, nullptr, &faults);
  INFO(all_text(faults));
  REQUIRE(made.ok());
  return std::move(*made);
}

BuiltScene built(const std::string& members) {
  return built(read_scene(scene_with(members), "x.json"));
}

std::vector<Fault> build_faults(const std::string& members) {
  const SceneRead read = read_scene(scene_with(members), data_file("x.json"));
  INFO(all_text(read.faults));
  REQUIRE(read.ok());
  std::vector<Fault> faults;
  WorldDef extras;
  extras.threads = 1;
  CHECK_FALSE(build_world(read.scene, extras, nullptr, &faults).ok());
  return faults;
}

const RigidBody& body(const BuiltScene& scene, std::string_view name) {
  const auto it = scene.bodies.find(name);
  REQUIRE(it != scene.bodies.end());
  const RigidBody* found = scene.world->body(it->second);
  REQUIRE(found);
  return *found;
}

}  // namespace

TEST_CASE("masses: density times volume, density of the body, mass") {
  const BuiltScene s = built(R"("bodies": {
    "a": {"shape": {"type": "box", "size": [1, 2, 3]}, "material": "wood"},
    "b": {"shape": {"type": "sphere", "radius": 0.5}, "position": [9, 0, 0], "density": 3},
    "c": {"shape": {"type": "cylinder", "radius": 0.5, "height": 2}, "position": [18, 0, 0], "mass": 7},
    "d": {"position": [27, 0, 0], "shapes": [
        {"type": "box", "size": [1, 1, 1], "material": {"density": 10}},
        {"type": "box", "size": [1, 1, 1], "position": [3, 0, 0], "material": {"density": 30}}]},
    "e": {"shape": {"type": "ellipsoid", "semi_axes": [1, 2, 3]}, "position": [36, 0, 0], "density": 5}})");
  CHECK(body(s, "a").mass == doctest::Approx(6 * 700).epsilon(1e-12));
  CHECK(body(s, "b").mass == doctest::Approx(3 * 4.0 / 3 * pi / 8).epsilon(1e-12));
  CHECK(body(s, "c").mass == doctest::Approx(7).epsilon(1e-12));
  CHECK(body(s, "e").mass == doctest::Approx(5 * 4.0 / 3 * pi * 6).epsilon(1e-12));
  CHECK(body(s, "d").mass == doctest::Approx(40).epsilon(1e-12));
  CHECK(body(s, "d").centre_body.x() == doctest::Approx(3 * 30.0 / 40).epsilon(1e-12));
}

TEST_CASE("every listed shape: read by its numbers, built with its mass, bad numbers named") {
  Random r(77);
  for (const ShapeEntry& entry : all_shapes()) {
    if (entry.parameters.empty() || made_of_mesh(entry.type)) continue;
    CAPTURE(entry.name);
    const ShapeDef def = test::draw_def(r, entry);
    // What a file says, with the number `bad` set to -1.
    const auto text = [&](const ShapeParameter* bad) {
      std::string out =
          fmt::format(R"("bodies": {{"b": {{"density": 3, "shape": {{"type": "{}")", entry.name);
      for (const ShapeParameter& p : entry.parameters) {
        out += fmt::format(R"(, "{}": )", p.parameter.name);
        const double sign = &p == bad ? -1 : 1;
        if (p.number) out += fmt::format("{:.17g}", sign * (def.*p.number) / p.factor);
        if (!p.vector) continue;
        const Vec3 v = sign / p.factor * (def.*p.vector);
        out += fmt::format("[{:.17g}, {:.17g}, {:.17g}]", v.x(), v.y(), v.z());
      }
      return out + "}}}";
    };
    const BuiltScene s = built(text(nullptr));
    const ShapeDef& made = body(s, "b").shapes[0].shape->def();
    CHECK(made.type == def.type);
    for (const ShapeParameter& p : entry.parameters) {
      if (p.number) CHECK(made.*p.number == doctest::Approx(def.*p.number).epsilon(1e-15));
      if (p.vector) CHECK((made.*p.vector - def.*p.vector).norm() < 1e-15);
      const SceneRead read = read_scene(scene_with(text(&p)), "x.json");
      REQUIRE(read.faults.size() == (p.vector ? 3 : 1));
      for (const Fault& f : read.faults)
        CHECK(f.text().find(p.parameter.name) != std::string::npos);
    }
    CHECK(body(s, "b").mass ==
          doctest::Approx(3 * (*make_shape(def))->mass_properties()->mass).epsilon(1e-12));
  }
  // Each number is in its range, and yet they are no shape.
  const SceneRead read =
      read_scene(scene_with(R"("bodies": {"b": {"shape": {"type": "tapered_capsule", "radius": 1,
        "top_radius": 0.2, "height": 0.5}}})"),
                 "x.json");
  REQUIRE(read.faults.size() == 1);
  CHECK(read.faults[0].text().find("difference of the radii, 0.8 m, got 0.5 m") !=
        std::string::npos);
}

TEST_CASE("copies have names, differences and colours in turn") {
  const BuiltScene s = built(R"("bodies": {"b": {
    "shape": {"type": "sphere", "radius": 0.1}, "position": [0, 5, 0], "mass": 2,
    "colours": ["#ff0000", "#0000ff"],
    "repeat": {"type": "stack", "count": 4, "step": [1, 0, 0]},
    "copies": {"1": {"mass": 9}, "2": {"present": false}, "3": {"colour": "#00ff00", "velocity": [0, 1, 0]}}}})");
  CHECK(s.bodies.size() == 3);
  CHECK(s.bodies.count("b[2]") == 0);
  CHECK(body(s, "b[0]").mass == 2);
  CHECK(body(s, "b[1]").mass == 9);
  CHECK(body(s, "b[3]").v == Vec3(0, 1, 0));
  CHECK(body(s, "b[3]").pose.x == Vec3(3, 5, 0));
  const auto frame = s.world->frame();
  const auto colour = [&](std::string_view name) {
    return frame->info(s.bodies.find(name)->second.index).look.colour;
  };
  CHECK(colour("b[0]") == Vec3f(1, 0, 0));
  CHECK(colour("b[1]") == Vec3f(0, 0, 1));
  CHECK(colour("b[3]") == Vec3f(0, 1, 0));
}

TEST_CASE("springs rest at their initial length unless told") {
  const BuiltScene s = built(R"("bodies": {"b": {"shape": {"type": "sphere", "radius": 0.1},
      "position": [0, 5, 0], "euler_deg": [0, 0, 90]}},
    "forces": {"f": {"type": "spring", "a": {"body": "b", "point": [1, 0, 0]}, "b": {"point": [0, 9, 0]}},
               "g": {"type": "spring", "a": {"body": "b"}, "b": {}, "rest_length": 2}})");
  const auto length = [&](const char* name) {
    return std::get<SpringDef>(*s.world->force(s.forces.find(name)->second)).rest_length;
  };
  CHECK(length("f") == doctest::Approx(3).epsilon(1e-12));
  CHECK(length("g") == 2);
}

TEST_CASE("springs between neighbours: a lattice of 4 by 3 has 17, diagonals none") {
  const BuiltScene s = built(R"("particles": {"net": {
    "fill": {"type": "lattice", "size": [0.6, 0.01, 0.4], "spacing": 0.2, "centre": [0, 2, 0]},
    "springs": {"reach": 0.2, "stiffness": 70, "damping": 3, "rest": 0.9}}})");
  REQUIRE(s.forces.size() == 17);
  const ParticleSystem& net = *s.world->particles(s.particles.find("net")->second);
  REQUIRE(net.size() == 12);
  for (const auto& [name, id] : s.forces) {
    const SpringDef& spring = std::get<SpringDef>(*s.world->force(id));
    const Vec3 along = net.x[net.find(spring.b.particle)] - net.x[net.find(spring.a.particle)];
    CHECK(along.norm() == doctest::Approx(0.2).epsilon(1e-12));
    CHECK(spring.rest_length == doctest::Approx(0.18).epsilon(1e-12));
    CHECK(spring.stiffness == 70);
    CHECK(spring.damping == 3);
  }
}

TEST_CASE("near pairs are those of trying all, and too many are given up") {
  Random random(5);
  for (const double reach : {0.05, 0.2, 0.7}) {
    std::vector<Vec3> x;
    for (int i = 0; i < 300; ++i)
      x.push_back({random.uniform(-1, 1), random.uniform(-0.3, 0.3), random.uniform(-1, 1)});
    std::vector<std::pair<uint32_t, uint32_t>> all;
    for (uint32_t a = 0; a < x.size(); ++a)
      for (uint32_t b = a + 1; b < x.size(); ++b)
        if ((x[a] - x[b]).norm() <= reach) all.emplace_back(a, b);
    CHECK(all.size() > 5);
    const auto found = near_pairs(x, reach, all.size());
    REQUIRE(found.has_value());
    CHECK(*found == all);
    CHECK_FALSE(near_pairs(x, reach, all.size() - 1).has_value());
  }
}

TEST_CASE(
    "so many springs that they fill the memory, and particles too small, are refused by path") {
  const auto springs = build_faults(R"("particles": {"p": {"fill": {"type": "random",
    "size": [1, 1, 1], "count": 10000}, "springs": {"reach": 10, "stiffness": 1}}})");
  REQUIRE(springs.size() == 1);
  CHECK(springs[0].path == "particles.p.springs");
  CHECK(springs[0].message.find("more than 100000 springs") != std::string::npos);
  const auto small = read_scene(scene_with(R"("particles": {"p": {"radius": 1e-9,
    "list": [{"position": [0, 0, 0], "radius": 1e-8}]}})"),
                                "x.json")
                         .faults;
  REQUIRE(small.size() == 2);
  for (const Fault& f : small) CHECK(f.message.find("at least 1e-06 m") != std::string::npos);
}

TEST_CASE("what one step does to an oscillator: the known limits of the integrators") {
  // On the imaginary axis: |1 + iy| > 1 always; classical Runge-Kutta up to y = 2 sqrt 2; the
  // semi-implicit step up to 2. On the negative axis Euler holds to -2.
  CHECK(amplification("explicit_euler", 1, 0, 0.5) == doctest::Approx(std::sqrt(1.25)));
  CHECK(amplification("rk4", 1, 0, 2.82) < 1);
  CHECK(amplification("rk4", 1, 0, 2.84) > 1);
  CHECK(amplification("semi_implicit_euler", 1, 0, 1.99) == doctest::Approx(1));
  CHECK(amplification("semi_implicit_euler", 1, 0, 2.01) > 1);
  CHECK(amplification("explicit_euler", 0, 1, 0.99) == doctest::Approx(1));
  CHECK(amplification("implicit_euler", 1, 0, 100) <= 1);
}

TEST_CASE("under an explicit integrator a spring that it cannot hold is named") {
  const auto warnings = [](const std::string& settings) {
    return built("\"settings\": {" + settings + R"(}, "bodies": {"b": {"mass": 1,
      "shape": {"type": "sphere", "radius": 0.1}}}, "forces": {
      "soft": {"type": "spring", "a": {"point": [0, 1, 0]}, "b": {"body": "b"}, "stiffness": 1},
      "stiff": {"type": "spring", "a": {"point": [1, 0, 0]}, "b": {"body": "b"},
                "stiffness": 1e6, "damping": 0}})")
        .warnings;
  };
  const auto euler =
      warnings("\"stepper\": \"event\", \"event\": {\"integrator\": \"explicit_euler\"}");
  REQUIRE(euler.size() == 1);
  CHECK(euler[0].find("forces.stiff") != std::string::npos);
  CHECK(euler[0].find("159 Hz") != std::string::npos);
  // Its steps are as short as the springs ask.
  CHECK(warnings("\"stepper\": \"event\"").empty());
  CHECK(warnings("\"stepper\": \"realtime\"").empty());
}

TEST_CASE("particles: lists and fills") {
  const BuiltScene s = built(R"("particles": {
    "a": {"list": [[0, 1, 0], {"position": [0, 2, 0], "mass": 5}], "mass": 3},
    "b": {"fill": {"type": "lattice", "size": [1, 2, 3], "spacing": 0.5, "centre": [7, 7, 7]}},
    "c": {"fill": {"type": "lattice", "region": "ball", "size": [2, 2, 2], "spacing": 0.1}},
    "d": {"fill": {"type": "random", "region": "ball", "size": [2, 2, 2], "count": 500, "speed": 3}}})");
  const auto system = [&](const char* name) -> const ParticleSystem& {
    return *s.world->particles(s.particles.find(name)->second);
  };
  REQUIRE(system("a").size() == 2);
  CHECK(system("a").mass[0] == 3);
  CHECK(system("a").mass[1] == 5);
  REQUIRE(system("b").size() == 3 * 5 * 7);
  Aabb box;
  for (const Vec3& x : system("b").x) box.include(x);
  CHECK((box.min - Vec3(6.5, 6, 5.5)).norm() < 1e-12);
  CHECK((box.max - Vec3(7.5, 8, 8.5)).norm() < 1e-12);
  // Lattice points in a ball of radius 10 spacings: 4169 (OEIS A000605), here shifted by half when
  // even.
  CHECK(std::fabs(double(system("c").size()) - 4169) < 1);
  for (size_t i = 0; i < 500; ++i) {
    CHECK(system("d").x[i].norm() <= 1 + 1e-12);
    CHECK(system("d").v[i].norm() <= 3 + 1e-12);
  }
}

TEST_CASE("faults of building carry the line of what cannot be built, all at once") {
  const auto faults = build_faults(
      "\"meshes\": {\n\"m\": \"tetr.obj\", \"t\": \"tetra.obj\"},\n"
      "\"bodies\": {\n"
      "\"a\": {\"shape\": {\"type\": \"half_space\"}},\n"
      "\"b\": {\"shape\": {\"type\": \"convex_hull\",\n"
      "  \"points\": [[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]]}},\n"
      "\"c\": {\"shape\": {\"type\": \"mesh\", \"mesh\": \"t\"}}},\n"
      "\"particles\": {\n\"p\": {\"fill\": {\"type\": \"lattice\", \"size\": [9, 9, 9], "
      "\"spacing\": 1e-4}}}");
  INFO(all_text(faults));
  REQUIRE(faults.size() == 4);
  CHECK(faults[0].line == 3);
  CHECK(faults[0].path == "meshes.m.file");
  CHECK(faults[0].message.find("did you mean 'tetra.obj'?") != std::string::npos);
  CHECK(faults[1].line == 5);
  CHECK(faults[1].path == "bodies.a");
  CHECK(faults[2].line == 6);
  CHECK(faults[2].path == "bodies.b");
  CHECK(faults[3].line == 10);
  CHECK(faults[3].path == "particles.p.fill[0]");
}

TEST_CASE("absurd numbers of particles are refused before memory is taken for them" *
          doctest::test_suite("long")) {
  const auto faults = build_faults(
      "\"particles\": {\n"
      "\"a\": {\"fill\": {\"type\": \"random\", \"size\": [1, 1, 1], \"count\": 1500000}},\n"
      "\"b\": {\"fill\": [{\"type\": \"random\", \"size\": [1, 1, 1], \"count\": 1500000}]},\n"
      "\"c\": {\"fill\": {\"type\": \"lattice\", \"size\": [1e6, 1e6, 1e6], \"spacing\": 1e-6}}}");
  INFO(all_text(faults));
  REQUIRE(faults.size() == 2);
  CHECK(faults[0].path == "particles.b.fill[0]");
  CHECK(faults[1].path == "particles.c.fill[0]");
  CHECK(faults[1].message.find("a scene may have 2000000 in all") != std::string::npos);
}

TEST_CASE("a spring to a copy that is not present") {
  const auto faults = build_faults(R"("bodies": {"b": {"shape": {"type": "sphere", "radius": 1},
    "repeat": {"type": "stack", "count": 2, "step": [9, 0, 0]}, "copies": {"1": {"present": false}}}},
    "forces": {"f": {"type": "spring", "a": {"body": "b[1]"}, "b": {}}})");
  REQUIRE(faults.size() == 1);
  CHECK(faults[0].path == "forces.f");
}

TEST_CASE("rolling friction under the event stepper, whether the scene or the user chose it") {
  const std::string bodies = R"("bodies": {
    "floor": {"type": "static", "shape": {"type": "half_space"}, "material": {"rolling_friction": 0.02}},
    "ball": {"shape": {"type": "sphere", "radius": 0.25}, "position": [0, 0.25, 0], "velocity": [1, 0, 0],
      "angular_velocity": [0, 0, -4], "material": {"friction": 0.8, "restitution": 0, "rolling_friction": 0.02}}})";
  for (const char* chosen : {"event", "realtime"}) {
    CAPTURE(chosen);
    BuiltScene s = built(read_scene(
        scene_with(std::string("\"settings\": {\"stepper\": \"") + chosen + "\"}, " + bodies),
        data_file("x.json")));
    WorldSettings settings = s.world->settings();
    settings.stepper = "event";
    REQUIRE(s.world->set_settings(settings).ok());
    for (int i = 0; i < 60; ++i) REQUIRE(s.world->step().ok());
    const double slowing = 5.0 / 7 * 0.02 * s.world->settings().gravity.now().norm() / 0.25;
    const double t = 60 * s.world->settings().tick.tick();
    CHECK(body(s, "ball").v.x() == doctest::Approx(1 - slowing * t).epsilon(1e-9));
  }
}

TEST_CASE("the scene with every key is built and steps") {
  BuiltScene s = built(load_scene(data_file("everything.json")));
  CHECK(s.bodies.size() == 2 + 5 + 8 + 5 + 10 + 2 + 2);
  CHECK(s.forces.size() == 11);
  for (int i = 0; i < 10; ++i) REQUIRE(s.world->step().ok());
  CHECK(s.world->tick() == 10);
  CHECK(s.world->time() == doctest::Approx(10.0 / 120));
  CHECK(body(s, "ball").mass == doctest::Approx(12));
  CHECK(body(s, "brick[1]").mass == doctest::Approx(7));
}

TEST_CASE("building twice gives the same bits" * doctest::test_suite("long")) {
  const SceneRead read = load_scene(data_file("everything.json"));
  CHECK(built(read).world->state_hash() == built(read).world->state_hash());
}

TEST_CASE("a bare mesh file falls on a table") {
  for (const double size : {0.5, 0.25}) {
    const SceneRead read =
        drop_in_scene(data_file("tetra.obj"), {{"parameters.size=" + std::to_string(size)}});
    BuiltScene s = built(read);
    // The tetrahedron of three unit edges has volume 1/6; plastic has 1000 kg/m3.
    CHECK(body(s, "mesh").mass == doctest::Approx(1000 * size * size * size / 6).epsilon(1e-6));
    for (int i = 0; i < 120; ++i) REQUIRE(s.world->step().ok());
    const double y = body(s, "mesh").pose.x.y();
    CHECK(y > 0.4);
    CHECK(y < 0.4 + 0.5 * size);
  }
}

TEST_CASE("what is no mesh file is refused with what would be one") {
  const auto fault = [](const std::filesystem::path& file) {
    const SceneRead read = drop_in_scene(file);
    REQUIRE(read.faults.size() == 1);
    return read.faults[0].text();
  };
  const std::string text = fault("notes.txt");
  CHECK(text.find("notes.txt: this is no scene, pack, robot or mesh") != std::string::npos);
  CHECK(text.find("convert it to one of") != std::string::npos);
  CHECK(text.find("notes.txt") == text.rfind("notes.txt"));
  CHECK(fault("x.tumble").find("x.tumble: this is no pack of a scene") != std::string::npos);
}

TEST_CASE("checking: a scene, a mesh, and what is neither") {
  SceneCheck good = check_scene(data_file("everything.json"));
  INFO(all_text(good.faults));
  CHECK(good.faults.empty());
  CHECK(good.bodies == 34);
  CHECK(check_scene(data_file("tetra.obj")).faults.empty());
  const SceneCheck none = check_scene("no_such_scene");
  REQUIRE(none.faults.size() == 1);
  CHECK(none.faults[0].message.find("unknown scene 'no_such_scene'") != std::string::npos);
}

TEST_CASE("a microscope that cannot look at its bodies is a fault of the scene") {
  const std::string bodies = R"("bodies": {
    "ball": {"shape": {"type": "sphere", "radius": 1}},
    "box": {"shape": {"type": "box", "size": [1, 1, 1]}, "position": [3, 0, 0]},
    "ground": {"type": "static", "shape": {"type": "half_space"}, "position": [0, -2, 0]},
    "pair": {"shapes": [{"type": "box", "size": [1, 1, 1]}, {"type": "sphere", "radius": 1}],
             "position": [9, 0, 0]}},
    "microscope": )";
  const auto refused = [&](const std::string& microscope, const std::string& why) {
    const std::vector<Fault> faults = build_faults(bodies + microscope);
    REQUIRE(faults.size() == 1);
    CHECK(faults[0].path == "microscope");
    CHECK(faults[0].line > 0);
    CHECK(faults[0].message.find(why) != std::string::npos);
  };
  refused(R"({"algorithm": "gjk", "a": "ball", "b": "ground"})", "two convex shapes");
  refused(R"({"algorithm": "v_clip", "a": "ball", "b": "box"})", "two polyhedra");
  refused(R"({"algorithm": "gjk", "a": "ball", "b": "pair"})", "2 shapes");
  refused(R"({"algorithm": "gjk", "a": "ball", "b": "ball"})", "itself");
  refused(R"({"algorithm": "gjk", "a": "ball"})", "body B is missing");
  CHECK(built(bodies + R"({"algorithm": "first_event", "a": "ball"})").microscope->b.is_null());
  // What asks the world may have an answer later: before the first tick there are no contacts.
  for (const std::string algorithm : {"dantzig", "baraff", "first_event", "dfsph"})
    CHECK(built(bodies + R"({"algorithm": ")" + algorithm + R"(", "a": "ball", "b": "box"})")
              .microscope.has_value());
  const BuiltScene s =
      built(bodies + R"({"algorithm": "time_of_contact", "a": "ball", "b": "ground",
                         "velocity_a": [0, -3, 0], "steps_per_second": 2})");
  REQUIRE(s.microscope.has_value());
  CHECK(s.microscope->a == s.bodies.at("ball"));
  CHECK(*s.microscope->velocity[0] == Vec3(0, -3, 0));
  CHECK(s.microscope->step_at(1) == 2);
  const std::vector<Fault> absent =
      build_faults(R"("bodies": {"a": {"shape": {"type": "sphere", "radius": 1},
    "repeat": {"type": "stack", "count": 3, "step": [0, 3, 0]}, "copies": {"1": {"present": false}}}},
    "microscope": {"algorithm": "gjk", "a": "a[0]", "b": "a[1]"})");
  REQUIRE(absent.size() == 1);
  CHECK(absent[0].path == "microscope.b");
  CHECK(absent[0].message == "'a[1]' is not present");
}

TEST_CASE("what is probably not meant is warned of, with its name, and nothing else is") {
  const auto warnings = [](const std::string& members) {
    const SceneRead read = read_scene(scene_with(members), "x.json");
    REQUIRE_MESSAGE(read.ok(), all_text(read.faults));
    const auto built = build_world(read.scene);
    REQUIRE_MESSAGE(built.ok(), test::why_not(built));
    return built->warnings;
  };
  const auto says = [&](const std::string& members, const std::string& part) {
    const auto lines = warnings(members);
    REQUIRE_MESSAGE(lines.size() == 1, members);
    CHECK_MESSAGE(lines[0].find(part) != std::string::npos, lines[0]);
  };
  const std::string ball = R"({"shape": {"type": "sphere", "radius": 0.3}, "position": [)";
  const std::string two =
      R"("bodies": {"a": )" + ball + R"(0, 1, 0]}, "b": )" + ball + R"(2, 1, 0]}},)";
  const std::string rod = R"("joints": {"j": {"kind": "distance", "a": "a", "b": "b")";
  CHECK(warnings(two + rod + "}}").empty());
  CHECK(warnings(two + rod + R"(, "length": 2.001}})").empty());
  says(two + rod + R"(, "length": 1e6}})",
       "joints.j: length is 1e+06 m, but its ends are 2 m apart");
  const std::string spring = R"("forces": {"s": {"type": "spring", "a": {"body": "a"}, "b": )";
  CHECK(warnings(two + spring + R"({"body": "b"}}})").empty());
  says(two + spring + R"({"body": "a"}}})", "forces.s: a spring from a point to itself");
  const std::string ground = R"("g": {"type": "static", "shape": {"type": "half_space"}}, )";
  CHECK(warnings(R"("bodies": {)" + ground + R"("a": )" + ball + "0, 0.3, 0]}}").empty());
  says(R"("bodies": {)" + ground + R"("a": )" + ball + "0, -30, 0]}}",
       "bodies.a: begins 30 m below the surface of 'g'");
  const std::string table =
      R"("table": {"type": "static", "shape": {"type": "box", "size": [2, 0.1, 1]}})";
  says(R"("bodies": {)" + table +
           R"(, "a": {"shape": {"type": "box", "size": [520, 1, 1]}, "position": [0, 5, 0]}})",
       "bodies.a: is 520 m large, and the others about 2.24 m");
}

TEST_CASE("realtime: a rod that is a thousand kilometres too long pushes its ends apart slowly") {
  // Reference: the bound on the speed of correction, 10 m/s between the two ends.
  const std::string ball = R"({"shape": {"type": "sphere", "radius": 0.3}, "position": [)";
  const BuiltScene s = built(R"("settings": {"gravity": [0, 0, 0]}, "bodies": {"a": )" + ball +
                             R"(0, 1, 0]}, "b": )" + ball + R"(2, 1, 0]}}, "joints": {"j": )" +
                             R"({"kind": "distance", "a": "a", "b": "b", "length": 1e6}})");
  const auto apart = [&] {
    return (s.world->body(s.bodies.at("b"))->pose.x - s.world->body(s.bodies.at("a"))->pose.x)
        .norm();
  };
  for (int tick = 1; tick <= 20; ++tick) {
    REQUIRE(s.world->step().ok());
    CHECK(apart() <= 2 + 10 * tick / 60.0 + 1e-3);
  }
  CHECK(apart() > 4);
}
