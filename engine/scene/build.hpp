#pragma once
#include "engine/core/result.hpp"
#include "engine/scene/description.hpp"
#include "engine/scene/fault.hpp"
#include "engine/world/microscope/microscope.hpp"
#include "engine/world/world_def.hpp"

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace tumble {

class ShapeStore;
class SceneMeshes;

/// A world made from a description, at tick 0 with all commands applied.
struct BuiltScene {
  std::unique_ptr<World> world;
  std::shared_ptr<const SceneDescription> description;  ///< cameras, lights, look
  std::map<std::string, BodyId, std::less<>> bodies;    ///< "ball", "brick[3]"
  std::map<std::string, JointId, std::less<>> joints;   ///< "hinge", "link[3]"
  std::map<std::string, ForceId, std::less<>> forces;
  std::map<std::string, ParticleSystemId, std::less<>> particles;
  std::map<std::string, EmitterId, std::less<>> emitters;
  std::map<std::string, SinkId, std::less<>> sinks;
  std::map<std::string, SensorId, std::less<>> sensors;  ///< "door", "bin[3]"
  std::shared_ptr<const SceneMeshes> meshes;
  std::optional<MicroscopeSetup> microscope;  ///< not refused at tick 0
  /// What was moved so that joints fit, a sentence for each body; where the scene asks for that.
  std::vector<std::string> assembly;
  /// Every approximation and anything that could not be done as asked.
  std::vector<std::string> warnings;
};

/// Makes the world of a description. `extras` provides threads and log; its settings are replaced
/// by the scene's. Shapes may be shared with other worlds. Errors: everything that validate()
/// finds, missing or unusable mesh files, bodies that the world refuses; all of them in `faults` if
/// given, and as lines of the error.
Result<BuiltScene> build_world(const SceneDescription& scene, WorldDef extras = {},
                               std::shared_ptr<ShapeStore> shapes = nullptr,
                               std::vector<Fault>* faults = nullptr);

}  // namespace tumble
