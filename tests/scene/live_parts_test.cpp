// Parts of a world that runs, changed from their descriptions. Reference: the world that is built
// from the changed description in the first place; replays; counts written out here.
#include "engine/scene/build/live_parts.hpp"

#include "engine/world/replay.hpp"
#include "engine/world/world.hpp"
#include "tests/scene/scene_text.hpp"
#include "tests/support/why_not.hpp"

using namespace tumble;

namespace {

BuiltScene built(const SceneDescription& scene) {
  WorldDef extras;
  extras.threads = 1;
  auto made = build_world(scene, extras);
  REQUIRE_MESSAGE(made.ok(), test::why_not(made));
  return std::move(*made);
}

SceneDescription scene_of(const std::string& members) {
  SceneRead read = read_scene(scene_with(members), data_file("x.json"));
  REQUIRE_MESSAGE(read.ok(), all_text(read.faults));
  return std::move(read.scene);
}

/// A system that everything names that can.
SceneDescription named_by_all() {
  return scene_of(R"("bodies": {"box": {"shape": {"type": "box", "size": [1, 1, 1]},
                                         "position": [9, 9, 9]}},
    "particles": {
      "dust": {"mass": 0.5, "radius": 0.1, "detect": true,
               "fill": {"type": "lattice", "size": [0.5, 0.5, 0.5], "spacing": 0.25,
                        "centre": [0, 1, 0]}},
      "other": {"mass": 1, "list": [[0, 2, 0], [0.3, 2, 0]],
                "rope": {"path": [{"particles": "dust", "index": 3}, {"point": [1, 3, 0]}],
                         "segments": 3}}},
    "forces": {
      "bond": {"type": "lennard_jones", "between": ["dust"], "epsilon": 0.2, "sigma": 0.25},
      "pull": {"type": "attractor", "centre": [0, 3, 0], "strength": 2, "particles": ["dust"]},
      "string": {"type": "spring", "a": {"particles": "dust", "index": 2},
                 "b": {"point": [0, 3, 0]}, "stiffness": 20}},
    "emitters": {"jet": {"particles": "dust", "rate": 3, "life": 1, "position": [5, 5, 5],
                         "speed": 30}},
    "sinks": {"drain": {"type": "plane", "particles": ["dust"], "position": [0, 0.5, 0]}},
    "sensors": {"eye": {"type": "region", "size": [4, 4, 4], "position": [0, 1, 0],
                        "particles": ["dust"]}})");
}

/// Changes one part of a scene in the world and in the description.
template <class T, class F>
Status change(LiveParts& live, World& world, SceneDescription& scene, const std::string& name,
              NamedList<T>& list, const F& f) {
  for (auto& item : list.items) {
    if (item.name != name) continue;
    const PartDescription before = item.value;
    f(item.value);
    const PartDescription after = item.value;
    const Status done = live.set(world, scene, name, after, &before);
    if (!done) item.value = std::get<T>(before);
    return done;
  }
  FAIL("no such part");
  return {};
}

void check_same_future(World& a, World& b, int ticks) {
  for (int n = 0; n <= ticks; ++n) {
    REQUIRE(a.frame()->particles.size() == b.frame()->particles.size());
    CHECK(a.state_hash() == b.state_hash());
    REQUIRE(a.step().ok());
    REQUIRE(b.step().ok());
  }
}

}  // namespace

TEST_CASE("what names a particle system follows it when it begins anew") {
  SceneDescription scene = named_by_all();
  BuiltScene live_scene = built(scene);
  World& world = *live_scene.world;
  LiveParts live(live_scene);
  const ParticleSystemId id = live_scene.particles.at("dust");
  const Moment before = world.moment();
  REQUIRE(change(live, world, scene, "dust", scene.particles, [](auto& d) {
            std::get<LatticeFill>(d.fill[0].kind).spacing = 0.2;
            d.mass = 0.7;
          }).ok());
  CHECK(world.find_body("box") == live_scene.bodies.at("box"));
  REQUIRE(world.particles(id));
  CHECK(world.particles(id)->size() > 8);
  CHECK(world.emitter(live_scene.emitters.at("jet"))->def->mass.mean == 0.7);
  BuiltScene fresh = built(scene);
  check_same_future(world, *fresh.world, 40);
  const auto again = run_replay(save_replay(world));
  REQUIRE(again.ok());
  CHECK(again->world->state_hash() == world.state_hash());
  // And back.
  REQUIRE(world.restore(before).ok());
  BuiltScene old = built(named_by_all());
  check_same_future(world, *old.world, 10);
}

TEST_CASE("values of particles change where they are") {
  SceneDescription scene = named_by_all();
  BuiltScene s = built(scene);
  World& world = *s.world;
  LiveParts live(s);
  for (int n = 0; n < 30; ++n) REQUIRE(world.step().ok());
  const ParticleSystemId id = s.particles.at("dust");
  const ParticleSystem was = *world.particles(id);
  REQUIRE(was.size() > was.id.size() / 2);
  const auto forces = world.frame()->forces.size();
  REQUIRE(change(live, world, scene, "dust", scene.particles, [](auto& d) {
            d.friction = 0.1;
            d.mass = 2;
            d.radius = 0.05;
            d.colour = {1, 0, 0};
          }).ok());
  const ParticleSystem& is = *world.particles(id);
  CHECK(is.friction == 0.1);
  REQUIRE(is.id == was.id);
  CHECK(world.frame()->forces.size() == forces);
  bool emitted = false;
  for (size_t i = 0; i < is.size(); ++i) {
    CHECK(is.x[i] == was.x[i]);
    CHECK(is.v[i] == was.v[i]);
    const bool of_jet = !is.emitter[i].is_null();
    emitted = emitted || of_jet;
    CHECK(is.mass[i] == (of_jet ? 0.5 : 2));
    CHECK(is.radius[i] == (of_jet ? 0.1 : 0.05));
  }
  CHECK(emitted);
  for (int n = 0; n < 15; ++n) REQUIRE(world.step().ok());
  CHECK(world.particles(id)->mass.back() == 2);
}

TEST_CASE("a change that leaves a spring without its particle is refused") {
  SceneDescription scene = named_by_all();
  BuiltScene s = built(scene);
  LiveParts live(s);
  const uint64_t hash = s.world->state_hash();
  const Status done = change(live, *s.world, scene, "dust", scene.particles, [](auto& d) {
    d.fill.clear();
    d.list.resize(2);
  });
  REQUIRE_FALSE(done.ok());
  CHECK(done.error().text().find("has no particle 2") != std::string::npos);
  CHECK(s.world->state_hash() == hash);
}

TEST_CASE("an emitter that is changed goes on, its bursts too") {
  SceneDescription scene = scene_of(
      "\"particles\": {\"dust\": {\"fast\": true}},\n"
      "\"emitters\": {\"jet\": {\"particles\": \"dust\", \"bursts\": [{\"time\": 0, \"count\": 7}],"
      "\"events\": [{\"event\": \"death\", \"emitter\": \"spark\", \"count\": 2}], \"life\": 0.5},"
      "\"spark\": {\"particles\": \"dust\", \"life\": 9}}");
  BuiltScene s = built(scene);
  World& world = *s.world;
  LiveParts live(s);
  const ParticleSystem& dust = *world.particles(s.particles.at("dust"));
  for (int n = 0; n < 5; ++n) REQUIRE(world.step().ok());
  CHECK(dust.size() == 7);
  for (const double speed : {1.0, 2.0, 3.0})
    REQUIRE(change(live, world, scene, "jet", scene.emitters, [&](auto& d) {
              d.speed.number.mean = speed;
            }).ok());
  REQUIRE(change(live, world, scene, "spark", scene.emitters, [](auto& d) {
            d.speed.number.mean = 4;
          }).ok());
  REQUIRE(world.step().ok());
  CHECK(dust.size() == 7);
  while (world.time() < 0.6) REQUIRE(world.step().ok());
  REQUIRE(dust.size() == 14);
  CHECK(dust.emitter[0] == s.emitters.at("spark"));
  // In a circle: refused.
  const Status circle = change(live, world, scene, "spark", scene.emitters, [](auto& d) {
    d.events.push_back({.event = SpawnRule::On::death, .emitter = "jet"});
  });
  CHECK_FALSE(circle.ok());
}

TEST_CASE("an emitter emits from another mesh of the scene, and from none that it lacks") {
  SceneDescription scene = scene_of(
      "\"meshes\": {\"tetra\": \"tetra.obj\", \"big\": {\"file\": \"tetra.obj\", \"scale\": 10}},\n"
      "\"particles\": {\"dust\": {\"fast\": true, \"gravity_scale\": 0}},\n"
      "\"emitters\": {\"jet\": {\"particles\": \"dust\", \"rate\": 600, \"life\": 0.4,"
      "\"shape\": {\"type\": \"mesh_surface\", \"mesh\": \"tetra\"}}}");
  BuiltScene s = built(scene);
  World& world = *s.world;
  LiveParts live(s);
  const auto reach = [&] {
    for (int n = 0; n < 60; ++n) REQUIRE(world.step().ok());
    double most = 0;
    for (const Vec3& x : world.particles(s.particles.at("dust"))->x)
      most = std::max(most, x.norm());
    return most;
  };
  const double small = reach();
  const auto emit_from = [&](const char* mesh) {
    return change(live, world, scene, "jet", scene.emitters, [&](auto& d) {
      std::get<MeshEmissionDescription<MeshSurfaceEmission>>(d.shape->kind).mesh = mesh;
    });
  };
  REQUIRE(emit_from("big").ok());
  CHECK(reach() > 5 * small);
  const Status none = emit_from("nothing");
  REQUIRE_FALSE(none.ok());
  CHECK(none.error().text().find("there is no mesh 'nothing'") != std::string::npos);
}

TEST_CASE("values that change leave springs and ropes as they are") {
  SceneDescription scene = named_by_all();
  BuiltScene s = built(scene);
  World& world = *s.world;
  LiveParts live(s);
  for (int n = 0; n < 5; ++n) REQUIRE(world.step().ok());
  const auto ids = [&] {
    std::vector<ForceId> out;
    for (const ForceFrame& f : world.frame()->forces) out.push_back(f.id);
    return out;
  };
  const std::vector<ForceId> was = ids();
  const ParticleSystem other = *world.particles(s.particles.at("other"));
  REQUIRE(change(live, world, scene, "dust", scene.particles, [](auto& d) { d.mass = 2; }).ok());
  CHECK(ids() == was);
  CHECK(world.particles(s.particles.at("other"))->x == other.x);
}

TEST_CASE("ropes of two systems through each other are refused, before anything is changed") {
  SceneDescription scene = named_by_all();
  BuiltScene s = built(scene);
  LiveParts live(s);
  const uint64_t hash = s.world->state_hash();
  const auto rope_through = [&](const char* system) {
    return change(live, *s.world, scene, "dust", scene.particles, [&](auto& d) {
      RopeDescription rope;
      rope.path.resize(2);
      rope.path[0].anchor.particles = system;
      rope.path[1].anchor.point = Vec3(3, 3, 3);
      d.rope.push_back(rope);
    });
  };
  for (const char* system : {"other", "dust"}) {
    const Status done = rope_through(system);
    REQUIRE_FALSE(done.ok());
    CHECK(done.error().text().find("back to it") != std::string::npos);
    CHECK(s.world->state_hash() == hash);
  }
}

TEST_CASE("a rope runs through particles that the file describes later") {
  const std::string members = R"("particles": {
      "line": {"rope": {"path": [{"particles": "balls", "index": 1}, {"point": [1, 3, 0]}],
                        "segments": 3}},
      "balls": {"mass": 1, "list": [[0, 2, 0], [0.3, 2, 0]]PLUS}})";
  const auto with = [&](const std::string& plus) {
    return scene_of(std::string(members).replace(members.find("PLUS"), 4, plus));
  };
  BuiltScene s = built(with(""));
  CHECK(s.world->particles(s.particles.at("line"))->size() >= 2);
  WorldDef extras;
  extras.threads = 1;
  const auto circle = build_world(
      with(R"(, "rope": {"path": [{"particles": "line"}, {"point": [1, 3, 0]}], "segments": 3})"),
      extras);
  REQUIRE_FALSE(circle.ok());
  CHECK(circle.error().text().find("back to it") != std::string::npos);
}
