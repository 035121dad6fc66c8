// Reference: the file and the state hash before building, after taking everything back, and after
// opening what was saved; the period of a compound pendulum by its formula.
#include "engine/scene/reader.hpp"
#include "tests/viewer/ui/laboratory.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

using namespace tumble;
using namespace tumble::test;

namespace {

/// The scene's file as it was saved, which opens.
SceneDescription saved_scene(Laboratory& b) {
  b.save();
  SceneRead read = read_scene(b.content(), b.file);
  for (const Fault& fault : read.faults) FAIL_CHECK(fault.text());
  REQUIRE(read.ok());
  return std::move(read.scene);
}

}  // namespace

TEST_CASE("a body that a joint, a spring, a camera and a plot refer to is deleted and comes back") {
  Laboratory b;
  const std::string text = R"({
  "tumble_scene": 1,
  "bodies": {
    "ground": { "type": "static", "shape": { "type": "half_space" } },
    "ball": { "shape": { "type": "sphere", "radius": 0.4 }, "position": [0, 1.5, 0] },
    "box": { "shape": { "type": "box", "size": [0.5, 0.5, 0.5] }, "position": [1.5, 1.5, 0] }
  },
  "joints": { "hinge": { "kind": "revolute", "a": "ball", "b": "box", "anchor": [0.7, 0, 0] } },
  "forces": { "spring": { "type": "spring", "a": { "body": "ball" }, "b": { "point": [0, 4, 0] } } },
  "sensors": { "on": { "type": "region", "radius": 2, "body": "ball" } },
  "assertions": [{ "holds": "bodies.ball.position.y > -9", "always": true }],
  "cameras": { "main": { "position": [0, 2.5, 9], "target": [0, 1.5, 0], "follow": "ball" } },
  "lesson": { "steps": [{ "title": "one", "text": ["Look."], "plot": ["bodies.ball.position.y"] }] }
}
)";
  REQUIRE(write_file(b.file, std::string_view(text)).ok());
  b.rig.app->open(b.file);
  b.play("wait 3\nkey I\nwait 3");
  const uint64_t before = b.hash();
  REQUIRE(b.rig.app->locate("parts.forces.spring").has_value());
  b.play("click body:ball\nwait 3\nkey Del\nwait 5");
  CHECK(b.world().find_body("ball").is_null());
  CHECK(b.world().find_joint("hinge").is_null());
  CHECK(b.world().frame()->forces.empty());
  const auto sensors = b.world().frame()->sensors;
  CHECK((!sensors || sensors->empty()));
  for (const char* words : {"joint hinge", "force spring", "sensor on", "follow of camera main"})
    CHECK_MESSAGE(says(b.rig, words), words);
  CHECK_FALSE(b.rig.app->locate("parts.forces.spring").has_value());
  CHECK_FALSE(b.rig.app->locate("parts.sensors.on").has_value());
  const SceneDescription saved = saved_scene(b);
  CHECK(saved.bodies.names() == std::vector<std::string>{"ground", "box"});
  CHECK(saved.joints.empty());
  CHECK(saved.forces.empty());
  CHECK(saved.assertions.empty());
  REQUIRE(saved.cameras.find("main"));
  CHECK(saved.cameras.find("main")->follow.empty());
  // One undo step: taken back once, all is there again, and the file is what it was.
  b.play("key Ctrl+Z\nwait 3");
  CHECK(b.hash() == before);
  CHECK(b.rig.app->locate("parts.forces.spring").has_value());
  b.save();
  CHECK(b.content() == text);
  check_no_faults(*b.device);
}

TEST_CASE(
    "a body is called otherwise wherever it is named, at the same moment, and as before again") {
  Laboratory b;
  const std::string text = R"({
  "tumble_scene": 1,
  "bodies": {
    "ground": { "type": "static", "shape": { "type": "half_space" } },
    "ball": { "shape": { "type": "sphere", "radius": 0.4 }, "position": [0, 1.5, 0] }, // round
    "ballast": { "shape": { "type": "box", "size": [0.5, 0.5, 0.5] }, "position": [1.5, 1.5, 0] }
  },
  "joints": { "ball": { "kind": "revolute", "a": "ball", "b": "ballast", "anchor": [0.7, 0, 0] } },
  "forces": { "pull": { "type": "attractor", "strength": 1, "bodies": ["ball", "ballast"] } },
  "sensors": { "on": { "type": "region", "radius": 2, "body": "ball" } },
  "assertions": [
    { "holds": "bodies.ball.position.y + bodies.ballast.position.y + joints.ball.angle > -9 * sensors.on.holds.ball",
      "always": true }],
  "cameras": { "main": { "position": [0, 2.5, 9], "target": [0, 1.5, 0], "follow": "ball" } },
  "lesson": { "steps": [{ "title": "ball", "text": ["The ball."], "plot": ["bodies.ball.position.y"] }] }
}
)";
  REQUIRE(write_file(b.file, std::string_view(text)).ok());
  b.rig.app->open(b.file);
  b.play("wait 3");
  REQUIRE(b.rig.app->session().advance(5).ok());
  b.play("wait 3\nclick body:ball\nwait 3");
  const Vec3 x = place(b, "ball");
  for (const char* wrong : {"ballast", "two words", "a.b"}) {
    b.rig.app->ui_state().toasts.clear();
    b.set("inspector.name", wrong);
    CHECK_MESSAGE(says(b.rig, "cannot be called"), wrong);
  }
  b.set("inspector.name", "stone");
  CHECK(b.rig.tick() == 5);
  CHECK(b.world().find_body("ball").is_null());
  REQUIRE_FALSE(b.world().find_body("stone").is_null());
  CHECK(b.rig.app->selected() == b.world().find_body("stone"));
  CHECK(place(b, "stone") == x);
  const SceneDescription saved = saved_scene(b);
  CHECK(saved.bodies.names() == std::vector<std::string>{"ground", "stone", "ballast"});
  CHECK(saved.cameras.find("main")->follow == "stone");
  const std::string content = b.content();
  CHECK(content.find("// round") != std::string::npos);
  CHECK(content.find(R"("joints": { "ball": { "kind": "revolute", "a": "stone", "b": "ballast")") !=
        std::string::npos);
  CHECK(content.find(R"(["stone", "ballast"])") != std::string::npos);
  CHECK(content.find("bodies.stone.position.y + bodies.ballast.position.y + joints.ball.angle > "
                     "-9 * sensors.on.holds.stone") != std::string::npos);
  CHECK(content.find(R"("title": "ball")") != std::string::npos);
  b.rig.app->open(b.file);
  b.play("wait 3");
  REQUIRE_FALSE(b.world().find_body("stone").is_null());
  check_no_faults(*b.device);
}

TEST_CASE("the name of a body that was built is taken back like all else") {
  Laboratory b;
  b.body("sphere", "sphere");
  b.set("inspector.name", "pea");
  REQUIRE_FALSE(b.world().find_body("pea").is_null());
  b.play("key Ctrl+Z\nwait 3");
  REQUIRE_FALSE(b.world().find_body("sphere").is_null());
  b.play("key Ctrl+Shift+Z\nwait 3");
  REQUIRE_FALSE(b.world().find_body("pea").is_null());
  b.save();
  CHECK(b.content().find("\"pea\": {") != std::string::npos);
  CHECK(b.content().find("\"sphere\": {") == std::string::npos);
  check_no_faults(*b.device);
}

TEST_CASE("a body gets one more shape, which is moved and turned, and loses one") {
  Laboratory b;
  b.body("box", "box");
  b.play("click inspector.add_shape\nwait 2\nclick inspector.add_shape.capsule\nwait 3");
  const auto shapes = [&] { return b.world().body_def(b.world().find_body("box"))->shapes; };
  REQUIRE(shapes().size() == 2);
  b.play("click inspector.shape.1\nwait 3");
  b.set("inspector.shape.1.position.x", "0.25");
  b.set("inspector.shape.1.euler_deg.z", "30");
  CHECK(shapes()[1].pose.x.x() == 0.25);
  const Vec3 axis = shapes()[1].pose.q * Vec3::UnitY();
  CHECK((axis - Vec3(-0.5, std::sqrt(0.75), 0)).norm() < 1e-12);
  SUBCASE("both stay") {}
  SUBCASE("the first goes, and the mass with it") {
    b.play("click inspector.shape.0\nwait 3\nclick inspector.shape.0.remove\nwait 3");
    REQUIRE(shapes().size() == 1);
    CHECK(shapes()[0].shape.type == ShapeType::capsule);
    CHECK_FALSE(b.rig.app->ui().find("inspector.shape.0.remove"));
  }
  SUBCASE("the new one is of another material, and a third comes") {
    b.set("inspector.shape.1.friction", "0.125");
    b.play("click inspector.add_shape\nwait 2\nclick inspector.add_shape.sphere\nwait 3");
    REQUIRE(shapes().size() == 3);
    CHECK(shapes()[1].material.friction == 0.125);
    CHECK(shapes()[2].material.friction != 0.125);
  }
  // Saved and opened again it is the same to rounding, which the way over the centre of mass
  // brings.
  const auto built = shapes();
  const double mass = b.world().body(b.world().find_body("box"))->mass;
  b.save();
  const std::string saved = b.content();
  for (int i = 0; i < 100 && !says(b.rig, "nothing to take back"); ++i) b.rig.play("key Ctrl+Z");
  CHECK(b.hash() == b.start_hash);
  b.save();
  CHECK(b.content() == b.start);
  REQUIRE(write_file(b.file, std::string_view(saved)).ok());
  b.rig.app->open(b.file);
  b.play("wait 3");
  const auto opened = shapes();
  REQUIRE(opened.size() == built.size());
  CHECK(b.world().body(b.world().find_body("box"))->mass == doctest::Approx(mass).epsilon(1e-12));
  for (size_t i = 0; i < built.size(); ++i) {
    CHECK(opened[i].shape.type == built[i].shape.type);
    CHECK(opened[i].shape.radius == built[i].shape.radius);
    CHECK((opened[i].pose.x - built[i].pose.x).norm() < 1e-12);
    CHECK(opened[i].pose.q.angularDistance(built[i].pose.q) < 1e-12);
    CHECK(opened[i].material.friction == built[i].material.friction);
  }
  check_no_faults(*b.device);
}

TEST_CASE(
    "a fluid whose floor was deleted is not saved, with the fault at its line, until that is "
    "back") {
  Laboratory b;
  const std::string text = R"({
  "tumble_scene": 1,
  "bodies": {
    "ground": { "type": "static", "shape": { "type": "box", "size": [2, 0.2, 2] },
                "position": [0, -0.1, 0] },
    "ball": { "shape": { "type": "sphere", "radius": 0.2 }, "position": [2, 5, 0] }
  },
  "particles": {
    "water": { "fluid": {},
               "fill": [{ "type": "lattice", "centre": [0, 0.3, 0], "size": [0.2, 0.2, 0.2],
                          "spacing": 0.1 }] }
  },
  "cameras": { "main": { "position": [0, 2.5, 9], "target": [0, 1.5, 0] } }
}
)";
  REQUIRE(write_file(b.file, std::string_view(text)).ok());
  b.rig.app->open(b.file);
  b.play("wait 3");
  REQUIRE_FALSE(b.world().find_body("ground").is_null());
  b.play("click body:ground\nwait 3\nkey Del\nwait 3");
  REQUIRE(b.world().find_body("ground").is_null());  // it falls: let them see
  REQUIRE(b.rig.app->session().advance(3).ok());
  b.play("wait 2\nkey Ctrl+S\nwait 3");
  // There is nothing to be written, and no other folder would help.
  CHECK_FALSE(b.rig.app->ui().find("save.write"));
  b.play("key Ctrl+S\nwait 3");
  const std::string fault = b.rig.app->ui_state().save_fault;
  CHECK_MESSAGE(fault.find("nothing contains this fluid") != std::string::npos, fault);
  CHECK_MESSAGE(fault.find("mine.json:7: particles.water") != std::string::npos, fault);
  CHECK(b.content() == text);
  b.play("key Esc\nwait 2\nkey Ctrl+Z\nwait 3");
  REQUIRE_FALSE(b.world().find_body("ground").is_null());
  b.body("box", "box");
  b.save();
  CHECK(b.content() != text);
  check_no_faults(*b.device);
}

TEST_CASE("springs keep names of their own when one was deleted, saved and opened again") {
  Laboratory b;
  b.body("box", "box");
  b.play("click inspector.group.0\nwait 3");
  b.set("inspector.position", Vec3(-1, 1.5, 0));
  b.body("box", "box_2");
  b.set("inspector.position", Vec3(1, 1.5, 0));
  const auto spring = [&](const char* on, double x) {
    b.play(
        fmt::format("click build.spring\nwait 2\nclick body:{}\nwait 2\nclick {}\nwait 4\n"
                    "key Esc\nwait 2",
                    on, b.at({x, 3.5, 0})));
  };
  spring("box", -1);
  spring("box_2", 1);
  CHECK(saved_scene(b).forces.names() == std::vector<std::string>{"spring", "spring_2"});
  b.play("key I\nwait 3\nclick parts.forces.spring\nwait 3\nclick parts.delete\nwait 3");
  CHECK(saved_scene(b).forces.names() == std::vector<std::string>{"spring_2"});
  b.rig.app->open(b.file);
  b.play("wait 3");
  spring("box", -0.8);
  spring("box", -1.2);
  const auto names = saved_scene(b).forces.names();
  CHECK(names == std::vector<std::string>{"spring_2", "spring", "spring_3"});
  CHECK(b.world().frame()->forces.size() == 3);
  check_no_faults(*b.device);
}

TEST_CASE("a new scene has a floor, and is saved to the name that one gives it") {
  Laboratory b;
  b.play("key Space\nwait 3\nkey Ctrl+N\nwait 30");
  CHECK(b.rig.app->title() == "New scene");
  // It stands still while one builds.
  CHECK(b.rig.app->session().paused());
  CHECK(b.rig.tick() == 0);
  CHECK(says(b.rig, "Space lets it run"));
  CHECK_FALSE(b.world().find_body("floor").is_null());
  b.play("key B\nwait 3\nkey B\nwait 3");
  b.play("click build.sphere\nwait 2\nclick " + b.at({0, 0, 0}) + "\nwait 3\nkey Esc\nwait 2");
  REQUIRE_FALSE(b.world().find_body("sphere").is_null());
  const uint64_t built = b.hash();
  const std::string name = (b.rig.folder.path() / "first.json").string();
  b.play("key Ctrl+S\nwait 3\nclick save.file\nwait 2\nkey Ctrl+A\ntext " + name +
         "\nwait 2\nclick save.write\nwait 3");
  REQUIRE(std::filesystem::exists(name));
  CHECK(read_file(new_scene_file())->find("sphere") == std::string::npos);
  b.rig.app->open(name);
  b.play("wait 3");
  CHECK(b.hash() == built);
  check_no_faults(*b.device);
}

TEST_CASE("a pendulum clock is built in the window: it swings at its period and counts") {
  Laboratory b;
  b.type("static");
  b.play("click build.material\nwait 2\nclick build.material.wood\nwait 2");
  b.body("box", "box");  // the case
  b.play("click inspector.group.0\nwait 3\nclick inspector.shape.0\nwait 3");
  b.set("inspector.shape.0.size", Vec3(0.8, 2.2, 0.1));
  b.set("inspector.position", Vec3(0, 1.1, -0.2));
  b.type("dynamic");
  b.play("click build.material\nwait 2\nclick build.material.steel\nwait 2");
  b.body("box", "box_2");  // the rod
  b.set("inspector.shape.0.size", Vec3(0.04, 1, 0.04));
  b.set("inspector.position", Vec3(0, 1.2, 0));
  b.body("cylinder", "cylinder");  // the bob
  b.play("click inspector.shape.0\nwait 3");
  b.set("inspector.shape.0.radius", "0.15");
  b.set("inspector.shape.0.height", "0.06");
  b.set("inspector.position", Vec3(0, 0.7, 0.07));
  b.set("inspector.euler_deg.x", "90");
  b.body("box", "box_3");  // the hand
  b.set("inspector.shape.0.size", Vec3(0.03, 0.2, 0.02));
  b.set("inspector.position", Vec3(0, 2.0, 0));
  // The rod hangs on the case, the bob on the rod; a motor turns the hand.
  b.play("click build.revolute\nwait 2\nclick " + b.at({0, 1.65, 0.02}) + "\nwait 2\nclick " +
         b.at({0.3, 1.5, -0.15}) + "\nwait 3");
  b.play("click build.rigid\nwait 2\nclick body:cylinder\nwait 2\nclick " + b.at({0, 1.2, 0.02}) +
         "\nwait 3");
  b.play("click build.motor\nwait 2\nclick " + b.at({0, 1.95, 0.01}) + "\nwait 2\nclick " +
         b.at({0.3, 1.5, -0.15}) + "\nwait 3\nkey Esc\nwait 2");
  REQUIRE(b.world().frame()->joints->size() == 3);
  // A gate where the bob goes through, across its way.
  b.part("gate", b.at({0, 0, 3.5}));
  b.set("part.position", Vec3(0, 0.7, 0.07));
  b.set("part.euler_deg.z", "-90");
  b.set("part.size.0", "0.6");
  b.set("part.size.1", "0.6");
  b.play("click body:cylinder\nwait 3");
  b.play("click inspector.group.1\nwait 3");
  b.set("inspector.velocity.x", "0.4");
  b.check_round_trip(0);
  // The period of small swings: of the rod with the bob, about the pivot.
  const auto& frame = *b.world().frame();
  double moment = 0, inertia = 0;
  double pivot = 0;
  for (const JointFrame& joint : *frame.joints)
    if (joint.name == "revolute_1") pivot = joint.frame_b.x.y();
  for (const char* name : {"box_2", "cylinder"}) {
    const BodyId id = b.world().find_body(name);
    const RigidBody& body = *b.world().body(id);
    const double arm = pivot - body.pose.x.y(), m = 1 / body.inverse_mass;
    const double own = 1 / (body.inverse_inertia_world()(2, 2));
    moment += m * arm;
    inertia += own + m * arm * arm;
  }
  REQUIRE(pivot > 1.5);
  const double period = 2 * std::numbers::pi * std::sqrt(inertia / (9.81 * moment));
  constexpr int swings = 6;
  const double tick = frame.rate.tick();
  REQUIRE(b.rig.app->session().advance(uint64_t((swings + 0.25) * period / tick)).ok());
  b.play("wait 2");
  const SensorFrame& gate = b.world().frame()->sensors->at(0);
  CHECK(gate.forward + gate.backward >= 2 * swings - 1);
  CHECK(gate.forward + gate.backward <= 2 * swings + 1);
  // The hand has gone on at its rate.
  const double turned = b.world().time() * 0.5 * std::numbers::pi;
  double angle = 0;
  for (const JointFrame& joint : *b.world().frame()->joints)
    if (joint.name == "revolute_2") angle = joint.coordinates[0].value;
  CHECK(std::abs(std::abs(angle) - turned) < 0.02 * turned);
  check_no_faults(*b.device);
}

TEST_CASE("who clicks twice on one place builds one body there, and stays where they look from") {
  Laboratory b;
  const Vec3 target = b.rig.app->camera().camera().target;
  const std::string place = b.at({0, 0, 3.5});
  const auto built = [&](const char* name) { return !b.world().find_body(name).is_null(); };
  b.play("click build.sphere\nwait 2\ndouble_click " + place + "\nwait 3");
  CHECK(built("sphere"));
  CHECK_FALSE(built("sphere_2"));
  CHECK(b.rig.app->camera().camera().target == target);
  // After a click on the panel a click is a new one, however soon.
  b.play("click build.sphere\nwait 2\nclick build.sphere\nclick " + place + "\nwait 3");
  CHECK(built("sphere_2"));
  check_no_faults(*b.device);
}

TEST_CASE("a new scene in which joints, springs and sources were built begins with them after R") {
  Laboratory b;
  b.body("box", "box");
  b.play("click inspector.group.0\nwait 3");
  b.set("inspector.position", Vec3(0, 2, 0));
  b.play("click build.revolute\nwait 2\nclick body:box\nwait 2\nclick " + b.at({0, 3.5, 0}) +
         "\nwait 4\nkey Esc\nwait 2");
  b.play("click build.spring\nwait 2\nclick body:box\nwait 2\nclick " + b.at({1, 3.5, 0}) +
         "\nwait 4\nkey Esc\nwait 2");
  const auto built = b.world().frame();
  REQUIRE(built->joints->size() == 1);
  REQUIRE(built->forces.size() == 1);
  const uint64_t before = b.hash();
  b.play("key Space\nwait 30\nkey Space\nwait 3");
  REQUIRE(b.hash() != before);
  b.play("key R\nwait 3");
  CHECK(b.hash() == before);
  // The same world as the saved file makes, and the next box has a name of its own.
  b.save();
  CHECK(b.content().find("\"spring\"") != std::string::npos);
  b.play("key R\nwait 3");
  CHECK(b.hash() == before);
  b.body("box", "box_2");
  CHECK(saved_scene(b).bodies.names() == std::vector<std::string>{"ground", "box", "box_2"});
  check_no_faults(*b.device);
}

TEST_CASE("what the file says once for all copies cannot be changed in the panel of one of them") {
  Laboratory b;
  const std::string text = R"({
  "tumble_scene": 1,
  "bodies": {
    "ground": { "type": "static", "shape": { "type": "half_space" } },
    "row": { "shape": { "type": "box", "size": [1, 1, 1] }, "position": [0, 0.5, 0],
             "repeat": { "type": "grid", "count": [2, 1, 1], "spacing": [3, 1, 1] } }
  },
  "cameras": { "main": { "position": [0, 2.5, 9], "target": [0, 1.5, 0] } }
}
)";
  REQUIRE(write_file(b.file, std::string_view(text)).ok());
  b.rig.app->open(b.file);
  b.play("wait 3\nkey B\nclick body:row[1]\nwait 3\nclick inspector.group.1\nwait 3");
  const BodyId id = b.world().find_body("row[1]");
  REQUIRE(b.rig.app->selected() == id);
  REQUIRE(b.world().body(id)->can_sleep);
  b.play("click inspector.can_sleep\nwait 3");
  CHECK(b.world().body(id)->can_sleep);
  // What each has for itself can.
  b.set("inspector.mass", "77");
  CHECK(b.world().body(id)->mass == doctest::Approx(77));
  check_no_faults(*b.device);
}

TEST_CASE("building ends when its panel is closed by its button") {
  Laboratory b;
  b.play("click build.revolute\nwait 2\nclick build.close\nwait 2");
  CHECK_FALSE(b.rig.app->ui_state().building);
  b.play("key B\nwait 2\nclick build.box\nwait 2\nclick build.close\nwait 2\nclick " +
         b.at({0, 0, 3.5}) + "\nwait 3");
  CHECK(b.hash() == b.start_hash);
  check_no_faults(*b.device);
}

TEST_CASE(
    "what a part names is chosen from what the scene has, and typed text is taken when left") {
  Laboratory b;
  b.body("sphere", "sphere");
  b.play("key X\nwait 2\nkey X\nwait 2");
  b.body("box", "box");
  b.part("emitter", b.at({0, 0, 1}));
  const auto emitter = [&] { return *saved_scene(b).emitters.find("emitter"); };
  REQUIRE(emitter().body == "box");
  b.play("click part.body.names\nwait 2\nclick part.body.sphere\nwait 4");
  CHECK(emitter().body == "sphere");
  b.play("click part.carrier\nwait 2\ntext box\nclick parts.emitters.emitter\nwait 4");
  CHECK(emitter().carrier == "box");
  b.play("click part.carrier\nwait 2\ntext nonsense\nkey Esc\nwait 4");
  CHECK(emitter().carrier == "box");
  check_no_faults(*b.device);
}
