#pragma once
#include "engine/scene/build/scene_meshes.hpp"
#include "engine/scene/description.hpp"

#include <string>
#include <vector>

namespace tumble {

/// The definitions of a described body: one, or one per copy ("name[0]", ...; copies that are not
/// present are left out). Empty, after a fault to `sink`, if it cannot be made.
std::vector<BodyDef> body_defs(const SceneDescription& scene, const std::string& name,
                               const BodyDescription& body, const SceneMeshes& meshes,
                               const FaultSink& sink, std::vector<std::string>& warnings);

}  // namespace tumble
