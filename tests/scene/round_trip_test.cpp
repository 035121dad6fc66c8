// Writing and reading back. References: the text written again from what was read must be the same
// bytes, and every number must come back with the same bits.
#include "engine/core/random.hpp"
#include "engine/scene/schema.hpp"
#include "engine/scene/writer.hpp"
#include "tests/scene/scene_text.hpp"

#include <fstream>
#include <functional>

#include <nlohmann/json.hpp>

using namespace tumble;

TEST_CASE("a scene with every key is written and read back equal") {
  const SceneRead first = load_scene(data_file("everything.json"));
  REQUIRE(first.ok());
  const std::string text = write_scene(first.scene);
  const SceneRead second = read_scene(text, data_file("written.json"));
  INFO(text << all_text(second.faults));
  REQUIRE(second.ok());
  CHECK(write_scene(second.scene) == text);
  const BodyDescription &a = *first.scene.bodies.find("ball"),
                        &b = *second.scene.bodies.find("ball");
  CHECK(a.placement.pose().q.coeffs() == b.placement.pose().q.coeffs());
  CHECK(a.velocity == b.velocity);
  CHECK(*a.angular_velocity_deg == *b.angular_velocity_deg);
}

TEST_CASE("defaults are left out") {
  SceneDescription scene;
  const auto json = nlohmann::json::parse(write_scene(scene));
  CHECK(json == nlohmann::json{{"$schema", "tumble.schema.json"}, {"tumble_scene", 1}});
}

TEST_CASE("random numbers come back with the same bits") {
  Random random(5);
  for (int i = 0; i < scaled_count(300); ++i) {
    SceneDescription scene;
    BodyDescription& body = scene.bodies.add("b");
    body.shape.emplace();
    const auto draw = [&] { return random.uniform(-1, 1) * std::pow(10, random.uniform(-12, 5)); };
    body.placement.position = {draw(), draw(), draw()};
    body.velocity = {draw(), draw(), draw()};
    body.mass = std::fabs(draw()) + 1e-300;
    body.placement.orientation = Quat{draw(), draw(), draw(), draw() + 1e-9};
    body.colour = Colour{random.uniform(), random.uniform(), random.uniform()};
    scene.seed = (uint64_t{random.next()} << 32) | random.next();
    const SceneRead read = read_scene(write_scene(scene), "x.json");
    INFO(all_text(read.faults));
    REQUIRE(read.ok());
    const BodyDescription& back = *read.scene.bodies.find("b");
    CHECK(back.placement.position == body.placement.position);
    CHECK(back.placement.orientation->coeffs() == body.placement.orientation->coeffs());
    CHECK(back.velocity == body.velocity);
    CHECK(*back.mass == *body.mass);
    CHECK(back.colour->r == body.colour->r);
    CHECK(back.colour->b == body.colour->b);
    CHECK(read.scene.seed == scene.seed);
  }
}

TEST_CASE("scenes/tumble.schema.json is up to date") {
  // Renew it with: TUMBLE_RENEW=1 build/release/bin/test_scene -tc="*schema.json*"
  const std::string file = std::string(TUMBLE_SOURCE_DIR) + "/scenes/tumble.schema.json";
  if (std::getenv("TUMBLE_RENEW")) std::ofstream(file, std::ios::binary) << scene_schema();
  CHECK(file_text(file) == scene_schema());
  const auto schema = nlohmann::json::parse(scene_schema());
  CHECK(schema["properties"].contains("bodies"));
  // Every reference leads somewhere.
  const std::string text = scene_schema();
  const std::string head = "#/definitions/";
  for (size_t at = text.find(head); at != std::string::npos; at = text.find(head, at + 1)) {
    const size_t start = at + head.size();
    CHECK(schema["definitions"].contains(text.substr(start, text.find('"', start) - start)));
  }
}

TEST_CASE("scenes/README.md mentions every key") {
  const std::string readme = file_text(std::string(TUMBLE_SOURCE_DIR) + "/scenes/README.md");
  std::vector<std::string> missing;
  const std::function<void(const nlohmann::json&)> visit = [&](const nlohmann::json& node) {
    if (node.is_object() && node.contains("properties"))
      for (const auto& item : node["properties"].items())
        if (readme.find("`" + item.key() + "`") == std::string::npos &&
            readme.find("\"" + item.key() + "\"") == std::string::npos)
          missing.push_back(item.key());
    if (node.is_structured())
      for (const auto& child : node) visit(child);
  };
  visit(nlohmann::json::parse(scene_schema()));
  std::string list;
  for (const std::string& key : missing) list += key + " ";
  CHECK(list == "");
}
