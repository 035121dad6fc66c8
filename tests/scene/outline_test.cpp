// All that a scene's file says, value by value. Reference: the files themselves, which a value that
// is set to what it is leaves as they are, to the byte; a second tree, without the declarations;
// what the reader of scenes makes of the result.
#include "engine/scene/outline/outline_edits.hpp"
#include "engine/scene/reader.hpp"
#include "engine/scene/writer.hpp"
#include "tests/scene/scene_text.hpp"
#include "tests/support/why_not.hpp"

#include <algorithm>
#include <filesystem>
#include <functional>

#include <nlohmann/json.hpp>

using namespace tumble;
using Json = nlohmann::ordered_json;

namespace {

JsonNode tree_of_scene(const std::string& text) {
  FaultList faults;
  auto tree = parse_json(text, "", faults);
  REQUIRE_MESSAGE(tree.has_value(), all_text(faults.sorted()));
  return *std::move(tree);
}

/// Without comments.
Json plain(const std::string& text) {
  return Json::parse(text, nullptr, true, true);
}

/// Every place below `path`, by the outline alone.
void for_each_place(const JsonNode& scene, const ScenePath& path,
                    const std::function<void(const ScenePath&, const OutlineKey&)>& f) {
  const Outline outline = outline_of(scene, path);
  if (text_of(outline.path) != text_of(path)) return;  // a bare value for a whole object
  for (const OutlineKey& key : outline.keys) {
    const ScenePath own = key.what.name.starts_with('[')
                              ? at_index(path, std::stoul(key.what.name.substr(1)))
                              : path / key.what.name;
    f(own, key);
    if (key.present() && key.what.has_parts()) for_each_place(scene, own, f);
  }
}

/// Values that are neither objects nor arrays of them, by the tree alone.
size_t count_leaves(const JsonNode& node) {
  const bool inner =
      node.is(JsonNode::Kind::object) ||
      (node.is(JsonNode::Kind::array) && std::ranges::any_of(node.items, [](const JsonNode& item) {
         return item.is(JsonNode::Kind::object);
       }));
  if (!inner) return 1;
  size_t count = 0;
  for (const JsonNode& item : node.items) count += count_leaves(item);
  return count;
}

std::string faults_of(const std::string& text) {
  return all_text(read_scene(text, data_file("everything.json")).faults);
}

const std::string named_scene = R"({
  "tumble_scene": 1,
  "parameters": { "gap": 2, "gap_2": "= 2 * gap" }, // numbers
  "materials": { "slick": { "like": "steel", "friction": 0.1 }, "oiled": "slick" },
  "meshes": { "rock": { "file": "rock.obj" } },
  "bodies": {
    "ball": { "shape": { "type": "sphere", "radius": "$gap" }, "material": "slick",
              "position": [0, "= 3 * gap + gap_2", 0] },
    "stone": { "shapes": { "type": "mesh", "mesh": "rock", "material": { "like": "slick" } },
               "drawn": [{ "type": "mesh", "mesh": "rock" }] }
  },
  "joints": {
    "hinge": { "kind": "revolute", "a": "ball", "b": "stone" },
    "axle": { "kind": "revolute", "b": "stone", "couple": { "joint": "hinge", "ratio": 2 } }
  },
  "forces": { "rope": { "type": "spring", "a": { "body": "ball" }, "b": { "point": [0, 9, 0] } } },
  "particles": { "dust": { "fast": true } },
  "emitters": {
    "sparks": { "particles": "dust", "rate": 1, "life": 1 },
    "jet": { "particles": "dust", "rate": 1, "life": 1,
             "events": [{ "event": "death", "emitter": "sparks", "count": 1 }] }
  },
  "sinks": { "drain": { "type": "sphere", "radius": 1, "particles": ["dust"] } },
  "sensors": { "near": { "type": "region", "radius": 2, "particles": ["dust"] } },
  "assertions": [
    { "holds": "joints.hinge.angle < gap" },
    { "holds": "sensors.near.count + ledger.forces.rope == 0" }
  ],
  "cameras": { "main": { "position": [0, 0, 9], "target": [0, 0, 0], "follow": "ball" } },
  "lesson": { "steps": [{ "title": "One", "text": ["..."], "camera": "main",
                          "choose": ["parameters.gap=3"] }] }
}
)";

}  // namespace

TEST_CASE(
    "outline: every value of every shipped scene is in it, and set to itself changes no byte") {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(TUMBLE_SOURCE_DIR "/scenes"))
    if (entry.path().extension() == ".json" && entry.path().stem() != "tumble.schema")
      files.push_back(entry.path());
  std::ranges::sort(files);
  // Each value is looked up in, and changes, a scene's whole text: under sanitizers a few of some
  // scenes are enough.
  const size_t most_of_a_scene = test::only_to_run() ? 6 : 60;
  const size_t next = test::only_to_run() ? 5 : 1;
  size_t scenes = 0, seen = 0, leaves = 0;
  for (size_t index = 0; index < files.size(); index += next) {
    const std::string file_name = files[index].string();
    const std::string text = file_text(file_name);
    const JsonNode scene = tree_of_scene(text);
    const JsonTextEdit file(text);
    std::vector<ScenePath> found;
    for_each_place(scene, {}, [&](const ScenePath& path, const OutlineKey& key) {
      if (!key.present() || key.what.kind == MemberKind::map) return;
      const auto place = place_of(scene, path);
      REQUIRE_MESSAGE(place.has_value(), text_of(path));
      REQUIRE_MESSAGE(place->node != nullptr, text_of(path));
      const bool inner = key.what.kind == MemberKind::list ||
                         (key.what.kind == MemberKind::object && key.text.starts_with('{'));
      if (inner || path.back().index) return;
      found.push_back(path);
    });
    // The format's version and the schema's address are no values of the scene.
    const size_t beside = 1 + (scene.find("$schema") ? 1 : 0);
    CAPTURE(file_name);
    CHECK(found.size() + beside >= count_leaves(scene));
    leaves += found.size();
    ++scenes;
    const size_t step = std::max<size_t>(1, found.size() / most_of_a_scene);
    for (size_t i = 0; i < found.size(); i += step) {
      const auto place = place_of(scene, found[i]);
      const auto said = file.value(place->in_text);
      REQUIRE_MESSAGE(said.has_value(), text_of(found[i]));
      const auto same = with_value(text, found[i], *said);
      REQUIRE_MESSAGE(same.ok(), test::why_not(same));
      CHECK(*same == text);
      ++seen;
    }
  }
  CHECK(scenes > 50 / next);
  CHECK(leaves > 3000 / next);
  CHECK(seen > 25 * most_of_a_scene / next);
}

TEST_CASE("outline: what can be added can be left out again, and most of it is a scene at once") {
  const std::string text = file_text(data_file("everything.json"));
  REQUIRE(faults_of(text) == "");
  const JsonNode scene = tree_of_scene(text);
  const std::string file = data_file("everything.json");
  const std::string before = write_scene(read_scene(text, file).scene);
  std::vector<ScenePath> absent;
  for_each_place(scene, {}, [&](const ScenePath& path, const OutlineKey& key) {
    CHECK_MESSAGE(!key.what.doc.empty(), text_of(path));
    if (!key.present()) absent.push_back(path);
  });
  CHECK(absent.size() > 400);
  size_t good = 0, tried = 0;
  const size_t step = std::max<size_t>(1, absent.size() / size_t(scaled_count(160)));
  for (size_t i = 0; i < absent.size(); i += step) {
    CAPTURE(text_of(absent[i]));
    const auto with = with_added(text, absent[i]);
    REQUIRE_MESSAGE(with.ok(), test::why_not(with));
    good += faults_of(*with).empty();
    ++tried;
    std::vector<TakenAlong> along;
    const auto again = without(*with, absent[i], along);
    REQUIRE_MESSAGE(again.ok(), test::why_not(again));
    CHECK(along.empty());
    // What was written in short may be written out now.
    CHECK((write_scene(read_scene(*again, file).scene) == before));
  }
  // The others contradict something that is there: two ways to turn one body, points beside a mesh.
  CHECK(double(good) >= 0.6 * double(tried));
}

TEST_CASE("outline: a shape becomes one of every other kind, with what that needs and no more") {
  const std::string text = scene_with(R"("bodies": { "ball": {
    // round
    "shape": { "type": "sphere", "radius": 0.25, "position": [0, 1, 0], "material": "steel" } } },
    "meshes": { "rock": "rock.obj" })");
  const ScenePath type = ScenePath{} / "bodies" / "ball" / "shape" / "type";
  const auto place = place_of(tree_of_scene(text), type);
  REQUIRE(place.has_value());
  REQUIRE(place->what.names.size() > 8);
  for (const std::string& kind : place->what.names) {
    CAPTURE(kind);
    const auto changed = with_value(text, type, "\"" + kind + "\"");
    REQUIRE_MESSAGE(changed.ok(), test::why_not(changed));
    CHECK(faults_of(*changed) == "");
    CHECK(changed->find("// round") != std::string::npos);
    const Json shape = plain(*changed)["bodies"]["ball"]["shape"];
    CHECK(shape["type"] == kind);
    CHECK(shape["material"] == "steel");
    CHECK(shape["position"] == Json({0, 1, 0}));
    // A radius stays where the new kind has one.
    const auto members = members_of(*place_of(tree_of_scene(*changed), outer_path(type))->what.type,
                                    place_of(tree_of_scene(*changed), outer_path(type))->node);
    const bool round = std::ranges::find(members, "radius", &Member::name) != members.end();
    CHECK(shape.contains("radius") == round);
    if (round) CHECK(shape["radius"] == 0.25);
  }
}

TEST_CASE("outline: what a file writes in short is written out where more is said") {
  const std::string text = scene_with(
      R"("bodies": { "a": { "shapes": { "type": "sphere", "radius": 1 }, "material": "steel" } })");
  const ScenePath body = ScenePath{} / "bodies" / "a";
  const auto rough = with_value(text, body / "material" / "friction", "0.9");
  REQUIRE(rough.ok());
  CHECK(plain(*rough)["bodies"]["a"]["material"] == Json({{"like", "steel"}, {"friction", 0.9}}));
  const auto two = with_added(text, at_index(body / "shapes", 1));
  REQUIRE(two.ok());
  CHECK(faults_of(*two) == "");
  CHECK(plain(*two)["bodies"]["a"]["shapes"].size() == 2);
  CHECK(plain(*two)["bodies"]["a"]["shapes"][0]["radius"] == 1);
  const auto larger = with_value(text, at_index(body / "shapes", 0) / "radius", "2");
  REQUIRE(larger.ok());
  CHECK(plain(*larger)["bodies"]["a"]["shapes"]["radius"] == 2);
  // The last of a list takes its key along.
  std::vector<TakenAlong> along;
  const auto none = without(*larger, at_index(body / "shapes", 0), along);
  REQUIRE(none.ok());
  CHECK_FALSE(plain(*none)["bodies"]["a"].contains("shapes"));
}

TEST_CASE("outline: a course, a repetition and a camera begin as ones that work") {
  std::string text = scene_with(
      R"("bodies": { "a": { "type": "kinematic", "shape": { "type": "sphere", "radius": 1 } } })");
  const ScenePath body = ScenePath{} / "bodies" / "a";
  for (const ScenePath& path :
       {body / "course", body / "repeat", body / "colours", body / "drawn", ScenePath{} / "cameras",
        ScenePath{} / "cameras" / "side", ScenePath{} / "materials" / "mud", ScenePath{} / "look",
        ScenePath{} / "lights", ScenePath{} / "assertions", ScenePath{} / "microscope",
        ScenePath{} / "lesson", ScenePath{} / "sensors" / "gate", ScenePath{} / "forces" / "air",
        ScenePath{} / "particles" / "dust", ScenePath{} / "parameters" / "n"}) {
    CAPTURE(text_of(path));
    auto with = with_added(text, path);
    REQUIRE_MESSAGE(with.ok(), test::why_not(with));
    CHECK(faults_of(*with) == "");
    text = *std::move(with);
  }
}

TEST_CASE("outline: what one types becomes the JSON of its kind") {
  Member number;
  number.kind = MemberKind::number;
  for (const auto& [typed, json] : {std::pair("2.50", "2.50"),
                                    {" -1e-3 ", "-1e-3"},
                                    {"= 2*n", "\"= 2*n\""},
                                    {"$n", "\"$n\""},
                                    {"sin(2*t)", "\"= sin(2*t)\""},
                                    {"[[0, 1], [2, 3]]", "[[0, 1], [2, 3]]"}}) {
    const auto value = typed_value(number, typed);
    REQUIRE(value.ok());
    CHECK(*value == json);
  }
  CHECK_FALSE(typed_value(number, " ").ok());
  Member words;
  CHECK(*typed_value(words, "a \"ball\"") == R"("a \"ball\"")");
  CHECK(shown_value(*typed_value(words, "a \"ball\"")) == "a \"ball\"");
  CHECK(shown_value("[1, 2]") == "[1, 2]");
}

TEST_CASE("outline: what stands bare for an object is typed as the key that it stands for") {
  const std::string text = scene_with(R"("parameters": { "gap": 2 },
    "materials": { "slick": "steel" },
    "particles": { "dust": { "gas": 1, "at": [[0, 0, 0]] } },
    "emitters": { "jet": { "particles": "dust", "rate": 1, "life": 1 } })");
  const JsonNode scene = tree_of_scene(text);
  const auto typed = [&](const ScenePath& path, const char* words) {
    const auto place = place_of(scene, path);
    REQUIRE_MESSAGE(place.has_value(), text_of(path));
    const auto value = typed_value(place->what, words);
    REQUIRE_MESSAGE(value.ok(), test::why_not(value));
    return *value;
  };
  const ScenePath gap = ScenePath{} / "parameters" / "gap";
  CHECK(typed(gap, "3") == "3");
  CHECK(typed(gap, "2*pi") == "\"= 2*pi\"");
  CHECK(typed(ScenePath{} / "emitters" / "jet" / "life", "0.5") == "0.5");
  CHECK(typed(ScenePath{} / "emitters" / "jet" / "life", "$gap") == "\"$gap\"");
  CHECK(typed(ScenePath{} / "materials" / "slick", "ice") == "\"ice\"");
  const auto wider = with_value(text, gap, typed(gap, "3"));
  REQUIRE(wider.ok());
  CHECK(plain(*wider)["parameters"]["gap"] == 3);
  CHECK(plain(*with_value(text, gap / "max", "4"))["parameters"]["gap"] ==
        Json({{"value", 2}, {"max", 4}}));
}

TEST_CASE("outline: what stands without brackets gets them as it is written") {
  const std::string one = R"({
      // round
      "type": "sphere", "radius": 1.50
    })";
  const std::string text = scene_with(R"("bodies": { "a": { "shapes": )" + one + " } }");
  const auto two = with_added(text, at_index(ScenePath{} / "bodies" / "a" / "shapes", 1));
  REQUIRE_MESSAGE(two.ok(), test::why_not(two));
  CHECK(faults_of(*two) == "");
  CHECK(two->find("\"shapes\": [" + one + ", ") != std::string::npos);
}

TEST_CASE("outline: the one item of a list that must be there stays") {
  const std::string text =
      scene_with(R"("lesson": { "steps": { "title": "One", "text": ["..."] } })");
  REQUIRE(place_of(tree_of_scene(text), ScenePath{} / "lesson" / "steps")->what.required);
  std::vector<TakenAlong> along;
  CHECK_FALSE(without(text, at_index(ScenePath{} / "lesson" / "steps", 0), along).ok());
}

TEST_CASE("outline: a number becomes one that the scene declares, and means the same") {
  const std::string text = scene_with(
      R"("bodies": { "a": { "shape": { "type": "sphere", "radius": 0.5 }, "position": [1, 2, 3] } })");
  const ScenePath body = ScenePath{} / "bodies" / "a";
  const auto radius = with_parameter(text, body / "shape" / "radius");
  REQUIRE(radius.ok());
  CHECK(radius->name == "radius");
  const auto height = with_parameter(radius->text, at_index(body / "position", 1));
  REQUIRE(height.ok());
  const SceneRead was = read_scene(text, ""), now = read_scene(height->text, "");
  REQUIRE(now.ok());
  CHECK(plain(height->text)["parameters"] == Json({{"radius", 0.5}, {"position", 2}}));
  CHECK(plain(write_scene(now.scene))["bodies"] == plain(write_scene(was.scene))["bodies"]);
  CHECK_FALSE(with_parameter(height->text, body / "shape" / "radius").ok());  // it is one already
}

TEST_CASE("renaming: whatever has a name gets another, wherever it is named, and its own back") {
  REQUIRE(faults_of(named_scene) == "");
  const std::pair<const char*, const char*> things[] = {
      {"parameters", "gap"}, {"materials", "slick"}, {"meshes", "rock"},    {"bodies", "ball"},
      {"joints", "hinge"},   {"forces", "rope"},     {"particles", "dust"}, {"emitters", "sparks"},
      {"sinks", "drain"},    {"sensors", "near"},    {"cameras", "main"}};
  for (const auto& [list, name] : things) {
    const std::string shown_list = list;
    CAPTURE(shown_list);
    const auto there = renamed(named_scene, list, name, "other");
    REQUIRE_MESSAGE(there.ok(), test::why_not(there));
    CHECK(faults_of(*there) == "");
    CHECK(*there != named_scene);
    CHECK(there->find(std::string("\"") + name + "\"") == std::string::npos);
    CHECK(there->find(std::string("$") + name + "\"") == std::string::npos);
    const auto back = renamed(*there, list, "other", name);
    REQUIRE(back.ok());
    CHECK(*back == named_scene);
  }
  const auto gap = renamed(named_scene, "parameters", "gap", "other");
  CHECK(gap->find("\"= 3 * other + gap_2\"") != std::string::npos);
  CHECK(gap->find("joints.hinge.angle < other") != std::string::npos);
  CHECK(gap->find("parameters.other=3") != std::string::npos);
}

TEST_CASE("leaving out: a material, a mesh and a camera take along what cannot do without") {
  const auto left = [](const char* list, const char* name, std::vector<std::string>& told) {
    std::vector<TakenAlong> along;
    const auto text = without(named_scene, ScenePath{} / list / name, along);
    REQUIRE(text.ok());
    for (const TakenAlong& one : along) told.push_back(one.words());
    CHECK(faults_of(*text) == "");
    return plain(*text);
  };
  std::vector<std::string> told;
  const Json slick = left("materials", "slick", told);
  CHECK_FALSE(slick["bodies"]["ball"].contains("material"));
  CHECK(slick["bodies"].contains("stone"));
  CHECK_FALSE(slick["materials"].contains("oiled"));  // it was nothing else
  CHECK(told.size() == 3);                            // of two bodies, and that
  told.clear();
  const Json rock = left("meshes", "rock", told);
  CHECK_FALSE(rock["bodies"].contains("stone"));  // it was of nothing else
  CHECK(rock["joints"].empty());
  told.clear();
  const Json camera = left("cameras", "main", told);
  CHECK_FALSE(camera["lesson"]["steps"][0].contains("camera"));
  CHECK(told == std::vector<std::string>{"steps[0].camera of lesson"});
}

TEST_CASE("leaving out: a material of the scene gives its name back to the one of Tumble") {
  const std::string text =
      scene_with(R"("materials": { "steel": { "like": "steel", "friction": 0.1 } },
    "bodies": { "a": { "shape": { "type": "sphere", "radius": 1 }, "material": "steel" } })");
  REQUIRE(faults_of(text) == "");
  std::vector<TakenAlong> along;
  const auto left = without(text, ScenePath{} / "materials" / "steel", along);
  REQUIRE(left.ok());
  CHECK(along.empty());
  CHECK(faults_of(*left) == "");
  CHECK(plain(*left)["bodies"]["a"]["material"] == "steel");
}

TEST_CASE("moving: an item goes to each place of its list and back, as the list says it") {
  const std::string text = scene_with(R"("bodies": { "b": { "shapes": [
    { "type": "sphere", "radius": 1 }, // first
    { "type": "box", "size": [1, 2, 3] },
    { "type": "sphere", "radius": 2 }
  ], "mass": 1 } })");
  const ScenePath list = ScenePath{} / "bodies" / "b" / "shapes";
  const auto items = [&](const std::string& of) {
    return plain(of)["bodies"]["b"]["shapes"].get<std::vector<Json>>();
  };
  for (int from = 0; from < 3; ++from)
    for (int to = 0; to < 3; ++to) {
      const auto moved = with_moved(text, at_index(list, size_t(from)), to - from);
      REQUIRE_MESSAGE(moved.ok(), test::why_not(moved));
      auto expected = items(text);
      const Json one = expected[size_t(from)];
      expected.erase(expected.begin() + from);
      expected.insert(expected.begin() + to, one);
      CHECK(items(*moved) == expected);
      CHECK(read_scene(*moved, "").ok());
      CHECK(*with_moved(*moved, at_index(list, size_t(to)), from - to) == text);
    }
  CHECK_FALSE(with_moved(text, at_index(list, 0), -1).ok());
  CHECK_FALSE(with_moved(text, at_index(list, 2), 1).ok());
  CHECK_FALSE(with_moved(text, ScenePath{} / "bodies" / "b", 1).ok());
}

TEST_CASE("reading: nothing in place of the shapes is refused, since they would be drawn") {
  const auto faults_of = [](const std::string& members) {
    return all_text(read_scene(scene_with(members), "").faults);
  };
  const std::string ball = R"("bodies": { "b": { "shape": { "type": "sphere", "radius": 1 })";
  CHECK(faults_of(ball + " } }").empty());
  CHECK(faults_of(ball + R"(, "drawn": [{ "type": "sphere", "radius": 2 }] } })").empty());
  CHECK(faults_of(ball + R"(, "drawn": [] } })").find("bodies.b.drawn: is empty") !=
        std::string::npos);
  CHECK(faults_of(ball + R"(, "look": { "visible": false } } })").empty());
}
