#pragma once
#include "engine/scene/description/assertion.hpp"
#include "engine/scene/description/body.hpp"
#include "engine/scene/description/emitter.hpp"
#include "engine/scene/description/force.hpp"
#include "engine/scene/description/joint.hpp"
#include "engine/scene/description/lesson.hpp"
#include "engine/scene/description/microscope.hpp"
#include "engine/scene/description/parameter.hpp"
#include "engine/scene/description/particles.hpp"
#include "engine/scene/description/robot.hpp"
#include "engine/scene/description/sensor.hpp"
#include "engine/scene/description/viewing.hpp"
#include "engine/world/settings.hpp"

#include <filesystem>
#include <memory>

namespace tumble {

struct JsonNode;

/// Source of a description; provides lines for faults, and the folder of assets.
struct SceneSource {
  std::string file;                      ///< as the caller named it
  std::filesystem::path folder;          ///< of the file
  std::shared_ptr<const JsonNode> tree;  ///< the file with overrides applied
};

/// The content of a scene file. Its keys, units, ranges and docs are declared once, in
/// parameters(), which the reader, the writer, the schema and the tables of documentation use.
struct SceneDescription {
  static constexpr int version = 1;
  int tumble_scene = version;
  std::string title;
  std::string description;
  std::string category;
  uint64_t seed = 1;
  NamedList<ParameterDescription> parameters_;
  WorldSettings settings;
  bool assemble = false;
  NamedList<MaterialDescription> materials;
  NamedList<MeshDescription> meshes;
  NamedList<BodyDescription> bodies;
  NamedList<JointDescription> joints;
  /// Empty in the result of read_scene(), in which robots are replaced by their bodies and joints.
  NamedList<RobotDescription> robots;
  NamedList<ForceDescription> forces;
  NamedList<ParticleSystemDescription> particles;
  NamedList<EmitterDescription> emitters;
  NamedList<SinkDescription> sinks;
  NamedList<SensorDescription> sensors;
  std::vector<AssertionDescription> assertions;
  NamedList<CameraDescription> cameras;
  LightsDescription lights;
  ViewDescription look;
  std::optional<MicroscopeDescription> microscope;
  std::optional<LessonDescription> lesson;

  std::shared_ptr<const SceneSource> source;  ///< null for scenes made by code
  std::vector<std::string> warnings;          ///< what the reader could not do as asked

  // Compiled once, in description.cpp: a hundred structs are copied and destroyed with a scene.
  SceneDescription();
  ~SceneDescription();
  SceneDescription(const SceneDescription& other);
  SceneDescription(SceneDescription&& other) noexcept;
  SceneDescription& operator=(const SceneDescription& other);
  SceneDescription& operator=(SceneDescription&& other) noexcept;

  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.field(d.tumble_scene, {.name = "tumble_scene",
                             .min = version,
                             .max = version,
                             .required = true,
                             .doc = "version of the format: 1"});
    v.field(d.title, {.name = "title", .doc = "name for people"});
    v.field(d.description, {.name = "description", .doc = "one line: what one sees"});
    v.field(d.category, {.name = "category", .doc = "under which lists show it"});
    // Before everything that may use them.
    v.map(d.parameters_, {.name = "parameters", .doc = "numbers for use in values and --set"});
    v.field(d.seed, {.name = "seed", .doc = "of everything random"});
    v.object(d.settings, {.name = "settings", .doc = "tick, gravity and algorithms"});
    v.field(d.assemble, {.name = "assemble",
                         .doc = "before the start bodies are moved, and their velocities changed, "
                                "as little as joints, their limits and couplings need"});
    v.map(d.materials, {.name = "materials", .doc = "surfaces and densities"});
    v.map(d.meshes, {.name = "meshes", .doc = "mesh files"});
    v.map(d.bodies, {.name = "bodies", .doc = "rigid bodies"});
    v.map(d.joints, {.name = "joints", .doc = "what holds bodies to each other"});
    v.map(d.robots, {.name = "robots", .doc = "bodies and joints from robot files"});
    v.map(d.forces, {.name = "forces", .doc = "drag, springs"});
    v.map(d.particles, {.name = "particles", .doc = "particle systems"});
    v.map(d.emitters, {.name = "emitters", .doc = "where particles and bodies come from"});
    v.map(d.sinks, {.name = "sinks", .doc = "where they go"});
    v.map(d.sensors, {.name = "sensors", .doc = "what is measured while the scene runs"});
    v.list(d.assertions, {.name = "assertions", .doc = "what holds of the scene while it runs"});
    v.map(d.cameras, {.name = "cameras", .doc = "views; the first is the one to start with"});
    v.object(d.lights, {.name = "lights", .doc = "sun and sky light"});
    v.object(d.look, {.name = "look", .doc = "sky, ground, fog, exposure"});
    v.object(d.microscope, {.name = "microscope", .doc = "an algorithm to watch at work"});
    v.object(d.lesson, {.name = "lesson", .doc = "what is taught beside the picture"});
  }
};

}  // namespace tumble
