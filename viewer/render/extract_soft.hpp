#pragma once
#include "engine/world/frame.hpp"
#include "viewer/render/render_scene.hpp"

#include <span>

namespace tumble {

/// Adds a particle system of style `surface` as a liquid; `x` are the positions of its particles at
/// the moment shown [m].
void add_liquid(const ParticleFrame& particles, std::span<const Vec3> x, RenderScene& out);
/// Adds a particle system of style `smoke`.
void add_smoke(const ParticleFrame& particles, std::span<const Vec3> x, RenderScene& out);

}  // namespace tumble
