#pragma once
#include "engine/scene/build/scene_meshes.hpp"
#include "engine/scene/description.hpp"

#include <string>
#include <vector>

namespace tumble {

/// The definitions of one described body: one, or as many as it has copies ("name[0]", ...; those
/// that are not present are left out). Nothing, after a fault to `sink`, when it cannot be made.
std::vector<BodyDef> body_defs(const SceneDescription& scene, const std::string& name,
                               const BodyDescription& body, const SceneMeshes& meshes,
                               const FaultSink& sink, std::vector<std::string>& warnings);

}  // namespace tumble
