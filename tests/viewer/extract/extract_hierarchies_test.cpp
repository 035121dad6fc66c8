// Volumes of hierarchies and notes of bodies. Reference: counts worked out by hand from frames
// built in the test.
#include "engine/scene/build.hpp"
#include "engine/scene/reader.hpp"
#include "engine/world/world.hpp"
#include "tests/support/ring_mesh.hpp"
#include "tests/viewer/extract/frame_maker.hpp"
#include "viewer/app/scenes/scene_look.hpp"

#include <doctest/doctest.h>

using namespace tumble;
using namespace tumble::test;

TEST_CASE("hierarchies: twelve lines a box and three circles a sphere, of the level asked for") {
  const auto ring = shape(ShapeType::triangle_mesh,
                          std::make_shared<const TriangleMesh>(ring_mesh(1, 0.3, 32, 16)));
  FrameMaker m;
  m.add(ring, {0, 0, 0});
  m.add(ring, {5, 0, 0});
  m.add(shape(ShapeType::box), {9, 0, 0});
  const Frame frame = m.make();
  ExtractOptions options;
  options.overlays.hierarchy = true;
  for (int level = 0; level < 4; ++level) {
    options.overlays.hierarchy_level = level;
    const size_t volumes = size_t{1} << level;
    for (const char* kind : {"aabb", "obb"}) {
      options.overlays.hierarchy_kind = kind;
      CHECK(extracted(frame, frame, 1, options).lines.size() == 2 * 12 * volumes);
    }
    options.overlays.hierarchy_kind = "sphere";
    CHECK(extracted(frame, frame, 1, options).lines.size() == 2 * 144 * volumes);
    CHECK(extracted(frame, frame, 1, options).instances.size() == 3);
    // Of a selected mesh alone, which is then in the colours of its volumes.
    options.selected = frame.body(1).id;
    const RenderScene one = extracted(frame, frame, 1, options);
    CHECK(one.lines.size() == 144 * volumes);
    CHECK(one.instances.size() == 2 + volumes);
    for (const LineSegment& l : one.lines) CHECK(l.a.x() > 3.0f);
    options.selected = {};
  }
  ShapeMeshes meshes;
  const auto depth = hierarchy_depth(frame, options, meshes);
  REQUIRE(depth.has_value());
  CHECK(*depth >= 7);  // 1024 triangles, four to a leaf
  // Unless a kind is chosen, that of the world; brute force has no volumes.
  options.overlays.hierarchy_kind.clear();
  options.overlays.hierarchy_level = 0;
  for (const auto& [used, lines] :
       {std::pair{"sphere", 144}, {"obb", 12}, {"brute_force", 12}, {"", 12}}) {
    options.world_hierarchy = used;
    CHECK(extracted(frame, frame, 1, options).lines.size() == 2 * size_t(lines));
  }
  options.overlays.hierarchy_kind = "sphere";
  options.overlays.hierarchy_level = *depth + 20;
  CHECK(extracted(frame, frame, 1, options).lines.size() > 2 * 144 * 200);
  options.overlays.hierarchy = false;
  CHECK(extracted(frame, frame, 1, options).lines.empty());
  FrameMaker boxes;
  boxes.add(shape(ShapeType::box), {0, 0, 0});
  CHECK_FALSE(hierarchy_depth(boxes.make(), options, meshes));
}

TEST_CASE("notes of a scene: a label above the body, volumes around it, the overlay goes first") {
  const auto solid = shape(ShapeType::triangle_mesh, tetrahedron());
  FrameMaker m;
  m.add(solid, {0, 2, 0});
  m.add(solid, {4, 2, 0});
  const Frame frame = m.make();
  ExtractOptions options;
  options.notes.push_back({frame.body(0).id, "left", "sphere", 0});
  RenderScene scene = extracted(frame, frame, 1, options);
  REQUIRE(scene.texts.size() == 1);
  CHECK(scene.texts[0].text == "left");
  CHECK(scene.texts[0].x.y() > 3);
  CHECK(scene.texts[0].x.x() == doctest::Approx(0.5));
  CHECK(scene.lines.size() == 144);
  options.overlays.hierarchy = true;
  options.overlays.hierarchy_kind = "obb";
  options.overlays.hierarchy_level = 0;
  CHECK(extracted(frame, frame, 1, options).lines.size() == 24);
  // Of another body: the note stays.
  options.selected = frame.body(1).id;
  CHECK(extracted(frame, frame, 1, options).lines.size() == 144 + 12);
}

TEST_CASE("a scene file gives the notes of its bodies, copies included") {
  const SceneRead read = read_scene(R"({"tumble_scene": 1, "bodies": {
    "plain": {"shape": {"type": "sphere", "radius": 1}},
    "ball": {"shape": {"type": "sphere", "radius": 1}, "look": {"label": "a ball"},
             "position": [9, 0, 0], "repeat": {"type": "stack", "count": 2, "step": [0, 5, 0]}},
    "knot": {"shape": {"type": "triangle_mesh", "mesh": "knot"}, "position": [-9, 0, 0],
             "look": {"volumes": "obb", "volumes_level": 2}}},
    "meshes": {"knot": "trefoil_knot.obj"}})",
                                    "notes.json");
  REQUIRE(read.ok());
  auto built = build_world(read.scene);
  REQUIRE(built.ok());
  ExtractOptions options;
  options.notes = body_notes(*built);
  REQUIRE(options.notes.size() == 3);
  const Frame& frame = *built->world->frame();
  const RenderScene scene = extracted(frame, frame, 1, options);
  CHECK(scene.texts.size() == 2);
  CHECK(scene.lines.size() == 4 * 12);
  for (const char* bad :
       {R"("volumes": "brute_force")", R"("volumes": "cube")", R"("volumes_level": -1)"}) {
    const std::string text = std::string(R"({"tumble_scene": 1, "bodies": {"a": {"shape": {"type":
      "sphere", "radius": 1}, "look": {)") +
                             bad + "}}}}";
    CHECK_FALSE_MESSAGE(build_world(read_scene(text, "bad.json").scene).ok(), bad);
  }
}

TEST_CASE("trees of shapes that are gone are forgotten, and a new shape has its own") {
  ShapeMeshes meshes;
  RenderScene out;
  ExtractOptions options;
  options.overlays.hierarchy = true;
  for (int i = 0; i < 3; ++i) {
    FrameMaker m;
    m.add(shape(ShapeType::triangle_mesh, tetrahedron()), {0, 0, 0});
    const Frame frame = m.make();
    extract(frame, frame, 1, options, meshes, out);
    CHECK(out.lines.size() == 12);
    CHECK(meshes.hierarchies().size() >= 1);
  }
  meshes.prune();
  CHECK(meshes.hierarchies().size() == 0);
}
