#include "engine/scene/description.hpp"

namespace tumble {

SceneDescription::SceneDescription() = default;
SceneDescription::~SceneDescription() = default;
SceneDescription::SceneDescription(const SceneDescription& other) = default;
SceneDescription::SceneDescription(SceneDescription&& other) noexcept = default;
SceneDescription& SceneDescription::operator=(const SceneDescription& other) = default;
SceneDescription& SceneDescription::operator=(SceneDescription&& other) noexcept = default;

}  // namespace tumble
