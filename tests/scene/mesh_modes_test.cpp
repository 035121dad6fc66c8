// What a mesh collides as: of each shape its own choice, kept, changed, saved and measured.
// References: the mass of the mesh by its own volume integral; boxes, whose fit is exact; what is
// made without a cache; where a body of a known shape comes to rest.
#include "engine/geometry/mass_properties/mass_properties.hpp"
#include "engine/scene/build.hpp"
#include "engine/scene/build/field_cache.hpp"
#include "engine/scene/build/fit_cache.hpp"
#include "engine/scene/build/mesh_parts.hpp"
#include "engine/scene/build/mesh_representations.hpp"
#include "engine/scene/mesh_import.hpp"
#include "engine/scene/resources.hpp"
#include "engine/scene/saving/scene_edits.hpp"
#include "engine/world/replay.hpp"
#include "engine/world/world.hpp"
#include "tests/scene/scene_text.hpp"
#include "tests/support/temp_folder.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>

#include <doctest/doctest.h>
#include <fmt/format.h>
#include <sys/stat.h>

using namespace tumble;
namespace fs = std::filesystem;

namespace {

BuiltScene with_modes(const std::string& members) {
  const SceneRead read = read_scene(scene_with(members), "x.json");
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

BodyId id_of(const BuiltScene& scene, std::string_view name) {
  const auto it = scene.bodies.find(name);
  REQUIRE(it != scene.bodies.end());
  return it->second;
}

const RigidBody& live(const BuiltScene& scene, std::string_view name) {
  return *scene.world->body(id_of(scene, name));
}

std::shared_ptr<const TriangleMesh> shipped_mesh(const std::string& name) {
  const auto file = find_mesh_file({}, name);
  REQUIRE(file.ok());
  auto mesh = import_mesh(*file, {});
  REQUIRE(mesh.ok());
  return std::make_shared<const TriangleMesh>(std::move(mesh->mesh));
}

const std::string modes[] = {"triangle_mesh", "convex_hull", "decomposition", "field", "fit"};

/// A star in every mode, side by side, of one declaration.
std::string five_stars() {
  std::string bodies;
  for (size_t k = 0; k < 5; ++k)
    bodies += (k ? ", \"" : "\"") + modes[k] +
              R"(": {"shape": {"type": "mesh", "mesh": "star", "mode": ")" + modes[k] +
              R"("}, "density": 1000, "position": [)" + std::to_string(k) + ", 1, 0]}";
  return R"("meshes": {"star": "star_prism.obj"}, "bodies": {)" + bodies + "}";
}

/// A file of a box of these extents, and what declares it.
std::string box_file(const TempFolder& folder, const Vec3& size) {
  const fs::path file = folder.path() / "box.obj";
  std::ofstream out(file);
  for (int k = 0; k < 8; ++k)
    out << "v " << (k & 1 ? .5 : -.5) * size.x() << ' ' << (k & 2 ? .5 : -.5) * size.y() << ' '
        << (k & 4 ? .5 : -.5) * size.z() << '\n';
  out << "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";
  return R"("meshes": {"box": ")" + file.string() + R"("}, )";
}

}  // namespace

TEST_CASE("of one mesh every shape collides as it says itself, and approximations are told") {
  const BuiltScene scene = with_modes(five_stars());
  const double mass = mesh_mass(*shipped_mesh("star_prism.obj"), 1000).value().mass;
  for (const std::string& mode : modes) {
    INFO(mode);
    const RigidBody& body = live(scene, mode);
    CHECK((body.shapes.size() > 1) == (mode == "decomposition"));
    if (mode != "convex_hull") CHECK(body.mass == doctest::Approx(mass).epsilon(1e-4));
  }
  CHECK(live(scene, "field").shapes[0].shape->field() != nullptr);
  CHECK(live(scene, "convex_hull").shapes[0].shape->convex() != nullptr);
  CHECK(live(scene, "fit").shapes[0].shape->convex() != nullptr);
  CHECK_FALSE(made_of_mesh(live(scene, "fit").shapes[0].shape->type()));
  for (const std::string mode : {"field", "fit"}) {
    const auto tells = [&](const std::string& w) {
      return w.starts_with("bodies." + mode + ".shape: approximate");
    };
    CHECK(std::ranges::count_if(scene.warnings, tells) == 1);
  }
}

TEST_CASE("a mesh that is declared as fit is one primitive with the mesh's mass") {
  const TempFolder folder;
  std::string members = box_file(folder, {0.4, 0.3, 0.2});
  members.replace(members.find(R"("box": )") + 7, 0, R"({"mode": "fit", "file": )");
  members.replace(members.find("}, "), 0, "}");
  const BuiltScene scene =
      with_modes(members + R"("bodies": {"box": {"shape": {"type": "mesh", "mesh": "box"}}})");
  const Shape& shape = *live(scene, "box").shapes[0].shape;
  CHECK(shape_entry(shape.type()).name == "box");
  Vec3 half = shape.def().half_extents;
  std::sort(half.data(), half.data() + 3);
  CHECK((half - Vec3(0.1, 0.15, 0.2)).norm() < 1e-6);
  CHECK(live(scene, "box").mass == doctest::Approx(24).epsilon(1e-6));
}

TEST_CASE("other shapes of the same mesh take a body's place, and those before come back") {
  const TempFolder folder;
  const BuiltScene scene = with_modes(five_stars());
  const auto def_of = [&](const std::string& mode) {
    return scene.world->body_def(id_of(scene, mode)).value();
  };
  for (const std::string& from : modes) {
    BodyDef def = def_of(from);
    REQUIRE(shape_groups(def).size() == 1);
    const auto source = source_of(def, shape_groups(def)[0]);
    REQUIRE(source);
    CHECK(source->how.mode == MeshMode(std::ranges::find(modes, from) - std::begin(modes)));
    for (size_t k = 0; k < 5; ++k) {
      INFO(from << " -> " << modes[k]);
      const auto parts = mesh_parts(source->mesh, {.mode = MeshMode(k)});
      REQUIRE(parts.ok());
      replace_group(def, 0, *parts);
      const BodyDef wanted = def_of(modes[k]);
      REQUIRE(def.shapes.size() == wanted.shapes.size());
      for (size_t i = 0; i < def.shapes.size(); ++i) {
        CHECK(def.shapes[i].shape.type == wanted.shapes[i].shape.type);
        CHECK(def.shapes[i].pose.x == wanted.shapes[i].pose.x);
        CHECK(def.shapes[i].material.density ==
              doctest::Approx(wanted.shapes[i].material.density).epsilon(1e-12));
      }
    }
  }
}

TEST_CASE("a world takes a changed body, and snapshots hold what its shapes stand for") {
  BuiltScene scene = with_modes(five_stars());
  const BodyId id = id_of(scene, "decomposition");
  BodyDef def = scene.world->body_def(id).value();
  const auto source = source_of(def, shape_groups(def)[0]);
  replace_group(def, 0, mesh_parts(source->mesh, {.mode = MeshMode::fit}).value());
  REQUIRE(scene.world->set_body(id, def).ok());
  REQUIRE(scene.world->step().ok());
  CHECK(scene.world->body(id)->shapes.size() == 1);
  const auto snapshot = scene.world->save();
  WorldDef extras;
  extras.threads = 1;
  auto other = World::create(std::move(extras)).value();
  REQUIRE(other->load(snapshot).ok());
  CHECK(other->state_hash() == scene.world->state_hash());
  BodyDef read = other->body_def(id).value();
  const auto kept = source_of(read, shape_groups(read)[0]);
  REQUIRE(kept);
  CHECK(kept->how.mode == MeshMode::fit);
  CHECK(kept->mesh->vertices == source->mesh->vertices);
  replace_group(read, 0, mesh_parts(kept->mesh, {.mode = MeshMode::decomposition}).value());
  CHECK(read.shapes.size() > 2);
}

TEST_CASE(
    "modes that change while a world runs are commands: a replay passes through all of them") {
  BuiltScene scene = with_modes(five_stars());
  World& world = *scene.world;
  const BodyId id = id_of(scene, "decomposition");
  for (const MeshMode mode : {MeshMode::fit, MeshMode::triangle_mesh, MeshMode::field,
                              MeshMode::convex_hull, MeshMode::decomposition}) {
    BodyDef def = world.body_def(id).value();
    const auto source = source_of(def, shape_groups(def)[0]);
    REQUIRE(source);
    replace_group(def, 0, mesh_parts(source->mesh, {.mode = mode}).value());
    const uint64_t before = world.state_hash();
    REQUIRE(world.set_body(id, def).ok());
    CHECK(world.state_hash() == before);  // nothing happens before the tick
    for (int i = 0; i < 3; ++i) REQUIRE(world.step().ok());
    CHECK(world.body(id)->shapes.size() == def.shapes.size());
  }
  const auto played = run_replay(save_replay(world));
  REQUIRE(played.ok());
  CHECK(played->same);
  CHECK(played->world->tick() == world.tick());
  BodyDef read = played->world->body_def(id).value();
  const auto kept = source_of(read, shape_groups(read)[0]);
  REQUIRE(kept);
  CHECK(kept->how.mode == MeshMode::decomposition);
}

TEST_CASE("a changed mode is saved with the shape, and read again") {
  const std::string text = scene_with(five_stars());
  const BuiltScene scene = with_modes(five_stars());
  const BodyDef before = scene.world->body_def(id_of(scene, "decomposition")).value();
  BodyDef after = before;
  const auto source = source_of(before, shape_groups(before)[0]);
  replace_group(after, 0, mesh_parts(source->mesh, {.mode = MeshMode::fit}).value());
  const std::vector<SceneEdit> edits{ChangedBody{"decomposition", before, after}};
  const auto saved = save_edits(text, "x.json", edits);
  REQUIRE(saved.ok());
  CHECK(saved->left_out.empty());
  const SceneRead read = read_scene(saved->text, "x.json");
  REQUIRE(read.ok());
  const BodyDescription& body = *read.scene.bodies.find("decomposition");
  CHECK(std::get<MeshShapeDescription>(body.shape->kind).how.mode == MeshMode::fit);
  CHECK(body.placement.position == Vec3(2, 1, 0));
  CHECK(body.density == 1000.0);
}

TEST_CASE("fields and fits are kept by content: the same from the cache, anew when damaged") {
  const TempFolder folder;
  const auto mesh = shipped_mesh("star_prism.obj");
  const FieldCache fields(folder.path() / "fields");
  const FitCache fits(folder.path() / "fits");
  const uint64_t field = FieldCache(fs::path()).field(mesh, 0.02).value()->hash();
  const FittedPrimitive fit = FitCache(fs::path()).fit(mesh).value();
  const auto check_same = [&] {
    const auto again = fields.field(mesh, 0.02).value();
    CHECK(again->hash() == field);
    CHECK(again->report().bytes > 0);
    const FittedPrimitive kept = fits.fit(mesh).value();
    CHECK(kept.shape.type == fit.shape.type);
    CHECK(kept.shape.half_extents == fit.shape.half_extents);
    CHECK(kept.pose.x == fit.pose.x);
    CHECK(kept.error.added == fit.error.added);
  };
  check_same();
  for (const fs::path& cache : {fields.folder(), fits.folder()}) {
    std::vector<fs::path> files(fs::directory_iterator(cache), {});
    REQUIRE(files.size() == 1);
    check_same();
    std::fstream(files[0], std::ios::in | std::ios::out | std::ios::binary).seekp(40).put('x');
    check_same();
    fs::resize_file(files[0], fs::file_size(files[0]) / 2);
    check_same();
  }
  CHECK(fields.field(mesh, 0.03).ok());
  CHECK(std::vector<fs::path>(fs::directory_iterator(fields.folder()), {}).size() == 2);
}

TEST_CASE("a folder or a pipe in the place of a cache entry costs nothing but time") {
  // References: what is made without a cache. A pipe that nobody writes to would be read for ever.
  const TempFolder folder;
  const auto mesh = shipped_mesh("star_prism.obj");
  const FitCache fits(folder.path() / "fits");
  const FittedPrimitive fit = fits.fit(mesh).value();
  const std::vector<fs::path> files(fs::directory_iterator(fits.folder()), {});
  REQUIRE(files.size() == 1);
  fs::remove(files[0]);
  fs::create_directory(files[0]);
  CHECK(fits.fit(mesh).value().pose.x == fit.pose.x);
  CHECK(fs::is_directory(files[0]));
  fs::remove(files[0]);
  REQUIRE(::mkfifo(files[0].c_str(), 0600) == 0);
  CHECK(fits.fit(mesh).value().pose.x == fit.pose.x);
}

TEST_CASE("hulls and pieces say how far they are from their mesh, unless they are it") {
  // References: a star fills only part of its hull, by the volumes of both; a box is its own.
  const TempFolder folder;
  const auto warnings = [](const std::string& mesh, const std::string& shape) {
    return with_modes(mesh + R"("bodies": {"b": {"shape": )" + shape + "}}").warnings;
  };
  const std::string star = R"("meshes": {"m": "star_prism.obj"}, )";
  std::string box = box_file(folder, {0.4, 0.3, 0.2});
  box.replace(box.find("\"box\""), 5, "\"m\"");
  const auto mesh = shipped_mesh("star_prism.obj");
  ShapeDef hull_def;
  hull_def.type = ShapeType::convex_hull;
  hull_def.mesh = mesh;
  const double ratio =
      make_shape(hull_def).value()->mass_properties().value().mass / mesh_mass(*mesh).value().mass;
  REQUIRE(ratio > 1.2);
  const std::string hulls[] = {R"({"type": "mesh", "mesh": "m", "mode": "convex_hull"})",
                               R"({"type": "convex_hull", "mesh": "m"})"};
  for (const std::string& shape : hulls) {
    INFO(shape);
    const auto of_star = warnings(star, shape);
    REQUIRE(of_star.size() == 1);
    INFO(of_star[0]);
    CHECK(of_star[0].starts_with("bodies.b.shape: approximate: touches as its convex hull"));
    CHECK(of_star[0].find(fmt::format("{:.3g} times the mesh's volume", ratio)) !=
          std::string::npos);
    CHECK(warnings(box, shape).empty());
    // Once for a mesh, however many bodies are of it.
    CHECK(with_modes(star + "\"bodies\": {\"b\": {\"shape\": " + shape +
                     "}, \"c\": {\"position\": [9, 9, 9], \"shape\": " + shape + "}}")
              .warnings.size() == 1);
  }
  const std::string pieces =
      R"({"type": "mesh", "mesh": "m", "mode": "decomposition", "pieces": 1})";
  const auto of_star = warnings(star, pieces);
  REQUIRE(of_star.size() == 1);
  CHECK(of_star[0].find("approximate: touches as convex pieces (") != std::string::npos);
  CHECK(warnings(box, pieces).empty());
  const std::string declared =
      R"("meshes": {"m": {"file": "star_prism.obj", "mode": "convex_hull"}}, )";
  const auto of_mesh = warnings(declared, R"({"type": "mesh", "mesh": "m"})");
  REQUIRE(of_mesh.size() == 1);
  CHECK(of_mesh[0].starts_with("meshes.m: approximate"));
}

TEST_CASE("representations side by side: errors of a box and of a star, refusals of an open mesh") {
  const TempFolder folder;
  box_file(folder, {0.4, 0.3, 0.2});
  const auto box = import_mesh(folder.path() / "box.obj", {});
  REQUIRE(box.ok());
  const auto of_box = measure_representations(std::make_shared<const TriangleMesh>(box->mesh));
  REQUIRE(of_box.size() == mesh_mode_count);
  for (const RepresentationFacts& f : of_box) {
    INFO(f.words);
    CHECK(f.refusal.empty());
    CHECK(f.parts.parts.size() == 1);
    const double bound = f.mode == MeshMode::field ? 0.4 / 64 : 1e-6;
    CHECK(f.error.added <= bound);
    CHECK(f.error.missing <= bound);
    CHECK(f.volume_ratio == doctest::Approx(1).epsilon(1e-5));
    CHECK(f.bytes > 0);
    CHECK(f.query_ns > 0);
  }
  const auto of_star = measure_representations(shipped_mesh("star_prism.obj"));
  const auto star = [&](MeshMode mode) { return of_star[size_t(mode)]; };
  CHECK(star(MeshMode::triangle_mesh).error.larger() == 0);
  CHECK(star(MeshMode::convex_hull).error.missing < 1e-9);
  // The hull spans from tip to tip: its side lies outside of the notch by what the notch is deep.
  CHECK(star(MeshMode::convex_hull).error.added > 0.05);
  CHECK(star(MeshMode::decomposition).error.added < 0.02);
  CHECK(star(MeshMode::decomposition).parts.parts.size() > 2);
  CHECK(star(MeshMode::fit).error.larger() > star(MeshMode::decomposition).error.larger());
  CHECK(representations_text(of_star).find("decomposition") != std::string::npos);

  TriangleMesh open = box->mesh;
  open.triangles.resize(open.triangles.size() - 2);
  for (const RepresentationFacts& f :
       measure_representations(std::make_shared<const TriangleMesh>(open))) {
    const bool needs_inside = f.mode == MeshMode::decomposition || f.mode == MeshMode::field;
    CHECK(f.refusal.empty() == !needs_inside);
  }
}

TEST_CASE("five representations of a box come to rest alike, to their stated errors" *
          doctest::test_suite("long")) {
  const TempFolder folder;
  const std::string declared = box_file(folder, {0.4, 0.3, 0.2});
  for (const std::string& mode : modes) {
    INFO(mode);
    BuiltScene scene = with_modes(
        declared + R"("bodies": {"floor": {"type": "static", "shape": {"type": "half_space"}},
          "box": {"shape": {"type": "mesh", "mesh": "box", "mode": ")" +
        mode + R"("}, "position": [0, 0.25, 0], "angular_velocity": [0, 0, 1]}})");
    for (int i = 0; i < 150; ++i) REQUIRE(scene.world->step().ok());
    const double error = mode == "field" ? 0.4 / 64 : 1e-3;
    CHECK(std::abs(live(scene, "box").pose.x.y() - 0.15) < error);
  }
}

TEST_CASE("numbers belong to the way of colliding that the shape chose itself") {
  const auto faults = [](const std::string& shape) {
    return all_text(read_scene(scene_with(R"("meshes": {"a": "star_prism.obj"}, "bodies": {"b":
        {"shape": {"type": "mesh", "mesh": "a", )" +
                                          shape + "}}}"),
                               "x.json")
                        .faults);
  };
  CHECK(faults(R"("mode": "fit")").empty());
  CHECK(faults(R"("mode": "fit", "cell": 0.1)").find("only mode field has cells") !=
        std::string::npos);
  CHECK(faults(R"("mode": "box")").find("fit") != std::string::npos);  // names those there are
}
