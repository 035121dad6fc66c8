// Saving what was changed in a running world. Reference: the world that the saved file gives has
// the changed values, and every other body as before; lines that were not meant keep their bytes.
#include "engine/scene/saving/scene_edits.hpp"

#include "engine/math/det/det.hpp"
#include "engine/math/rotation.hpp"
#include "engine/math/time_course.hpp"
#include "engine/scene/build.hpp"
#include "engine/scene/description/placement.hpp"
#include "engine/scene/reader.hpp"
#include "engine/scene/saving/changed_lines.hpp"
#include "engine/world/world.hpp"
#include "tests/scene/scene_text.hpp"
#include "tests/support/temp_folder.hpp"
#include "tests/support/why_not.hpp"

#include <doctest/doctest.h>

using namespace tumble;

namespace {

std::string shipped_file(const std::string& name) {
  return std::string(TUMBLE_SOURCE_DIR) + "/scenes/" + name + ".json";
}

BuiltScene built(const std::string& text, const std::string& file) {
  const SceneRead read = read_scene(text, file);
  INFO(all_text(read.faults));
  REQUIRE(read.ok());
  auto made = build_world(read.scene);
  REQUIRE_MESSAGE(made.ok(), test::why_not(made));
  return std::move(*made);
}

std::string saved(const std::string& text, const std::string& file,
                  const std::vector<SceneEdit>& edits) {
  const auto made = save_edits(text, file, edits);
  REQUIRE_MESSAGE(made.ok(), test::why_not(made));
  CHECK(made->left_out.empty());
  return made->text;
}

std::string replaced(std::string text, std::string_view from, std::string_view to) {
  const size_t at = text.find(from);
  REQUIRE(at != std::string::npos);
  return text.replace(at, from.size(), to);
}

constexpr const char* small = R"({
  "tumble_scene": 1,
  "parameters": { "h": 2 },
  // the ground
  "bodies": {
    "ground": { "type": "static", "shape": { "type": "half_space" } },
    "ball": { "shape": { "type": "sphere", "radius": 0.5 }, "position": [0, "= 2 * h", 0], "material": "steel" },
    "brick": {
      "shape": { "type": "box", "size": [1, 1, 1] }, // a cube
      "repeat": { "type": "stack", "count": 3, "step": [0, 1, 0] },
      "position": [3, 0.5, 0]
    }
  },
  "joints": { "hold": { "kind": "rigid", "b": "ball", "anchor": [0, 4, 0] } },
  "cameras": { "main": { "position": [8, 2, 9], "target": [0, 1, 0] } }
}
)";

}  // namespace

TEST_CASE("saving without a change gives the same bytes, one value is one line") {
  for (const std::string name : {"tower", "hello", "table", "dominoes", "crane", "joints"}) {
    CAPTURE(name);
    const std::string file = shipped_file(name), text = file_text(file);
    CHECK(saved(text, file, {}) == text);
    const BuiltScene scene = built(text, file);
    int tried = 0;
    for (const auto& [body, id] : scene.bodies) {
      const auto before = scene.world->body_def(id);
      REQUIRE(before.has_value());
      if (before->type != BodyType::dynamic || tried++ > 3) continue;
      const auto& shown_body = body;
      CAPTURE(shown_body);
      BodyDef after = *before;
      after.mass = 7.25;
      const std::string changed = saved(text, file, {ChangedBody{body, *before, after}});
      const auto lines = changed_lines(text, changed);
      CHECK(lines.size() >= 1);
      CHECK(lines.size() <= 3);  // a member behind a last line gives that a comma
      const BuiltScene again = built(changed, file);
      CHECK(again.bodies.size() == scene.bodies.size());
      for (const auto& [other, other_id] : again.bodies) {
        const double mass = again.world->body(other_id)->mass;
        const bool copies = body.find('[') == std::string::npos && other == body;
        if (other == body || copies)
          CHECK(mass == doctest::Approx(7.25));
        else
          CHECK(mass == scene.world->body(scene.bodies.at(other))->mass);
      }
    }
    CHECK(tried > 0);
  }
}

TEST_CASE("values of bodies, copies, shapes and materials are saved where the file has them") {
  const BuiltScene scene = built(small, "small.json");
  const auto def = [&](const char* name) {
    return *scene.world->body_def(scene.bodies.find(name)->second);
  };
  BodyDef ball = def("ball"), brick = def("brick[1]"), ground = def("ground");
  BodyDef new_ball = ball, new_brick = brick, new_ground = ground;
  new_ball.shapes[0].shape.radius = 0.75;
  new_ball.shapes[0].material.friction = 0.9;
  new_ball.gravity_scale = 0.5;
  new_brick.pose.x = Vec3(4, 5, 6);
  new_brick.velocity = Vec3(1, 0, 0);
  new_ground.shapes[0].material.restitution = 0.3;
  const std::string text =
      saved(small, "small.json",
            {ChangedBody{"ball", ball, new_ball}, ChangedBody{"brick[1]", brick, new_brick},
             ChangedBody{"ground", ground, new_ground}, ChangedParameter{"h", 3}});
  CHECK(text.find("// the ground") != std::string::npos);
  CHECK(text.find("// a cube") != std::string::npos);
  CHECK(text.find("= 2 * h") != std::string::npos);
  const BuiltScene again = built(text, "small.json");
  const auto now = [&](const char* name) {
    return *again.world->body_def(again.bodies.find(name)->second);
  };
  CHECK(now("ball").shapes[0].shape.radius == 0.75);
  CHECK(now("ball").shapes[0].material.friction == 0.9);
  CHECK(now("ball").shapes[0].material.density == 7850);
  CHECK(now("ball").gravity_scale == 0.5);
  CHECK(now("ball").pose.x == Vec3(0, 6, 0));
  CHECK(now("brick[1]").pose.x == Vec3(4, 5, 6));
  CHECK(now("brick[1]").velocity == Vec3(1, 0, 0));
  CHECK(now("brick[0]").pose.x == def("brick[0]").pose.x);
  CHECK(now("ground").shapes[0].material.restitution == 0.3);
}

TEST_CASE("bodies, joints and springs that were added and removed are saved") {
  const BuiltScene scene = built(small, "small.json");
  AddedBody cone;
  cone.def.name = "new_cone";
  cone.def.pose = {Vec3(1, 2, 3), euler_deg_to_quat(Vec3(10, 20, 30))};
  cone.def.shapes.resize(1);
  for (const ShapeEntry& entry : all_shapes())
    if (entry.name == "cone") cone.def.shapes[0].shape.type = entry.type;
  cone.def.shapes[0].shape.height = 0.7;
  cone.def.shapes[0].material = {0.11, 0.2, 321};
  cone.def.look.colour = Vec3f(0.2f, 0.4f, 0.6f);
  AddedJoint hinge;
  hinge.def.name = "hinge";
  hinge.def.kind = JointKind::revolute;
  hinge.def.frame_a.x = Vec3(0.1, 0, 0);
  hinge.a = "new_cone", hinge.b = "brick[2]";
  AddedSpring spring;
  spring.name = "pull";
  spring.def.stiffness = 12;
  spring.b = "brick[0]";
  std::vector<SceneEdit> edits{cone, hinge, spring, RemovedBody{"ball"}, RemovedBody{"brick[1]"}};
  const std::string text = saved(small, "small.json", edits);
  const BuiltScene again = built(text, "small.json");
  CHECK(again.bodies.size() == 4);
  CHECK(again.joints.size() == 1);  // the one that held the ball is gone with it
  CHECK(again.joints.contains("hinge"));
  CHECK(again.forces.contains("pull"));
  const BodyDef now = *again.world->body_def(again.bodies.at("new_cone"));
  CHECK((now.pose.x - cone.def.pose.x).norm() < 1e-15);
  CHECK(now.pose.q.angularDistance(cone.def.pose.q) < 1e-7);
  CHECK(now.shapes[0].shape.type == cone.def.shapes[0].shape.type);
  CHECK(now.shapes[0].shape.height == 0.7);
  CHECK(now.shapes[0].material.friction == 0.11);
  CHECK(now.shapes[0].material.density == 321);
  CHECK((now.look.colour - cone.def.look.colour).norm() < 1e-6f);
  // What is made and taken away again leaves nothing but the rest.
  edits = {cone, RemovedBody{"new_cone"}};
  CHECK(saved(small, "small.json", edits) == small);
  WorldSettings settings = scene.world->settings(), lunar = settings;
  lunar.gravity = Vec3(0, -1.62, 0);
  lunar.realtime.substeps = 7;
  const BuiltScene moon =
      built(saved(small, "small.json", {ChangedSettings{settings, lunar}}), "small.json");
  CHECK(moon.world->settings().gravity.now().y() == -1.62);
  CHECK(moon.world->settings().realtime.substeps == 7);
}

TEST_CASE(
    "what was typed of a body comes back with as few digits, and its material only if need be") {
  AddedBody ball;
  ball.def.name = "new_ball";
  ball.def.shapes.resize(1);
  ball.def.look.colour = Colour{0.3, 0.55, 0.123}.linear();
  std::string text = saved(small, "small.json", {ball});
  const std::string added = text.substr(text.find("\"new_ball\""));
  const std::string body = added.substr(0, added.find("\"joints\""));
  CAPTURE(body);
  CHECK(body.find("0.3,") != std::string::npos);
  CHECK(body.find("0.123\n") + body.find("0.123]") != 2 * std::string::npos);
  CHECK(body.find("material") == std::string::npos);
  const BuiltScene again = built(text, "small.json");
  const BodyDef now = *again.world->body_def(again.bodies.at("new_ball"));
  CHECK(now.look.colour == ball.def.look.colour);
  CHECK(now.shapes[0].material.density == Material{}.density);
  // Every number of three digits, and every one of single precision at all.
  for (int n = 0; n <= 1000; ++n) {
    const double typed = double(n) / 1000;
    const Vec3f linear = Colour{typed, typed, typed}.linear();
    const double back = Colour::from_linear(linear).r;
    CHECK((back == typed || std::abs(back * 255 - std::round(back * 255)) < 1e-9));
    CHECK(Colour{back, back, back}.linear() == linear);
    const auto between = float(std::nextafter(linear[0], 1.0f));
    const double other = Colour::from_linear(Vec3f::Constant(between)).r;
    CHECK(Colour{other, other, other}.linear()[0] == between);
  }
}

TEST_CASE("a copy that is turned however far is saved as it stands") {
  const BuiltScene scene = built(small, "small.json");
  const BodyDef before = *scene.world->body_def(scene.bodies.at("brick[1]"));
  for (const Vec3& turned : {Vec3(0, 120, 0), Vec3(100, 0, 0), Vec3(0, 0, 179), Vec3(0, 180, 0),
                             Vec3(180, 0, 180), Vec3(10, 135, 30), Vec3(-95, 91, -170),
                             Vec3(0, 90, 0), Vec3(33, -90, 20), Vec3(0, 270, 0)}) {
    CAPTURE(turned.transpose());
    BodyDef after = before;
    after.pose.q = euler_deg_to_quat(turned);
    const std::string text = saved(small, "small.json", {ChangedBody{"brick[1]", before, after}});
    const BuiltScene again = built(text, "small.json");
    const auto def = [&](const char* name) {
      return *again.world->body_def(again.bodies.at(name));
    };
    // Reference: where the corners of the cube are, which has no other side for a quaternion.
    for (const Vec3& corner : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)})
      CHECK((def("brick[1]").pose.q * corner - after.pose.q * corner).norm() < 1e-12);
    CHECK(def("brick[1]").pose.x == before.pose.x);
    CHECK(def("brick[0]").pose.q.coeffs() == before.pose.q.coeffs());
    CHECK(def("brick[2]").pose.q.coeffs() == before.pose.q.coeffs());
  }
}

TEST_CASE("a spring that is added keeps the courses of its numbers and its radius") {
  AddedSpring spring;
  spring.name = "pull";
  spring.b = "ball";
  auto formula = TimeCourse::expression("12 + t");
  auto table = TimeCourse::table({{0, 1}, {2, 3}});
  REQUIRE(formula.ok());
  REQUIRE(table.ok());
  spring.def.stiffness = *formula;
  spring.def.rest_length = *table;
  spring.def.damping = 0.5;
  spring.def.cable_radius = 0.02;
  const BuiltScene again = built(saved(small, "small.json", {spring}), "small.json");
  REQUIRE(again.forces.contains("pull"));
  const auto* def = std::get_if<SpringDef>(again.world->force(again.forces.at("pull")));
  REQUIRE(def);
  REQUIRE(def->stiffness.varies());
  CHECK(def->stiffness.course->at(5) == 17);
  REQUIRE(def->rest_length.varies());
  CHECK(def->rest_length.course->at(1) == 2);
  CHECK_FALSE(def->damping.varies());
  CHECK(def->damping == 0.5);
  CHECK(def->cable_radius == 0.02);
}

TEST_CASE("what acts at a joint is saved, and taken away, where the file has it") {
  const std::string file = "small.json";
  const std::string text = replaced(small, "\"rigid\"", "\"revolute\"");
  BuiltScene scene = built(text, file);
  const JointDef before = *scene.world->joint(scene.world->find_joint("hold"));
  JointDef after = before;
  CoordinateDrive& drive = after.drives[0];
  drive.limits = {-0.5, 1, 0, 0, 0.25};
  drive.motor.kind = MotorKind::position;
  drive.motor.target = 0.75;
  drive.motor.stiffness = 40;
  drive.motor.max_force = 12;
  drive.friction = 0.125;
  after.break_force = 1e4;
  const std::string with = saved(text, file, {ChangedJoint{before, after}});
  const auto made = [](const BuiltScene& of) {
    return *of.world->joint(of.world->find_joint("hold"));
  };
  const JointDef read = made(built(with, file));
  CHECK(read.drives[0].limits.lower == doctest::Approx(-0.5));
  CHECK(read.drives[0].limits.upper == doctest::Approx(1));
  CHECK(read.drives[0].limits.restitution == 0.25);
  CHECK(read.drives[0].motor.kind == MotorKind::position);
  CHECK(read.drives[0].motor.target == doctest::Approx(0.75));
  CHECK(read.drives[0].motor.stiffness == 40);
  CHECK(read.drives[0].motor.max_force == 12);
  CHECK(read.drives[0].friction == 0.125);
  CHECK(read.break_force == 1e4);
  // Another kind of motor, softer stops, no bound: nothing of the old ones is left.
  JointDef other = read;
  other.drives[0].motor = {};
  other.drives[0].motor.kind = MotorKind::velocity;
  other.drives[0].motor.target = 3;
  other.drives[0].limits.restitution = 0;
  other.drives[0].limits.stiffness = 50;
  other.break_force = no_bound;
  const JointDef third = made(built(saved(with, file, {ChangedJoint{read, other}}), file));
  CHECK(third.drives[0].motor.kind == MotorKind::velocity);
  CHECK(third.drives[0].motor.target == 3);
  CHECK(third.drives[0].limits.stiffness == 50);
  CHECK(third.break_force == no_bound);
  // Taken back the file is what it was, but for an empty line at most.
  const JointDef bare = made(built(saved(with, file, {ChangedJoint{read, before}}), file));
  CHECK_FALSE(bare.drives[0].acts());
  CHECK_FALSE(bare.breaks());
  const std::string gone = saved(text, file, {RemovedJoint{"hold"}});
  CHECK(built(gone, file).world->find_joint("hold").is_null());
}

TEST_CASE("a joint that is added has all that acts at it") {
  const std::string file = "small.json";
  BuiltScene scene = built(small, file);
  JointDef joint;
  joint.name = "leg";
  joint.kind = JointKind::planar;
  joint.b = scene.world->find_body("ball");
  joint.frame_a.x = Vec3(0, 4, 0);
  joint.drives[1].spring = {7, 0.5, 0.25};
  joint.drives[2].limits = {-1, 1, 0, 0, 0};
  const BuiltScene with = built(saved(small, file, {AddedJoint{joint, "", "ball"}}), file);
  const JointDef read = *with.world->joint(with.world->find_joint("leg"));
  CHECK(read.drives[1].spring.stiffness == 7);
  CHECK(read.drives[1].spring.rest == 0.25);
  CHECK(read.drives[2].limits.lower == doctest::Approx(-1));
  CHECK_FALSE(read.drives[0].acts());
}

TEST_CASE("emitters, cloths and sensors are saved value by value, and taken away") {
  const std::string text = R"({
  "tumble_scene": 1,
  "parameters": { "n": 5 },
  "particles": {
    "rain": { "radius": 0.02 }, // drops
    "flag": { "cloth": { "corner": [0, 2, 0], "across": [1, 0, 0], "down": [0, -1, 0],
                         "columns": "= 2 * n", "rows": "$n", "pins": ["left"] } }
  },
  "emitters": { "cloud": { "particles": "rain", "rate": "$n", "speed": 2, "life": 3, "position": [0, 3, 0] } },
  "sensors": { "door": { "type": "gate", "radius": 0.5 } }
}
)";
  const SceneRead read = read_scene(text, "mine.json");
  INFO(all_text(read.faults));
  REQUIRE(read.ok());
  const EmitterDescription cloud = *read.scene.emitters.find("cloud");
  const ParticleSystemDescription flag = *read.scene.particles.find("flag");
  EmitterDescription faster = cloud;
  faster.speed.number.mean = 4;
  faster.placement.position.y() = 5;
  ParticleSystemDescription stiffer = flag;
  stiffer.cloth[0].stretch = 900;
  stiffer.cloth[0].sheet.rows = 7;
  SensorDescription disc = *read.scene.sensors.find("door");
  disc.count = 3;
  const std::string now = saved(text, "mine.json",
                                {ChangedPart{"cloud", cloud, faster},
                                 ChangedPart{"flag", flag, stiffer}, AddedPart{"row", disc}});
  // Expressions that were not meant are still there, and so are comments.
  for (const char* kept : {"\"= 2 * n\"", "\"rate\": \"$n\"", "// drops", "\"speed\": 4",
                           "\"stretch\": 900", "\"rows\": 7", "\"pins\": [\"left\"]"}) {
    CAPTURE(kept);
    CHECK(now.find(kept) != std::string::npos);
  }
  const BuiltScene scene = built(now, "mine.json");
  const Emitter* emitter = scene.world->emitter(scene.emitters.at("cloud"));
  CHECK(emitter->def->speed.mean == 4);
  CHECK(emitter->def->pose.x == Vec3(0, 5, 0));
  CHECK(emitter->def->rate == 5);
  CHECK(scene.world->particles(scene.particles.at("flag"))->size() == 63);  // seven are held
  CHECK(scene.sensors.contains("row[2]"));
  // The same again without them.
  CHECK(
      saved(text, "mine.json",
            {AddedPart{"row", disc}, RemovedPart{"row", disc}, ChangedPart{"cloud", cloud, cloud}})
          .find("\"row\"") == std::string::npos);
}

TEST_CASE("what would be no scene is not saved, and says why") {
  const std::string text =
      R"({"tumble_scene": 1, "bodies": {"a": {"shape": {"type": "sphere", "radius": 1}}}})";
  REQUIRE(read_scene(text, "x.json").ok());
  JointDef joint;
  joint.name = "hinge";
  const std::vector<SceneEdit> edits{AddedJoint{joint, "a", "nobody"}};
  const auto made = save_edits(text, "x.json", edits);
  REQUIRE_FALSE(made.ok());
  CHECK(made.error().text().find("joints.hinge.b") != std::string::npos);
}

TEST_CASE("turned bodies come back with the bits that they had") {
  const std::string text = small;
  const BuiltScene scene = built(text, "small.json");
  const auto before = scene.world->body_def(scene.bodies.at("ball"));
  REQUIRE(before.has_value());
  int tried = 0;
  for (int i = 0; i < 60; ++i) {
    BodyDef after = *before, added = *before;
    const Vec3 axis(std::cos(i), std::sin(3.0 * i), 0.4);
    after.pose.q = axis_angle(axis, 0.37 * i).normalized();  // as bodies have it
    added.pose.q = (axis_angle(axis, 30 * i * det::pi / 180) * after.pose.q).normalized();
    // A body makes its quaternion unit, which moves the last bits of one in fifteen again.
    const auto normalised = [](const Quat& q) { return q.normalized().coeffs() == q.coeffs(); };
    if (!normalised(after.pose.q) || !normalised(added.pose.q)) continue;
    ++tried;
    added.shapes[0].pose.q = after.pose.q;
    added.name = "new";
    const std::string changed =
        saved(text, "small.json", {ChangedBody{"ball", *before, after}, AddedBody{added}});
    CAPTURE(changed);
    const BuiltScene again = built(changed, "small.json");
    const auto of = [&](const char* name) { return *again.world->body_def(again.bodies.at(name)); };
    CHECK(of("ball").pose.q.coeffs() == after.pose.q.coeffs());
    CHECK(of("new").pose.q.coeffs() == added.pose.q.coeffs());
    CHECK(of("new").shapes[0].pose.q.coeffs() == added.shapes[0].pose.q.coeffs());
  }
  CHECK(tried > 30);
  // Round angles stay what people write.
  BodyDef after = *before;
  after.pose.q = euler_deg_to_quat({0, 0, 30});
  const std::string round = saved(text, "small.json", {ChangedBody{"ball", *before, after}});
  CHECK_MESSAGE(round.find("\"euler_deg\": [0.0, 0.0, 30.0]") != std::string::npos, round);
}

TEST_CASE("a mesh is named from where a link to the scene's folder leads") {
  const TempFolder temp;
  namespace fs = std::filesystem;
  const fs::path root = fs::weakly_canonical(temp.path());
  fs::create_directories(root / "deep/scenes");
  fs::create_directories(root / "meshes");
  fs::create_directory_symlink(root / "deep/scenes", root / "link");
  AddedBody body;
  body.def.name = "wedge";
  body.mesh = std::make_shared<const MeshOfBody>(
      MeshOfBody{.file = root / "meshes/wedge.obj", .material = Material{}});
  for (const char* folder : {"link", "deep/scenes"})
    CHECK(saved(small, (root / folder / "small.json").string(), {SceneEdit(body)})
              .find("\"../../meshes/wedge.obj\"") != std::string::npos);
}

TEST_CASE("a copy of a body of meshes has the shapes of its original, word for word") {
  const std::string text = R"({
  "tumble_scene": 1,
  "meshes": { "wedge": { "file": "tetrahedron.obj", "mode": "convex_hull" } },
  "bodies": {
    "wedge": {
      "shape": { "type": "mesh", "mesh": "wedge" }, // as its mesh says
      "material": "ice",
      "repeat": { "type": "stack", "count": 2, "step": [2, 0, 0] },
      "copies": { "1": { "material": "rubber" } }
    },
    "robe": { "shapes": [{ "type": "mesh", "mesh": "wedge", "mode": "triangle_mesh" }] }
  }
})";
  ShapeDef mesh;
  mesh.type = ShapeType::triangle_mesh;
  auto source = std::make_shared<MeshSource>();
  const auto added = [&](const std::string& like, MeshMode mode) {
    source = std::make_shared<MeshSource>();
    source->how.mode = mode;
    AddedBody out;
    out.def.name = "copy";
    out.def.pose.x = Vec3(0, 3, 0);
    out.def.shapes.push_back({.shape = mesh, .pose = {}, .material = {}, .source = source});
    out.like = like;
    return out;
  };
  const auto after = [&](const AddedBody& body) {
    const auto done = save_edits(text, "", std::vector<SceneEdit>{body});
    return done ? done->text : "fault: " + done.error().text();
  };
  const auto has = [](const std::string& all, std::string_view part) {
    CHECK_MESSAGE(all.find(part) != std::string::npos, all);
  };
  const std::string first = after(added("wedge[0]", MeshMode::convex_hull));
  has(first, R"("shape": { "type": "mesh", "mesh": "wedge" })");
  has(first, R"("position": [0.0, 3.0, 0.0])");
  CHECK(changed_lines(text, first).size() <= 4);
  CHECK(first.find("\"ice\"") != first.rfind("\"ice\""));
  const std::string second = after(added("wedge[1]", MeshMode::convex_hull));
  CHECK(second.find("\"rubber\"") != second.rfind("\"rubber\""));
  // One that collides in another way by now says so itself.
  has(after(added("wedge[0]", MeshMode::field)), R"("mode": "field")");
  has(after(added("robe", MeshMode::triangle_mesh)),
      R"("shapes": [{ "type": "mesh", "mesh": "wedge", "mode": "triangle_mesh" }])");
  // Of what is not in the file nobody knows the mesh.
  for (const char* nobody : {"nobody", ""}) {
    const auto done = save_edits(text, "", std::vector<SceneEdit>{added(nobody, MeshMode::field)});
    REQUIRE(done.ok());
    CHECK(done->text == text);
    REQUIRE(done->left_out.size() == 1);
    CHECK(done->left_out[0].find("not known") != std::string::npos);
  }
}
