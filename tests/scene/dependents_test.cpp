// Hostile edits of a scene's file: what everything names is taken away, and what is left opens.
// Reference: lists of what has to go and what has to stay, written out here; the reader of scenes.
#include "engine/scene/build.hpp"
#include "engine/scene/saving/scene_edits.hpp"
#include "tests/scene/scene_text.hpp"
#include "tests/support/why_not.hpp"

#include <algorithm>

using namespace tumble;

namespace {

const std::string scene_text = R"({
  "tumble_scene": 1,
  "bodies": {
    "ball": { "shape": { "type": "sphere", "radius": 0.5 }, "position": [0, 5, 0] },
    // Stays.
    "box": { "shape": { "type": "box", "size": [1, 1, 1] } },
    "link": { "shape": { "type": "sphere", "radius": 0.1 }, "position": [9, 9, 0],
              "repeat": { "type": "stack", "count": 3, "step": [0.3, 0, 0] } }
  },
  "joints": {
    "hinge": { "kind": "revolute", "a": "ball", "b": "box" },
    "axle": { "kind": "revolute", "b": "box", "couple": { "joint": "hinge", "ratio": 2 } },
    "chain": { "kind": "spherical", "count": 2, "a": "link[i]", "b": "link[i+1]" }
  },
  "forces": {
    "rope": { "type": "spring", "a": { "body": "ball" }, "b": { "point": [0, 9, 0] } },
    "on_both": { "type": "attractor", "strength": 1, "bodies": ["ball", "box"] },
    "on_one": { "type": "attractor", "strength": 1, "bodies": ["ball"] },
    "bond": { "type": "repulsor", "particles": ["dust"] }
  },
  "particles": {
    "dust": { "fast": true },
    "flag": { "cloth": { "corner": [0, 9, 9], "across": [1, 0, 0], "down": [0, 0, 1], "columns": 4,
                         "rows": 4, "density": 1,
                         "pins": ["left", { "row": 3, "column": 3, "body": "ball" }] } }
  },
  "emitters": {
    "sparks": { "particles": "dust", "rate": 1, "life": 1 },
    "jet": { "particles": "dust", "rate": 1, "life": 1, "carrier": "ball",
             "events": [{ "event": "death", "emitter": "sparks", "count": 1 }] },
    "copies": { "body": "ball", "rate": 1, "life": 1 }
  },
  "sinks": { "drain": { "type": "sphere", "radius": 1, "particles": ["dust"] } },
  "sensors": {
    "touch": { "type": "contact", "a": "ball", "b": "box" },
    "near": { "type": "region", "radius": 2 },
    "on": { "type": "region", "radius": 2, "body": "ball" }
  },
  "assertions": [
    { "holds": "bodies.ball.position.y > 1", "always": true },
    { "holds": "bodies.box.position.y < 9", "always": true },
    { "holds": "sensors.near.holds.ball == 0", "at": 1 },
    { "holds": "sensors.touch.touching == 0", "at": 1 }
  ],
  "cameras": {
    "main": { "position": [0, 0, 9], "target": [0, 0, 0], "follow": "ball" }
  },
  "microscope": { "algorithm": "gjk", "a": "ball", "b": "box" },
  "lesson": {
    "steps": [
      { "title": "one", "text": ["Look."], "camera": "main",
        "plot": ["bodies.ball.position.y", "time"] },
      { "title": "two", "text": ["Say."], "plot": ["joints.hinge.angle"],
        "question": { "ask": "How high?", "quantity": "bodies.ball.position.y", "at": 1,
                      "tolerance": 0.1 } }
    ]
  }
}
)";

/// The text after a removal, which opens, and what went along.
std::string without(const SceneEdit& removal, std::vector<std::string>& along,
                    const std::string& from = scene_text) {
  const SceneRead before = read_scene(from, "x.json");
  REQUIRE_MESSAGE(before.ok(), all_text(before.faults));
  along.clear();
  for (const TakenAlong& one : taken_along(from, {}, removal)) along.push_back(one.words());
  const std::vector<SceneEdit> edits{removal};
  const auto saved = save_edits(from, "x.json", edits);
  REQUIRE_MESSAGE(saved.ok(), test::why_not(saved));
  const SceneRead read = read_scene(saved->text, "x.json");
  REQUIRE_MESSAGE(read.ok(), all_text(read.faults));
  WorldDef extras;
  extras.threads = 1;
  const auto built = build_world(read.scene, extras);
  REQUIRE_MESSAGE(built.ok(), test::why_not(built));
  return saved->text;
}

bool has(const std::vector<std::string>& list, const std::string& line) {
  return std::ranges::find(list, line) != list.end();
}

}  // namespace

TEST_CASE("a body that everything names is deleted, and the file opens") {
  std::vector<std::string> along;
  const std::string text = without(RemovedBody{"ball"}, along);
  CHECK(text.find("\"ball\"") == std::string::npos);
  CHECK(text.find("// Stays.") != std::string::npos);
  CHECK(text.find("\"sparks\"") != std::string::npos);
  CHECK(text.find("\"axle\": { \"kind\": \"revolute\", \"b\": \"box\" }") != std::string::npos);
  CHECK(text.find("\"bodies\": [\"box\"]") != std::string::npos);
  CHECK(text.find("\"pins\": [\"left\"]") != std::string::npos);
  CHECK(text.find("\"plot\": [\"time\"]") != std::string::npos);
  CHECK(text.find("question") == std::string::npos);
  CHECK(text.find("microscope") == std::string::npos);
  for (const char* line :
       {"joint hinge", "couple of joint axle", "force rope", "force on_one",
        "bodies[0] of force on_both", "emitter jet", "emitter copies", "sensor touch", "sensor on",
        "an assertion", "follow of camera main", "microscope", "steps[1].question of lesson"})
    CHECK_MESSAGE(has(along, line), line);
  CHECK(std::ranges::count(along, "an assertion") == 3);
  CHECK_FALSE(has(along, "sensor near"));
}

TEST_CASE("a particle system takes along what cannot be without it") {
  std::vector<std::string> along;
  const std::string text = without(RemovedPart{"dust", ParticleSystemDescription{}}, along);
  for (const char* line : {"emitter sparks", "emitter jet", "sink drain", "force bond"})
    CHECK_MESSAGE(has(along, line), line);
  CHECK(along.size() == 4);
  CHECK(text.find("\"copies\"") != std::string::npos);
}

TEST_CASE("an emitter that another calls goes without it, a joint that another follows, too") {
  std::vector<std::string> along;
  const std::string text = without(RemovedPart{"sparks", EmitterDescription{}}, along);
  CHECK(along == std::vector<std::string>{"events of emitter jet"});
  CHECK(text.find("\"jet\"") != std::string::npos);
  (void)without(RemovedJoint{"hinge"}, along);
  CHECK(has(along, "couple of joint axle"));
}

TEST_CASE("a copy that one of several joints holds stays in the file, and that is said") {
  const std::vector<SceneEdit> edits{RemovedBody{"link[1]"}};
  const auto saved = save_edits(scene_text, "x.json", edits);
  REQUIRE_MESSAGE(saved.ok(), test::why_not(saved));
  CHECK(saved->text == scene_text);
  REQUIRE(saved->left_out.size() == 1);
  CHECK(saved->left_out[0].find("joints.chain") != std::string::npos);
}

TEST_CASE("a copy is held by joints whose number is an expression") {
  const std::string text = R"({
  "tumble_scene": 1,
  "parameters": { "links": 4 },
  "bodies": {
    "link": { "shape": { "type": "sphere", "radius": 0.1 },
              "repeat": { "type": "stack", "count": "= links", "step": [0.3, 0, 0] } }
  },
  "joints": {
    "chain": { "kind": "spherical", "count": "= links - 1", "a": "link[i]", "b": "link[i+1]" }
  }
}
)";
  std::vector<std::string> along;
  CHECK(without(RemovedBody{"link[2]"}, along, text) == text);
  CHECK(along.empty());
  const std::string none = without(RemovedBody{"link"}, along, text);
  CHECK(along == std::vector<std::string>{"joint chain"});
}

TEST_CASE("what acts on something still loses a name and stays") {
  const std::string text = R"({
  "tumble_scene": 1,
  "bodies": { "ball": { "shape": { "type": "sphere", "radius": 0.5 } } },
  "forces": { "pull": { "type": "attractor", "strength": 1, "bodies": ["ball"],
                        "particles": ["dust"] } },
  "particles": { "dust": { "detect": true } },
  "emitters": {
    "sparks": { "particles": "dust", "rate": 1, "life": 1 },
    "rain": { "particles": "dust", "position": [0, 5, 0], "rate": 1, "life": 1,
              "events": [{ "event": "collision", "emitter": "sparks", "dies": true }] }
  },
  "sinks": { "drain": { "type": "sphere", "radius": 1, "takes": "both", "particles": ["dust"] } },
  "sensors": { "eye": { "type": "region", "radius": 2, "bodies": ["ball"],
                        "particles": ["dust"] } }
}
)";
  std::vector<std::string> along;
  std::string left = without(RemovedBody{"ball"}, along, text);
  CHECK(along == std::vector<std::string>{"bodies of force pull", "bodies of sensor eye"});
  left = without(RemovedPart{"dust", ParticleSystemDescription{}}, along, text);
  for (const char* line : {"particles of force pull", "particles of sensor eye",
                           "particles of sink drain", "emitter sparks", "emitter rain"})
    CHECK_MESSAGE(has(along, line), line);
  CHECK(left.find("\"takes\": \"bodies\"") != std::string::npos);
  // Of an event of which particles die, this stays.
  left = without(RemovedPart{"sparks", EmitterDescription{}}, along, text);
  CHECK(along == std::vector<std::string>{"events[0].emitter of emitter rain"});
  CHECK(left.find("{ \"event\": \"collision\", \"dies\": true }") != std::string::npos);
}

TEST_CASE("assertions in short go, and those about forces that particles make for themselves") {
  const std::string head = R"({
  "tumble_scene": 1,
  "bodies": { "ball": { "shape": { "type": "sphere", "radius": 0.5 } } },
  "particles": { "flag": { "list": [[0, 1, 0], [1, 1, 0]],
                           "springs": { "reach": 2, "stiffness": 10 } } },
  "assertions": )";
  std::vector<std::string> along;
  std::string left = without(RemovedBody{"ball"}, along,
                             head + "[\"bodies.ball.position.y > 1\", \"time > 0\"]\n}\n");
  CHECK(along == std::vector<std::string>{"an assertion"});
  CHECK(left.find("[\"time > 0\"]") != std::string::npos);
  left = without(RemovedBody{"ball"}, along, head + "\"bodies.ball.position.y > 1\"\n}\n");
  CHECK(along == std::vector<std::string>{"an assertion"});
  CHECK(left.find("assertions") == std::string::npos);
  left = without(RemovedPart{"flag", ParticleSystemDescription{}}, along,
                 head + "[\"ledger.forces.flag.springs[0].potential >= 0\"]\n}\n");
  CHECK(along == std::vector<std::string>{"an assertion"});
}

TEST_CASE("bodies that the file does not have are deleted without a trace in it") {
  std::vector<std::string> along;
  CHECK(without(RemovedBody{"copies[12]"}, along) == scene_text);
  const std::vector<SceneEdit> edits{RemovedBody{"copies[3]"}, RemovedBody{"arm.hand"},
                                     RemovedBody{"box[2]"},
                                     ChangedBody{"copies[4]", BodyDef{}, BodyDef{}}};
  const auto saved = save_edits(scene_text, "x.json", edits);
  REQUIRE_MESSAGE(saved.ok(), test::why_not(saved));
  CHECK(saved->text == scene_text);
  CHECK(saved->left_out.size() == 2);
}
