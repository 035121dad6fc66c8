#pragma once
#include "engine/scene/build.hpp"
#include "engine/scene/build/scene_meshes.hpp"

#include <map>
#include <string>
#include <vector>

namespace tumble {

/// The emitters of a scene in an order in which each comes after those that its events name; error,
/// naming an emitter, if events form a cycle.
Result<std::vector<std::string>> emitter_order(const SceneDescription& scene);

/// The definition of an emitter in a world whose bodies, particles and earlier emitters exist.
/// `body` is the body of which it emits copies, if it does. Errors: something that it names does
/// not exist.
Result<EmitterDef> emitter_def(const SceneDescription& scene, const std::string& name,
                               const EmitterDescription& emitter, const BuiltScene& built,
                               const SceneMeshes& meshes, std::shared_ptr<const BodyDef> body);

Result<SinkDef> sink_def(const std::string& name, const SinkDescription& sink,
                         const BuiltScene& built);

}  // namespace tumble
