#pragma once
#include "engine/world/frame.hpp"
#include "viewer/render/render_scene.hpp"

#include <span>

namespace tumble {

/// A system of style `surface` as a liquid; `x` are the places of its particles at the moment
/// shown.
void add_liquid(const ParticleFrame& particles, std::span<const Vec3> x, RenderScene& out);
/// A system of style `smoke`.
void add_smoke(const ParticleFrame& particles, std::span<const Vec3> x, RenderScene& out);

}  // namespace tumble
