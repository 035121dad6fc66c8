#pragma once
#include "engine/core/result.hpp"
#include "engine/scene/build.hpp"
#include "engine/scene/description/part.hpp"

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tumble {

/// The parts of a scene, without its bodies: what a person adds and changes while the world runs.
/// All that is not a part is left out.
SceneDescription parts_of(const SceneDescription& scene);
/// Nothing when there is none of this name in this list ("emitters").
std::optional<PartDescription> find_part(const SceneDescription& parts, std::string_view list,
                                         std::string_view name);
/// Adds it, or puts it in the place of the one of its name.
void put_part(SceneDescription& parts, const std::string& name, const PartDescription& part);
void drop_part(SceneDescription& parts, std::string_view list, const std::string& name);
/// `base` itself where nothing of this list has it, else "base_2", "base_3" ...
std::string new_part_name(const SceneDescription& parts, std::string_view list,
                          const std::string& base);

/// Makes parts in a live world from descriptions, with which a scene file would make the same. What
/// they name is found by its name in the world. Emitters and forces cannot be asked for there,
/// so that those made here, or by build_world(), are remembered: all that ever had a name, because
/// the world may go back to a moment at which an earlier one was alive.
class LiveParts {
 public:
  LiveParts() = default;
  /// Those that the scene has made.
  explicit LiveParts(const BuiltScene& built);

  /// "spring", "spring_2" ...: what no force of `parts` has, nor any that was ever made here.
  std::string new_force_name(const SceneDescription& parts, const std::string& base) const;
  /// A force that somebody else has made.
  void know(const std::string& name, ForceId id);
  /// `parts` are all of the scene as they are afterwards, `name` among them; `before`, where it is
  /// known, is what the world has of this name. A sensor that is changed begins anew, and so does a
  /// particle system whose particles begin elsewhere or are tied in another way; what names it
  /// follows. Everything else goes on. Error: the world refuses it, and is as before.
  Status set(World& world, const SceneDescription& parts, const std::string& name,
             const PartDescription& part, const PartDescription* before = nullptr);
  /// False when there is none.
  bool remove(World& world, const std::string& name, const PartDescription& part);

 private:
  Status set_emitter(World& world, const SceneDescription& parts, const std::string& name,
                     const EmitterDescription& d);
  Status set_sensor(World& world, const std::string& name, const SensorDescription& d);
  Status set_force(World& world, const std::string& name, const ForceDescription& d);
  Status set_particles(World& world, const SceneDescription& parts, const std::string& name,
                       const ParticleSystemDescription& d, const ParticleSystemDescription* before);
  Status follow_values(World& world, const SceneDescription& parts, const std::string& name);
  Status follow_particles(World& world, const SceneDescription& parts, const std::string& name);
  void untie(World& world, const SceneDescription& parts, ParticleSystemId id) const;
  /// Null ids: there is none now.
  EmitterId emitter(const World& world, const std::string& name) const;
  ForceId force(const World& world, const std::string& name) const;
  bool remove_particles(World& world, const std::string& name);

  std::shared_ptr<const SceneMeshes> meshes_;  ///< of the scene
  std::map<std::string, std::vector<EmitterId>, std::less<>> emitters_;
  std::map<std::string, std::vector<ForceId>, std::less<>> forces_;
};

}  // namespace tumble
