#include "engine/world/particle_frames.hpp"

#include "engine/dynamics/particles/fluid_def.hpp"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

/// What has been seen is noted by ticks; the present may not have been.
ValueRange colour_range(const ParticleLook& look, const ParticleSystem& p,
                        const std::vector<float>& values) {
  if (!look.finds_range()) return {look.low, look.high};
  ValueRange range = p.seen;
  for (const float value : values)
    if (std::isfinite(value)) range.include(double(value));
  return range;
}

/// What the drawing of a liquid surface needs besides.
void show_surface(const ParticleSystem& p, ParticleFrame& out) {
  out.v.clear();
  out.share.clear();
  if (out.look.style != ParticleStyle::surface || !p.fluid) return;
  out.v.reserve(p.x.capacity());
  out.share.reserve(p.x.capacity());
  for (const Vec3& v : p.v) out.v.push_back(v.cast<float>());
  for (const double density : p.density) out.share.push_back(float(density / p.fluid->density));
}

/// What the drawing of smoke needs besides.
void show_smoke(const ParticleSystem& p, const FindEmitter& emitter, ParticleFrame& out) {
  out.opacity.clear();
  out.age.clear();
  if (out.look.style != ParticleStyle::smoke) return;
  out.opacity.reserve(p.x.capacity());
  out.age.reserve(p.x.capacity());
  for (size_t i = 0; i < p.size(); ++i) {
    double opacity = out.look.opacity;
    const Emitter* e = emitter(p.emitter[i]);
    if (e && !e->def->opacity_over_life.empty())
      opacity *= over_life(e->def->opacity_over_life, std::clamp(p.age[i] / p.life[i], 0.0, 1.0));
    out.opacity.push_back(float(opacity));
    out.age.push_back(float(p.age[i]));
  }
}

}  // namespace

void show_particles_as(const ParticleLook& look, const ParticleSystem& p,
                       const FindEmitter& emitter, ParticleFrame& out) {
  out.look = look;
  quantity_values(p, look.colour_by, out.value);
  out.range = colour_range(look, p, out.value);
  show_surface(p, out);
  show_smoke(p, emitter, out);
}

void show_particles(const ParticleSystem& p, const FindEmitter& emitter, ParticleFrame& out) {
  out.name = p.name;
  out.x.reserve(p.x.capacity());
  out.radius.reserve(p.x.capacity());
  out.mass.reserve(p.x.capacity());
  out.colour.reserve(p.x.capacity());
  out.ids.reserve(p.x.capacity());
  out.x = p.x;
  out.radius = p.radius;
  out.mass = p.mass;
  out.colour = p.colour;
  out.box = p.box;
  out.ids = p.id;
  out.glow = p.glow;
  out.measures = measure_particles(p);
  show_particles_as(p.look, p, emitter, out);
}

}  // namespace tumble
