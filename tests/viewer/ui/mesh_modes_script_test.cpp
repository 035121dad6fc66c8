// References: what the world's body is made of before and after, and its state hash.
#include "engine/world/world.hpp"
#include "tests/viewer/ui/laboratory.hpp"

#include <chrono>
#include <thread>

#include <doctest/doctest.h>

using namespace tumble;
using namespace tumble::test;

namespace {

/// Pictures until something that another thread does has happened; a minute at most.
template <class Happened>
bool wait_for(Rig& rig, const Happened& happened) {
  for (int n = 0; n < 6000 && !happened(); ++n) {
    rig.frame();
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return happened();
}

}  // namespace

TEST_CASE(
    "a mesh is let collide in another way, which is one undo step, and all ways are compared") {
  const auto device = make_null_device();
  Rig rig(*device, "meshes");
  rig.picture = {1200, 900, 1};
  rig.play("wait 5\nkey Space\nclick body:ring\nwait 3");
  const auto shapes = [&] {
    World& world = rig.app->session().world();
    return world.body(world.find_body("ring"))->shapes.size();
  };
  const auto state = [&] { return rig.app->session().world().state_hash(); };
  REQUIRE(shapes() == 1);
  const uint64_t before = state();
  rig.play("click inspector.mesh.0.mode\nwait 2\nclick inspector.mesh.0.mode.decomposition");
  REQUIRE(wait_for(rig, [&] { return shapes() > 3; }));
  rig.play("wait 3\nkey Ctrl+Z\nwait 3");
  CHECK(says(rig, "Taken back: Let the mesh of ring collide as convex pieces"));
  CHECK(shapes() == 1);
  CHECK(state() == before);
  rig.play("key Ctrl+Y\nwait 3");
  CHECK(shapes() > 3);
  // From pieces to a primitive: the mesh is known still.
  rig.play("click inspector.mesh.0.mode\nwait 2\nclick inspector.mesh.0.mode.fit");
  REQUIRE(wait_for(rig, [&] { return shapes() == 1; }));
  CHECK(wait_for(rig, [&] { return says(rig, "approximate"); }));

  const auto compared = [&] { return rig.app->locate("inspector.mesh.0.table").has_value(); };
  CHECK_FALSE(compared());
  rig.play("click inspector.mesh.0.compare\nwait 2");
  CHECK(wait_for(rig, compared));
  check_no_faults(*device);
}

TEST_CASE("a mesh file is placed from the palette, saved by a relative path, and taken back") {
  Laboratory b;
  const auto folder = b.rig.folder.path() / "parts";
  std::filesystem::create_directories(folder);
  // A wedge in millimetres.
  REQUIRE(
      write_file(folder / "wedge.obj", std::string_view("v 0 0 0\nv 900 0 0\nv 0 600 0\nv 0 0 700\n"
                                                        "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"))
          .ok());
  b.play("click build.mesh_file\nwait 3");
  REQUIRE(b.rig.app->browsed());
  b.play("click scenes.file.parts\nwait 3\nclick scenes.file.wedge.obj\nwait 3");
  REQUIRE(b.rig.app->ui_state().building);
  b.play("click " + b.at({0, 0, 2}) + "\nwait 3\nclick build.mode\nwait 2\nclick " +
         "build.mode.triangle_mesh\nwait 3\nclick " + b.at({2, 0, 2}) +
         "\nwait 3\nkey Esc\nwait 2");
  const BodyId hull = b.world().find_body("wedge"), whole = b.world().find_body("wedge_2");
  REQUIRE_FALSE(hull.is_null());
  REQUIRE_FALSE(whole.is_null());
  CHECK(b.world().body_def(hull)->shapes[0].shape.type == ShapeType::convex_hull);
  CHECK(b.world().body_def(whole)->shapes[0].shape.type == ShapeType::triangle_mesh);
  // As large as what one looks at, standing on the ground: half of 600 mm above it.
  CHECK(b.world().body_def(hull)->pose.x.y() == doctest::Approx(0.3).epsilon(1e-6));
  const uint64_t built = b.hash();
  b.save();
  const std::string saved = b.content();
  CHECK(saved.find("\"parts/wedge.obj\"") != std::string::npos);
  CHECK(saved.find("\"wedge_2\": { ") != std::string::npos);
  CHECK(saved.find("\"mode\": \"convex_hull\"") != std::string::npos);
  b.rig.app->open(b.file);
  b.play("wait 3");
  CHECK(b.hash() == built);
  check_no_faults(*b.device);
}

TEST_CASE("a copy of a body of a mesh is saved with the mesh of the original") {
  Laboratory b;
  const std::string wedge =
      "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
  REQUIRE(write_file(b.rig.folder.path() / "wedge.obj", std::string_view(wedge)).ok());
  const auto file = (b.rig.folder.path() / "wedges.json").string();
  REQUIRE(write_file(file, std::string_view(
                               R"({"tumble_scene": 1, "meshes": {"wedge": "wedge.obj"}, "bodies": {
    "ground": {"type": "static", "shape": {"type": "half_space"}},
    "wedge": {"shape": {"type": "mesh", "mesh": "wedge", "mode": "decomposition"}, "material": "ice",
              "position": [0, 2, 0], "repeat": {"type": "stack", "count": 2, "step": [2, 0, 0]}}},
    "cameras": {"main": {"position": [0, 2.5, 9], "target": [0, 1.5, 0]}}})"))
              .ok());
  b.rig.app->open(file);
  b.play("wait 3\nclick body:wedge[0]\nwait 2\nkey Ctrl+D\nwait 3");
  const BodyId copy = b.world().find_body("wedge_2");
  REQUIRE_FALSE(copy.is_null());
  const BodyDef made = *b.world().body_def(copy);
  b.play("key Ctrl+S\nwait 3\nkey Ctrl+S\nwait 5");
  CAPTURE(b.rig.app->ui_state().save_fault);
  CHECK_FALSE(b.rig.app->ui_state().shows(PanelId::save));
  const std::string saved = *read_file(file);
  CAPTURE(saved);
  CHECK(saved.find("\"wedge_2\": {") != std::string::npos);
  b.rig.app->open(file);
  b.play("wait 3");
  const BodyDef again = *b.world().body_def(b.world().find_body("wedge_2"));
  CHECK(again.pose.x == made.pose.x);
  REQUIRE(again.shapes.size() == made.shapes.size());
  CHECK(again.shapes[0].material.friction == made.shapes[0].material.friction);
  REQUIRE(again.shapes[0].source);
  CHECK(again.shapes[0].source->how.mode == MeshMode::decomposition);
  check_no_faults(*b.device);
}

TEST_CASE("bodies of a repetition are pasted into another scene by plain names, and saved") {
  Laboratory b;
  const auto row = (b.rig.folder.path() / "row.json").string();
  REQUIRE(write_file(row, std::string_view(R"({"tumble_scene": 1, "bodies": {
    "ground": {"type": "static", "shape": {"type": "half_space"}},
    "brick": {"shape": {"type": "box", "size": [0.4, 0.2, 0.2]}, "position": [0, 1, 0],
              "repeat": {"type": "stack", "count": 2, "step": [1, 0, 0]}}},
    "cameras": {"main": {"position": [0, 2.5, 9], "target": [0, 1.5, 0]}}})"))
              .ok());
  b.rig.app->open(row);
  b.play("wait 3\nclick body:brick[0]\nwait 2");
  b.play("hold Ctrl\nclick body:brick[1]\nlet Ctrl\nwait 2\nkey Ctrl+C\nwait 2");
  REQUIRE(b.rig.app->selection().size() == 2);
  b.rig.app->open(b.file);
  b.play("wait 3\nmove " + b.at({0, 0, 2}) + "\nwait 2\nkey Ctrl+V\nwait 3");
  const auto poses = [&] {
    std::vector<Vec3> out;
    for (const char* name : {"brick", "brick_2"}) {
      const auto def = b.world().body_def(b.world().find_body(name));
      REQUIRE_MESSAGE(def.has_value(), name);
      out.push_back(def->pose.x);
    }
    return out;
  };
  const auto pasted = poses();
  CHECK((pasted[1] - pasted[0] - Vec3::UnitX()).norm() < 1e-12);
  const uint64_t built = b.hash();
  b.save();
  CHECK_FALSE(b.rig.app->ui_state().shows(PanelId::save));
  CHECK(b.content().find("\"brick_2\": {") != std::string::npos);
  b.rig.app->open(b.file);
  b.play("wait 3");
  CHECK(b.hash() == built);
  CHECK(poses() == pasted);
  check_no_faults(*b.device);
}

TEST_CASE("placed meshes are taken back one by one, a file that is no mesh says so") {
  Laboratory b;
  const auto bad = b.rig.folder.path() / "bad.obj";
  REQUIRE(write_file(bad, std::string_view("v 0 0 0\n")).ok());
  const auto good = b.rig.folder.path() / "good.obj";
  REQUIRE(write_file(good, std::string_view("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n"
                                            "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"))
              .ok());
  b.play("click build.mesh_file\nwait 3\nclick scenes.file.bad.obj\nwait 3\nclick " +
         b.at({0, 0, 2}) + "\nwait 3");
  CHECK(says(b.rig, "This mesh cannot be placed"));
  CHECK(b.world().find_body("bad").is_null());
  b.play("click build.mesh_file\nwait 3\nclick scenes.file.good.obj\nwait 3\nclick " +
         b.at({0, 0, 2}) + "\nwait 3\nkey Esc\nwait 2");
  REQUIRE_FALSE(b.world().find_body("good").is_null());
  b.check_round_trip(30);
}

TEST_CASE("the palette lists meshes alone, and names with brackets and dots make no copies") {
  Laboratory b;
  const auto folder = b.rig.folder.path();
  const std::string_view wedge =
      "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
  REQUIRE(write_file(folder / "part[3].v2.obj", wedge).ok());
  for (const char* other : {"robot.urdf", "pack.tumble", "pack.zip"})
    REQUIRE(write_file(folder / other, wedge).ok());
  b.play("click build.mesh_file\nwait 3");
  REQUIRE(b.rig.app->ui().find("scenes.file.part[3].v2.obj"));
  for (const char* other : {"robot.urdf", "pack.tumble", "pack.zip"})
    CHECK_FALSE(b.rig.app->ui().find(std::string("scenes.file.") + other));
  b.play("click scenes.file.part[3].v2.obj\nwait 3\nclick " + b.at({0, 0, 2}) +
         "\nwait 3\nkey Esc\nwait 2");
  REQUIRE_FALSE(b.world().find_body("part_3__v2").is_null());
  const uint64_t built = b.hash();
  b.save();
  b.rig.app->open(b.file);
  b.play("wait 3");
  CHECK(b.hash() == built);
  check_no_faults(*b.device);
}

TEST_CASE("a mesh whose name is no UTF-8 is refused, and the window goes on") {
  const TempFolder folder;
  MeshPalette palette;
  palette.choose({(folder.path() / "caf\xe9.obj").string()}, 1, false);
  CHECK_FALSE(palette.ready());
  CHECK(palette.fault().find("UTF-8") != std::string::npos);
}

TEST_CASE("another choice of the palette gives up the mesh that is being read") {
  const auto shipped = resource_path("assets/meshes/star_prism.obj");
  REQUIRE(shipped.ok());
  MeshPalette palette;
  const NewMesh slow{shipped->string(), MeshMode::decomposition};
  const NewMesh wanted{shipped->string(), MeshMode::convex_hull};
  const auto done = [&](const NewMesh& mesh) {
    palette.choose(mesh, 1, true);
    const auto ready = palette.ready();
    return ready && ready->chosen == mesh;
  };
  palette.choose(slow, 1, true);
  for (const NewMesh& mesh : {wanted, slow, wanted}) {
    bool ready = false;
    for (int i = 0; i < 6000 && !ready; ++i) {
      ready = done(mesh);
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    CHECK(ready);
    CHECK(palette.fault().empty());
  }
}
