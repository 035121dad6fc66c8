#include "engine/dynamics/particles/particle_system.hpp"

#include "engine/core/chunks.hpp"
#include "engine/dynamics/particles/copy_particles.hpp"
#include "engine/dynamics/particles/fluid_def.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

namespace tumble {

namespace {

/// Calls f for every array of a system; with several systems, for the same array of each at once.
/// All have the arrays of the first.
template <class F, class System, class... More>
void for_arrays(const F& f, System& p, More&... more) {
  f(p.x, more.x...);
  f(p.v, more.v...);
  f(p.force, more.force...);
  f(p.mass, more.mass...);
  f(p.radius, more.radius...);
  f(p.colour, more.colour...);
  f(p.age, more.age...);
  f(p.life, more.life...);
  f(p.born_radius, more.born_radius...);
  f(p.born_mass, more.born_mass...);
  f(p.emitter, more.emitter...);
  f(p.id, more.id...);
  f(p.pressure, more.pressure...);
  if (p.fluid) f(p.density, more.density...);
  if (!p.grains) return;
  f(p.spin, more.spin...);
  f(p.rest, more.rest...);
}

}  // namespace

void ParticleSystem::add(const ParticleDef& def, EmitterId from, double years) {
  x.push_back(def.x);
  v.push_back(def.v);
  force.push_back(Vec3::Zero());
  mass.push_back(def.mass);
  radius.push_back(def.radius);
  colour.push_back(def.colour);
  age.push_back(years);
  life.push_back(def.life);
  born_radius.push_back(def.radius);
  born_mass.push_back(def.mass);
  emitter.push_back(from);
  id.push_back(next_id++);
  pressure.push_back(0);
  if (fluid) density.push_back(fluid->density);
  if (!grains) return;
  spin.push_back(def.spin);
  rest.emplace_back();
}

void ParticleSystem::reserve(size_t count) {
  for_arrays([count](auto& array) { array.reserve(count); }, *this);
}

void ParticleSystem::clear() {
  for_arrays([](auto& array) { array.clear(); }, *this);
}

void ParticleSystem::add_copy(const ParticleSystem& from, size_t i) {
  add({from.x[i], from.v[i], from.mass[i], from.radius[i], from.colour[i], from.life[i]},
      from.emitter[i], from.age[i]);
  force.back() = from.force[i];
  born_radius.back() = from.born_radius[i];
  born_mass.back() = from.born_mass[i];
  id.back() = from.id[i];
  pressure.back() = from.pressure[i];
  if (fluid && from.fluid) density.back() = from.density[i];
  if (!grains || !from.grains) return;
  spin.back() = from.spin[i];
  rest.back() = from.rest[i];
}

void ParticleSystem::remove(std::span<const uint8_t> gone) {
  const auto keep_others = [gone](auto& array) {
    size_t kept = 0;
    for (size_t i = 0; i < gone.size(); ++i)
      if (gone[i] == 0) {
        if (kept != i) array[kept] = array[i];
        ++kept;
      }
    array.resize(kept);
  };
  for_arrays(keep_others, *this);
}

void copy_particles(ParticleSystem& from, ParticleSystem& to, Crew* crew) {
  // Everything but the arrays is copied while these are elsewhere; the memory of `to` is kept.
  const auto exchange = [](auto& a, auto& b) { a.swap(b); };
  ParticleSystem arrays, memory;
  for_arrays(exchange, to, memory);
  for_arrays(exchange, from, arrays);
  to = from;
  for_arrays(exchange, from, arrays);
  const size_t room = from.x.capacity();
  const auto copy = [crew, room](const auto& source, auto& copied, auto& kept) {
    copied.swap(kept);
    if (copied.capacity() < room) copied.clear();
    copied.reserve(room);
    copied.resize(source.size());
    for_chunks(crew, source.size(), [&](size_t, size_t first, size_t last) {
      std::copy(source.begin() + ptrdiff_t(first), source.begin() + ptrdiff_t(last),
                copied.begin() + ptrdiff_t(first));
    });
  };
  for_arrays(copy, from, to, memory);
}

bool ParticleSystem::mortal() const {
  return std::ranges::any_of(life, [](double span) { return std::isfinite(span); });
}

void ParticleSystem::wake_grains() {
  for (GrainRest& r : rest)
    if (r.asleep()) r = {};
}

size_t ParticleSystem::find(uint64_t particle_id) const {
  if (id.empty() || particle_id < id.front()) return size();
  // Ids ascend, so the index is at most this; equal to it if none is gone.
  const uint64_t farthest = particle_id - id.front();
  if (farthest < id.size() && id[farthest] == particle_id) return size_t(farthest);
  const auto it = std::lower_bound(id.begin(), id.end(), particle_id);
  return it != id.end() && *it == particle_id ? size_t(it - id.begin()) : size();
}

void save(ByteWriter& out, const std::optional<GrainDef>& grains) {
  out.value(uint8_t(grains.has_value()));
  if (!grains) return;
  out.value(grains->rolling_friction);
  out.value(grains->torsional_friction);
  out.value(int32_t(grains->substeps));
}

std::optional<GrainDef> load_grains(ByteReader& in) {
  if (in.get<uint8_t>() == 0) return std::nullopt;
  GrainDef def;
  in.value(def.rolling_friction);
  in.value(def.torsional_friction);
  def.substeps = in.get<int32_t>();
  if (def.substeps < 0 || def.substeps > most_grain_substeps) in.fail();
  return def;
}

void ParticleSystem::save(ByteWriter& out) const {
  out.text(name);
  out.value(gravity_scale);
  out.value(friction);
  out.value(restitution);
  for (const bool flag : {collide, fast, detect, fluid != nullptr}) out.value(uint8_t(flag));
  out.value(charge);
  out.value(box.low);
  out.value(box.size);
  out.value(glow);
  tumble::save(out, grains);
  tumble::save(out, look);
  out.value(seen.low);
  out.value(seen.high);
  out.value(next_id);
  const auto vectors = [&out](const std::vector<Vec3>& a) {
    out.value(uint64_t(a.size()));
    out.raw(a.data(), a.size() * sizeof(Vec3));
  };
  vectors(x);
  vectors(v);
  vectors(force);
  out.vector(mass);
  out.vector(radius);
  out.value(uint64_t(colour.size()));
  out.raw(colour.data(), colour.size() * sizeof(Vec3f));
  out.vector(age);
  out.vector(life);
  out.vector(born_radius);
  out.vector(born_mass);
  out.vector(emitter);
  out.vector(id);
  if (fluid) {
    tumble::save(out, *fluid);
    out.vector(pressure);
    out.vector(density);
  }
  if (!grains) return;
  vectors(spin);
  out.value(uint64_t(rest.size()));
  out.raw(rest.data(), rest.size() * sizeof(GrainRest));
}

void ParticleSystem::load(ByteReader& in) {
  in.text(name);
  in.value(gravity_scale);
  in.value(friction);
  in.value(restitution);
  bool flows = false;
  for (bool* flag : {&collide, &fast, &detect, &flows}) *flag = in.get<uint8_t>() != 0;
  in.value(charge);
  in.value(box.low);
  in.value(box.size);
  in.value(glow);
  grains = load_grains(in);
  look = load_particle_look(in);
  in.value(seen.low);
  in.value(seen.high);
  in.value(next_id);
  const auto vectors = [&in](auto& a) {
    const auto n = in.get<uint64_t>();
    if (n > in.remaining() / sizeof(a[0])) {
      in.fail();
      return;
    }
    a.resize(size_t(n));
    in.raw(a.data(), a.size() * sizeof(a[0]));
  };
  vectors(x);
  vectors(v);
  vectors(force);
  in.vector(mass);
  in.vector(radius);
  vectors(colour);
  in.vector(age);
  in.vector(life);
  in.vector(born_radius);
  in.vector(born_mass);
  in.vector(emitter);
  in.vector(id);
  fluid = flows ? load_fluid(in) : nullptr;
  if (fluid) {
    in.vector(pressure);
    in.vector(density);
  } else {
    pressure.assign(id.size(), 0);
  }
  if (grains) {
    vectors(spin);
    vectors(rest);
  }
  const auto check_size = [&](const auto& array) {
    if (array.size() != x.size()) in.fail();
  };
  for_arrays(check_size, *this);
}

void save(ByteWriter& out, const FluidDef& d) {
  out.value(uint8_t(d.solver));
  out.value(uint8_t(d.kernel));
  for (const double x : {d.density, d.smoothing, d.viscosity, d.xsph, d.surface_tension, d.adhesion,
                         d.wall_friction, d.density_error, d.sound_speed, d.cfl})
    out.value(x);
  out.value(int32_t(d.most_iterations));
}

std::shared_ptr<const FluidDef> load_fluid(ByteReader& in) {
  auto d = std::make_shared<FluidDef>();
  d->solver = FluidSolverKind(in.get<uint8_t>());
  d->kernel = FluidKernelKind(in.get<uint8_t>());
  for (double* x : {&d->density, &d->smoothing, &d->viscosity, &d->xsph, &d->surface_tension,
                    &d->adhesion, &d->wall_friction, &d->density_error, &d->sound_speed, &d->cfl})
    in.value(*x);
  d->most_iterations = in.get<int32_t>();
  if (d->solver > FluidSolverKind::wcsph || d->kernel > FluidKernelKind::wendland || !validate(*d))
    in.fail();
  return d;
}

void save(ByteWriter& out, std::span<const ParticleName> names) {
  out.value(uint64_t(names.size()));
  for (const ParticleName& p : names) {
    out.value(p.system);
    out.value(p.particle);
  }
}

std::vector<ParticleName> load_particle_names(ByteReader& in) {
  std::vector<ParticleName> names;
  const auto count = in.get<uint64_t>();
  for (uint64_t k = 0; k < count && in.ok(); ++k) {
    ParticleName& p = names.emplace_back();
    in.value(p.system);
    in.value(p.particle);
  }
  return names;
}

namespace {

Status validate_fluid(const ParticleSystemDef& def) {
  const auto fault = [&def](std::string message, std::string cure) {
    return Error{ErrorCode::invalid_argument, std::move(message), def.name, std::move(cure)};
  };
  if (const Status valid = validate(*def.fluid); !valid) return valid;
  if (def.collide)
    return fault("particles of a fluid do not collide as balls: its pressure keeps them apart",
                 "set collide to false");
  if (def.fast)
    return fault("a fluid is moved by its solver, not as fast particles", "set fast to false");
  if (def.box.any())
    return fault("a fluid cannot have a periodic box", "leave out periodic_box, or fluid");
  return {};
}

Status validate_grains(const ParticleSystemDef& def) {
  if (!def.grains) return {};
  const auto fault = [&def](std::string message, std::string cure) {
    return Error{ErrorCode::invalid_argument, std::move(message), def.name, std::move(cure)};
  };
  for (const auto& [name, value] : {std::pair{"rolling_friction", def.grains->rolling_friction},
                                    {"torsional_friction", def.grains->torsional_friction}})
    if (!(value >= 0 && std::isfinite(value)))
      return fault(fmt::format("{} of grains must be >= 0, got {}", name, value), {});
  if (const int n = def.grains->substeps; n < 0 || n > most_grain_substeps)
    return fault(fmt::format("substeps of grains must be 0 to {}, got {}", most_grain_substeps, n),
                 {});
  if (!def.collide) return fault("grains collide", "leave out \"collide\": false, or \"grains\"");
  if (def.fast) return fault("grains cannot be fast", "leave out \"fast\", or \"grains\"");
  if (def.box.any())
    return fault("grains have no periodic box", "leave out \"periodic_box\", or \"grains\"");
  return {};
}

}  // namespace

Status validate(const ParticleSystemDef& def) {
  for (size_t i = 0; i < def.particles.size(); ++i) {
    const ParticleDef& p = def.particles[i];
    const auto fault = [&](std::string message) {
      return Error{ErrorCode::invalid_argument,
                   std::move(message),
                   fmt::format("particle system '{}', particle {}", def.name, i),
                   {}};
    };
    if (!p.x.allFinite()) return fault("position is not finite");
    if (!p.v.allFinite()) return fault("velocity is not finite");
    if (!p.spin.allFinite()) return fault("spin is not finite");
    if (!(p.mass > 0) || !std::isfinite(p.mass))
      return fault(fmt::format("mass must be > 0, got {} kg", p.mass));
    if (!(p.radius > 0) || !std::isfinite(p.radius))
      return fault(fmt::format("radius must be > 0, got {} m", p.radius));
    if (!(p.life > 0)) return fault(fmt::format("life must be > 0, got {} s", p.life));
  }
  if (!std::isfinite(def.gravity_scale))
    return Error{ErrorCode::invalid_argument, "gravity_scale is not finite", def.name, {}};
  if (!(def.friction >= 0 && std::isfinite(def.friction)))
    return Error{ErrorCode::invalid_argument,
                 fmt::format("friction must be >= 0, got {}", def.friction),
                 def.name,
                 {}};
  if (!(def.glow >= 0 && std::isfinite(def.glow)))
    return Error{ErrorCode::invalid_argument,
                 fmt::format("glow must be >= 0, got {}", def.glow),
                 def.name,
                 {}};
  if (!(def.restitution >= 0 && def.restitution <= 1))
    return Error{ErrorCode::invalid_argument,
                 fmt::format("restitution must be in 0..1, got {}", def.restitution),
                 def.name,
                 {}};
  if (!std::isfinite(def.charge))
    return Error{ErrorCode::invalid_argument, "charge is not finite", def.name, {}};
  if (def.fluid && def.grains)
    return Error{ErrorCode::invalid_argument, "a system is a fluid or grains, not both", def.name,
                 "leave out fluid, or grains"};
  if (Status status = validate_grains(def); !status) return status;
  if (Status status = validate(def.look, def.fluid != nullptr); !status) {
    Error error = status.error();
    error.place = def.name;
    return error;
  }
  if (!def.box.low.allFinite() || !def.box.size.allFinite() || def.box.size.minCoeff() < 0)
    return Error{
        ErrorCode::invalid_argument, "the periodic box must have finite edges >= 0", def.name, {}};
  return def.fluid ? validate_fluid(def) : Status();
}

void take_values(ParticleSystem& out, const ParticleSystemDef& def) {
  out.name = def.name;
  out.gravity_scale = def.gravity_scale;
  out.friction = def.friction;
  out.restitution = def.restitution;
  out.collide = def.collide;
  out.fast = def.fast;
  out.detect = def.detect;
  out.charge = def.charge;
  out.box = def.box;
  out.glow = def.glow;
  out.fluid = def.fluid;
  out.grains = def.grains;
  if (out.look.colour_by != def.look.colour_by) out.seen = {};
  out.look = def.look;
  out.density.resize(out.fluid ? out.size() : 0, out.fluid ? out.fluid->density : 0);
  out.spin.resize(out.grains ? out.size() : 0, Vec3::Zero());
  out.rest.resize(out.grains ? out.size() : 0);
  // Snapshots keep pressure of fluids only.
  if (!out.fluid) std::ranges::fill(out.pressure, 0);
  for (size_t i = 0; i < out.size() && out.id[i] <= def.particles.size(); ++i) {
    if (!out.emitter[i].is_null()) continue;
    const ParticleDef& p = def.particles[out.id[i] - 1];
    out.mass[i] = out.born_mass[i] = p.mass;
    out.radius[i] = out.born_radius[i] = p.radius;
    out.colour[i] = p.colour;
    out.life[i] = p.life;
  }
}

ParticleSystem make_particle_system(const ParticleSystemDef& def) {
  ParticleSystem out;
  take_values(out, def);
  for (const ParticleDef& p : def.particles) out.add(p);
  note_quantity(out);
  return out;
}

void integrate(ParticleSystem& particles, const Vec3& gravity, double h) {
  const Vec3 g = particles.gravity_scale * gravity;
  for (size_t i = 0; i < particles.size(); ++i) {
    const Vec3 a = g + particles.force[i] / particles.mass[i];
    particles.x[i] += h * particles.v[i] + (0.5 * h * h) * a;
    particles.v[i] += h * a;
    particles.age[i] += h;
    particles.force[i].setZero();
  }
}

}  // namespace tumble
