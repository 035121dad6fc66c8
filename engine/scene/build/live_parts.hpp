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

/// The parts of a scene, without its bodies and anything else: what a user can add and change while
/// the world runs.
SceneDescription parts_of(const SceneDescription& scene);
/// Empty if this list ("emitters") has no part of this name.
std::optional<PartDescription> find_part(const SceneDescription& parts, std::string_view list,
                                         std::string_view name);
/// Adds a part, or replaces the one of the same name.
void put_part(SceneDescription& parts, const std::string& name, const PartDescription& part);
void drop_part(SceneDescription& parts, std::string_view list, const std::string& name);
/// `base` itself if no part of this list has that name, else "base_2", "base_3" ...
std::string new_part_name(const SceneDescription& parts, std::string_view list,
                          const std::string& base);

/// Creates parts in a live world from descriptions, as a scene file would. What they name is found
/// by name in the world. Emitters and forces have no names there, so those created here, or by
/// build_world(), are remembered: all that ever had a name, since the world may go back to a moment
/// at which an earlier one was alive.
class LiveParts {
 public:
  LiveParts() = default;
  /// Starts with the parts that the scene has created.
  explicit LiveParts(const BuiltScene& built);

  /// "spring", "spring_2" ...: a name that no force of `parts` has, nor any that was ever created
  /// here.
  std::string new_force_name(const SceneDescription& parts, const std::string& base) const;
  /// Remembers a force that was created elsewhere.
  void know(const std::string& name, ForceId id);
  /// Creates or replaces a part. `parts` are all parts of the scene afterwards, including `name`;
  /// `before`, if known, is the present part of this name. A changed sensor begins anew, and so
  /// does a particle system whose particles start elsewhere or are connected differently;
  /// references to it are updated. Everything else continues. Error: the world refuses it, and is
  /// unchanged.
  Status set(World& world, const SceneDescription& parts, const std::string& name,
             const PartDescription& part, const PartDescription* before = nullptr);
  /// False if there is no such part.
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
  /// Null id if there is none now.
  EmitterId emitter(const World& world, const std::string& name) const;
  ForceId force(const World& world, const std::string& name) const;
  bool remove_particles(World& world, const std::string& name);

  std::shared_ptr<const SceneMeshes> meshes_;  ///< of the scene
  std::map<std::string, std::vector<EmitterId>, std::less<>> emitters_;
  std::map<std::string, std::vector<ForceId>, std::less<>> forces_;
};

}  // namespace tumble
