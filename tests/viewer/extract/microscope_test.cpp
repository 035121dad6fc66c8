// References: the recordings that the recorders make of the same scene, counts by hand, the null
// device, which checks every call.
#include "engine/scene/build.hpp"
#include "engine/scene/reader.hpp"
#include "engine/scene/resources.hpp"
#include "engine/world/world.hpp"
#include "viewer/app/scenes/scene_look.hpp"
#include "viewer/render/extract.hpp"
#include "viewer/render/labels.hpp"
#include "viewer/render/null/null_device.hpp"
#include "viewer/render/renderer.hpp"

#include <algorithm>
#include <set>

#include <doctest/doctest.h>

using namespace tumble;

namespace {

BuiltScene microscope_scene(const std::string& name, std::vector<std::string> overrides = {}) {
  const std::string file = std::string(TUMBLE_SOURCE_DIR) + "/scenes/" + name + ".json";
  const SceneRead read = load_scene(file, {std::move(overrides)});
  for (const Fault& f : read.faults) MESSAGE(f.text());
  REQUIRE(read.ok());
  auto built = build_world(read.scene);
  REQUIRE(built.ok());
  REQUIRE(built->microscope.has_value());
  return std::move(*built);
}

/// The picture of a step.
RenderScene picture_of(const BuiltScene& built, int step, ShapeMeshes& meshes, bool plate = true) {
  ExtractOptions options;
  options.microscope = built.microscope;
  options.microscope_step = step;
  options.microscope_plate = plate;
  RenderScene out;
  apply_look(*built.description, out);
  const auto frame = built.world->frame();
  extract(*frame, *frame, 1, options, meshes, out);
  return out;
}

}  // namespace

TEST_CASE("every step of the microscope scenes is drawn, with words, on the null device") {
  const auto shaders = find_resource("shaders");
  REQUIRE(shaders.ok());
  const auto device = make_null_device();
  auto renderer = Renderer::create(*device, *shaders);
  REQUIRE(renderer.ok());
  for (const std::string name : {"microscope_gjk", "microscope_v_clip", "microscope_time"}) {
    CAPTURE(name);
    const BuiltScene built = microscope_scene(name);
    ShapeMeshes meshes;
    (void)picture_of(built, 0, meshes);
    const MicroscopeRecording* recording = meshes.microscope().recording();
    REQUIRE(recording);
    CHECK(recording->steps.size() >= 5);
    std::set<uint64_t> hashes;
    for (int k = 0; k < int(recording->steps.size()); ++k) {
      RenderScene scene = picture_of(built, k, meshes);
      const MicroscopeStep& step = recording->steps[size_t(k)];
      CHECK(scene.points.size() == step.sketch.points.size());
      CHECK(scene.texts.size() == step.sketch.labels.size());
      CHECK(scene.instances.size() >= step.sketch.surfaces.size());
      REQUIRE(scene.plate.has_value());
      CHECK(scene.plate->caption == step.caption);
      CHECK(scene.plate->numbers.size() == step.numbers.size());
      const auto report = (*renderer)->render(scene, 1280, 720);
      REQUIRE(report.ok());
      hashes.insert(report->draws.hash);
    }
    CHECK(hashes.size() == recording->steps.size());  // no two steps look alike
  }
}

TEST_CASE(
    "bodies under the microscope are drawn by it alone, and steps beyond the last are the last") {
  const BuiltScene built = microscope_scene("microscope_v_clip");
  ShapeMeshes meshes;
  const RenderScene first = picture_of(built, 0, meshes);
  for (const MeshInstance& i : first.instances) CHECK(i.paint.opacity < 1);
  const int last = int(meshes.microscope().recording()->steps.size()) - 1;
  const RenderScene end = picture_of(built, last, meshes), beyond = picture_of(built, 999, meshes);
  CHECK(end.plate->caption == beyond.plate->caption);
  CHECK(end.lines.size() == beyond.lines.size());
  CHECK(meshes.microscope().shown() == last);
  CHECK_FALSE(picture_of(built, 0, meshes, false).plate.has_value());
}

TEST_CASE("the recording is kept while nothing moves, and --set reaches step and algorithm") {
  const BuiltScene built =
      microscope_scene("microscope_v_clip", {"microscope.algorithm=gjk", "microscope.step=2"});
  CHECK(built.microscope->step == 2);
  CHECK(built.microscope->algorithm == "gjk");
  ShapeMeshes meshes;
  (void)picture_of(built, 0, meshes);
  const MicroscopeRecording* recording = meshes.microscope().recording();
  const std::string* caption = &recording->steps[0].caption;
  (void)picture_of(built, 1, meshes);
  CHECK(caption == &meshes.microscope().recording()->steps[0].caption);
}

TEST_CASE("what a world says under the microscope is drawn, with its colours, on the null device") {
  const SceneRead read = read_scene(R"json({"tumble_scene": 1, "settings": {"stepper": "event"},
    "bodies": {
      "floor": {"type": "static", "shape": {"type": "box", "size": [4, 1, 4]},
                "position": [0, -0.5, 0]},
      "low": {"shape": {"type": "box", "size": [1, 1, 1]}, "position": [0, 0.5, 0]},
      "high": {"shape": {"type": "box", "size": [1, 1, 1]}, "position": [0, 1.5, 0]},
      "ball": {"shape": {"type": "sphere", "radius": 0.2}, "position": [1.2, 1, 0]}},
    "particles": {"water": {"fluid": {},
      "fill": [{"type": "lattice", "centre": [-1.2, 0.21, 0], "size": [0.4, 0.4, 0.4],
                "spacing": 0.1}]}}})json",
                                    "world.json");
  for (const Fault& f : read.faults) MESSAGE(f.text());
  REQUIRE(read.ok());
  const auto built = build_world(read.scene);
  REQUIRE(built.ok());
  REQUIRE(built->world->step().ok());
  const auto frame = built->world->frame();
  const auto shaders = find_resource("shaders");
  REQUIRE(shaders.ok());
  const auto device = make_null_device();
  auto renderer = Renderer::create(*device, *shaders);
  REQUIRE(renderer.ok());
  for (const auto& [algorithm, body] :
       {std::pair{"dantzig", "low"}, {"baraff", "low"}, {"first_event", "ball"}, {"dfsph", ""}}) {
    const std::string shown_algorithm = algorithm;
    CAPTURE(shown_algorithm);
    ExtractOptions options;
    MicroscopeSetup& setup = options.microscope.emplace();
    setup.algorithm = algorithm;
    setup.a = built->world->find_body(body);
    ShapeMeshes meshes;
    RenderScene nothing_yet;
    extract(*frame, *frame, 1, options, meshes, nothing_yet);
    CHECK_FALSE(nothing_yet.plate.has_value());
    options.microscope_said = ask_world(*built->world, setup);
    REQUIRE(options.microscope_said);
    REQUIRE_MESSAGE(options.microscope_said->recording, options.microscope_said->refusal);
    const MicroscopeRecording& recording = *options.microscope_said->recording;
    CHECK(recording.steps.size() >= 2);
    std::set<uint64_t> hashes;
    for (int k = 0; k < int(recording.steps.size()); ++k) {
      options.microscope_step = k;
      RenderScene scene;
      extract(*frame, *frame, 1, options, meshes, scene);
      const MicroscopeStep& step = recording.steps[size_t(k)];
      REQUIRE(scene.plate.has_value());
      CHECK(scene.plate->caption == step.caption);
      CHECK(scene.legends.size() == size_t(step.particles ? 1 : 0));
      CHECK(scene.points.size() == step.sketch.points.size());
      const auto see_through =
          std::count_if(scene.instances.begin(), scene.instances.end(),
                        [](const MeshInstance& i) { return i.paint.opacity < 1; });
      CHECK(size_t(see_through) == recording.see_through.size());
      CHECK(scene.spheres.size() == nothing_yet.spheres.size());
      const auto report = (*renderer)->render(scene, 1280, 720);
      REQUIRE(report.ok());
      hashes.insert(report->draws.hash);
    }
    CHECK(hashes.size() == recording.steps.size());
    // Of another tick it shows nothing.
    auto late = *frame;
    ++late.tick;
    RenderScene later;
    extract(late, late, 1, options, meshes, later);
    CHECK_FALSE(later.plate.has_value());
  }
}

TEST_CASE("a caption is cut into lines that fit, without losing a word") {
  const FontAtlas font = bake_default_font();
  const std::string text =
      "No test names a neighbour: the nearest point of each lies in the region";
  for (const float width : {40.0f, 120.0f, 333.0f, 5000.0f}) {
    std::string joined;
    for (const std::string& line : wrapped(text, font, 13, width)) {
      if (line.find(' ') != std::string::npos) CHECK(text_width(line, font, 13) <= width);
      joined += (joined.empty() ? "" : " ") + line;
    }
    CHECK(joined == text);
  }
  CHECK(wrapped("", font, 13, 100).empty());
}
