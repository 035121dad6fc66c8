#include "engine/core/random.hpp"
#include "engine/math/det/det.hpp"
#include "engine/math/rotation.hpp"
#include "engine/scene/build/force_defs.hpp"
#include "engine/scene/repetition.hpp"

#include <cmath>

#include <fmt/format.h>

namespace tumble {
namespace {

/// Adds the particles of fills to a definition.
struct Filler {
  ParticleDef common;
  uint64_t seed;
  double budget;  ///< most particles that the system may have
  ParticleSystemDef& out;

  void add(const Vec3& x, const Vec3& extra_velocity = Vec3::Zero()) {
    ParticleDef p = common;
    p.x = x;
    p.v += extra_velocity;
    out.particles.push_back(p);
  }

  /// Rejects a number beyond the limit before any memory is allocated for it.
  Status room_for(double count) const {
    if (double(out.particles.size()) + count <= budget) return {};
    return Error{ErrorCode::invalid_argument,
                 fmt::format("this fill makes {:.6g} particles; a scene may have {:.0f} in all",
                             count, max_particles),
                 {},
                 {}};
  }

  /// A cubic lattice, or every fourth (body-centred) or second (face-centred) point of a finer one.
  Status operator()(const LatticeFill& f) {
    const bool body = f.arrangement == Arrangement::body_centred;
    const bool face = f.arrangement == Arrangement::face_centred;
    const double step = body   ? f.spacing / std::sqrt(3)
                        : face ? f.spacing / std::sqrt(2)
                               : f.spacing;
    double n[3];
    for (int k = 0; k < 3; ++k) n[k] = std::floor(f.size[k] / step * (1 + 1e-12)) + 1;
    if (auto ok = room_for(n[0] * n[1] * n[2] / (body ? 4 : face ? 2 : 1)); !ok) return ok;
    if (out.fluid) {
      common.mass = out.fluid->density * step * step * step * (body ? 4 : face ? 2 : 1);
      common.radius = 0.5 * f.spacing;
    }
    const Vec3 first = -0.5 * step * (Vec3(n[0], n[1], n[2]) - Vec3::Ones());
    Random random(f.seed.value_or(seed));
    for (int y = 0; y < int(n[1]); ++y)
      for (int z = 0; z < int(n[2]); ++z)
        for (int x = 0; x < int(n[0]); ++x) {
          if (body && (x % 2 != y % 2 || y % 2 != z % 2)) continue;
          if (face && (x + y + z) % 2 != 0) continue;
          const Vec3 p = first + step * Vec3(x, y, z);
          const bool inside = in_region(p.cwiseQuotient(f.size), f.region, 1e-12);
          if (!inside) continue;
          add(f.centre + p, f.speed > 0 ? Vec3(f.speed * random_point(random, ScatterRegion::ball,
                                                                      Vec3::Constant(2)))
                                        : Vec3::Zero());
        }
    return {};
  }
  Status operator()(const RandomFill& f) {
    if (auto ok = room_for(f.count); !ok) return ok;
    Random random(f.seed.value_or(seed));
    for (int i = 0; i < f.count; ++i) {
      const Vec3 x = f.centre + random_point(random, f.region, f.size);
      add(x, f.speed * random_point(random, ScatterRegion::ball, Vec3::Constant(2)));
    }
    return {};
  }
  Status operator()(const DiscFill& f) {
    if (auto ok = room_for(f.count); !ok) return ok;
    Random random(f.seed.value_or(seed));
    Vec3 t1, t2;
    const Vec3 axis = f.axis.normalized();
    tangent_frame(axis, t1, t2);
    for (int i = 0; i < f.count; ++i) {
      // Uniform over the area of the ring.
      const double r = std::sqrt(random.uniform(f.inner * f.inner, f.outer * f.outer));
      const double angle = random.uniform(0, 2 * det::pi);
      const Vec3 out = det::cos(angle) * t1 + det::sin(angle) * t2;
      const double d = std::sqrt(r * r + f.softening * f.softening);
      const double speed = r * std::sqrt(f.mu / (d * d * d));
      add(f.centre + r * out + f.thickness * (random.uniform() - 0.5) * axis,
          speed * axis.cross(out));
    }
    return {};
  }
};

}  // namespace

namespace {

ParticleLook particle_look(const ParticleLookDescription& d) {
  ParticleLook look;
  look.style = d.style;
  look.colour_by = d.colour_by;
  look.clarity = d.clarity;
  look.foam = d.foam;
  look.opacity = d.opacity;
  look.trail = d.trail;
  if (d.range.size() == 2) {
    look.low = d.range[0];
    look.high = d.range[1];
  }
  return look;
}

}  // namespace

Result<ParticleSystemDef> particle_def(const SceneDescription& scene, const std::string& name,
                                       const ParticleSystemDescription& d, double budget) {
  ParticleSystemDef out;
  out.name = name;
  out.gravity_scale = d.gravity_scale;
  out.friction = d.friction;
  out.restitution = d.restitution;
  out.collide = d.collide;
  out.fast = d.fast;
  out.detect = d.detect;
  out.charge = d.charge;
  if (d.periodic_box) {
    out.box.size = d.periodic_box->size;
    out.box.low = d.periodic_box->centre - 0.5 * out.box.size;
  }
  out.glow = d.glow;
  out.look = particle_look(d.look);
  if (d.fluid) {
    out.fluid = std::make_shared<const FluidDef>(d.fluid->def);
    out.collide = false;
  }
  if (d.grains)
    out.grains =
        GrainDef{d.grains->rolling_friction, d.grains->torsional_friction, d.grains->substeps};
  ParticleDef common;
  common.v = d.velocity;
  common.mass = d.mass;
  common.radius = d.radius;
  common.colour = d.colour.linear();
  if (d.life) common.life = *d.life;
  for (const ParticleDescription& p : d.list) {
    ParticleDef particle = common;
    particle.x = p.position;
    if (p.velocity) particle.v = *p.velocity;
    if (p.mass) particle.mass = *p.mass;
    if (p.radius) particle.radius = *p.radius;
    if (p.colour) particle.colour = p.colour->linear();
    out.particles.push_back(particle);
  }
  for (size_t i = 0; i < d.fill.size(); ++i) {
    Filler filler{common, named_seed(scene.seed, name) + i, budget, out};
    auto ok = std::visit([&](const auto& kind) { return filler(kind); }, d.fill[i].kind);
    if (!ok)
      return Error{ErrorCode::invalid_argument,
                   ok.error().message,
                   fmt::format("particles.{}.fill[{}]", name, i),
                   {}};
  }
  return out;
}

}  // namespace tumble
