#include "viewer/render/extract_vectors.hpp"

#include "engine/math/rotation.hpp"
#include "viewer/render/builtin_meshes.hpp"
#include "viewer/render/overlay_colours.hpp"
#include "viewer/render/scene_scales.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace tumble {
namespace {

/// Length of the arrow for the weight of a typical body, in body sizes [-].
constexpr double weight_length = 1.5;
constexpr double usual_gravity = 9.81;  ///< used where there is no gravity [m/s2]
/// Arrows of momentum and force are cut at this length, in body sizes, and then end in a dot
/// instead of a head.
constexpr double longest_vector = 12;
/// Up to this many bodies, arrows are drawn over everything; more would be too dense.
constexpr size_t few_bodies = 50;
/// Greatest number of arrows of particles; more would show no directions.
constexpr size_t most_arrows = 1000;

/// 1, 2 or 5 times a power of ten, not less than `value`.
double round_up(double value) {
  if (!(value > 0) || !std::isfinite(value)) return 1;
  const double decade = std::pow(10.0, std::floor(std::log10(value)));
  const double share = value / decade * (1 - 1e-9);
  return decade * (share <= 1 ? 1 : share <= 2 ? 2 : share <= 5 ? 5 : 10);
}

double typical_mass(const Frame& frame) {
  std::vector<double> masses;
  for (size_t slot = 0; slot < frame.body_slots(); ++slot)
    if (!frame.body(slot).id.is_null() && frame.info(slot).type == BodyType::dynamic)
      masses.push_back(frame.info(slot).mass);
  if (masses.empty()) return 1;
  const auto middle = masses.begin() + std::ptrdiff_t((masses.size() - 1) / 2);
  std::nth_element(masses.begin(), middle, masses.end());
  return *middle;
}

std::string scale_words(double one_metre, const char* unit) {
  // Three figures, never as a power of ten.
  return one_metre < 1000 ? fmt::format("1 m is {:.3g} {}", one_metre, unit)
                          : fmt::format("1 m is {:.0f} {}", one_metre, unit);
}

/// Adds an arrow with a head, shortened to the greatest length.
void add_vector(RenderScene& out, const Vec3& from, const Vec3& along, double size,
                const Vec4f& colour, Occlusion within) {
  const double length = along.norm(), most = longest_vector * size;
  if (!(length > most)) return add_thin_arrow(out, from, along, size, colour, within);
  const Vec3 end = from + most / length * along;
  if (!end.allFinite()) return;
  out.lines.push_back({.a = from.cast<float>(),
                       .b = end.cast<float>(),
                       .colour = colour,
                       .width = 2.5f,
                       .occlusion = within});
  out.points.push_back({.x = end.cast<float>(), .colour = colour, .size = 9, .occlusion = within});
}

/// A small sideways offset, so that the arrow of a momentum does not lie on that of the velocity.
Vec3 aside(const Vec3& along, double distance) {
  if (!(along.norm() > 0)) return Vec3::Zero();
  Vec3 u, v;
  tangent_frame(along.normalized(), u, v);
  return distance * u;
}

/// Arrows are drawn for every n-th particle by id; 1: for all.
size_t arrow_stride(const Frame& frame) {
  size_t all = 0;
  for (const auto& system : frame.particles) all += system->x.size();
  return std::max<size_t>((all + most_arrows - 1) / most_arrows, 1);
}

/// Calls visit(particle, v) for those particles of a system that have arrows, where v is the
/// displacement in the last tick over its length [m/s]. Both lists must ascend by id.
template <class Visit>
void each_moved(const ParticleFrame& before, const ParticleFrame& now, double tick, size_t stride,
                const Visit& visit) {
  size_t k = 0;
  for (size_t i = 0; i < now.x.size(); ++i) {
    while (k < before.ids.size() && before.ids[k] < now.ids[i]) ++k;
    if (k >= before.ids.size()) return;
    if (before.ids[k] != now.ids[i] || now.ids[i] % stride != 0) continue;
    const Vec3 v = now.box.shortest(now.x[i] - before.x[k]) / tick;
    if (v.allFinite()) visit(i, v);
  }
}

void add_particle_vectors(const Frame& before, const Frame& frame, const Overlays& overlays,
                          const VectorScales& scales, double size, RenderScene& out) {
  const size_t stride = arrow_stride(frame);
  for (const auto& now : frame.particles)
    for (const auto& then : before.particles) {
      if (then->id != now->id || now->ids.size() != now->x.size()) continue;
      const bool weighed = overlays.momenta && now->mass.size() == now->x.size();
      each_moved(*then, *now, frame.rate.tick(), stride, [&](size_t i, const Vec3& v) {
        const Vec3& x = now->x[i];
        if (overlays.velocities)
          add_thin_arrow(out, x, v / scales.velocity, size, overlay_colour::velocity);
        if (!weighed) return;
        const Vec3 along = now->mass[i] / scales.particle_momentum * v;
        add_vector(out, x + aside(along, 0.03 * size), along, size, overlay_colour::momentum,
                   Occlusion::faint);
      });
    }
}

/// "; 950 of 12,000 are drawn", or nothing where all are.
std::string left_out_words(const Frame& frame) {
  const size_t stride = arrow_stride(frame);
  if (stride == 1) return {};
  size_t all = 0, drawn = 0;
  for (const auto& system : frame.particles) {
    all += system->x.size();
    for (const uint64_t id : system->ids) drawn += id % stride == 0;
  }
  return fmt::format("; {} of {} are drawn", drawn, all);
}

/// Median mass of a sample of particles [kg].
double typical_particle_mass(const Frame& frame) {
  constexpr size_t looked_at = 1000;
  std::vector<double> masses;
  for (const auto& system : frame.particles) {
    const size_t step = system->mass.size() / looked_at + 1;
    for (size_t i = 0; i < system->mass.size(); i += step) masses.push_back(system->mass[i]);
  }
  if (masses.empty()) return 1;
  const auto middle = masses.begin() + std::ptrdiff_t((masses.size() - 1) / 2);
  std::nth_element(masses.begin(), middle, masses.end());
  return *middle;
}

}  // namespace

void add_thin_arrow(RenderScene& out, const Vec3& from, Vec3 along, double size,
                    const Vec4f& colour, Occlusion within) {
  constexpr double longest = 200;  // in body sizes: longer than any picture that shows the body
  if (along.norm() > longest * size) along *= longest * size / along.norm();
  const double length = along.norm();
  if (!along.allFinite() || !(length > 0.03 * size)) return;
  const double radius = std::min(0.012 * size, 0.1 * length);
  Paint paint;
  paint.colour = colour.head<3>();
  paint.emission = 0.4f;
  const size_t first = out.instances.size();
  add_arrow(out, from, from + along, radius, paint);
  for (size_t i = first; i < out.instances.size(); ++i) out.instances[i].casts_shadow = false;
  const Vec3 tip = from + along;
  out.lines.push_back({.a = from.cast<float>(),
                       .b = tip.cast<float>(),
                       .colour = colour,
                       .width = 2,
                       .occlusion = within});
  if (within == Occlusion::none)
    out.points.push_back(
        {.x = tip.cast<float>(), .colour = colour, .size = 4, .occlusion = within});
}

VectorScales vector_scales(const Frame& frame, const Overlays& overlays) {
  const double longer = overlays.vector_length > 0 ? overlays.vector_length : 1;
  const double mass = typical_mass(frame), size = std::max(typical_size(frame), 1e-6);
  const double gravity = frame.usual_gravity > 0 ? frame.usual_gravity : usual_gravity;
  VectorScales out;
  out.momentum = round_up(out.velocity * mass) / longer;
  if (!frame.particles.empty())
    out.particle_momentum = round_up(out.velocity * typical_particle_mass(frame));
  out.particle_momentum /= longer;
  out.force = round_up(mass * gravity / (weight_length * size)) / longer;
  out.velocity /= longer;
  return out;
}

std::string velocity_scale(const Frame& frame, const Overlays& overlays) {
  return scale_words(vector_scales(frame, overlays).velocity, "m/s");
}
std::string momentum_scale(const Frame& frame, const Overlays& overlays) {
  return scale_words(vector_scales(frame, overlays).momentum, "kg m/s");
}
std::string force_scale_words(const Frame& frame, const Overlays& overlays) {
  return scale_words(vector_scales(frame, overlays).force, "N");
}

std::string particle_velocity_scale(const Frame& frame, const Overlays& overlays) {
  return velocity_scale(frame, overlays) + left_out_words(frame);
}
std::string particle_momentum_scale(const Frame& frame, const Overlays& overlays) {
  return scale_words(vector_scales(frame, overlays).particle_momentum, "kg m/s") +
         left_out_words(frame);
}

std::optional<Vec3> mean_total_force(const Frame& before, const Frame& now, size_t slot) {
  if (before.tick + 1 != now.tick || slot >= before.body_slots()) return std::nullopt;
  const BodyFrame &a = before.body(slot), &b = now.body(slot);
  if (b.id.is_null() || a.id != b.id || b.jumped || now.info(slot).type != BodyType::dynamic)
    return std::nullopt;
  return now.info(slot).mass / now.rate.tick() * (b.v - a.v);
}

void add_vectors(const Frame& frame, const Frame* before, const std::vector<Pose>& poses,
                 const Overlays& overlays, RenderScene& out) {
  if (!overlays.velocities && !overlays.momenta && !overlays.total_forces) return;
  const VectorScales scales = vector_scales(frame, overlays);
  const double size = typical_size(frame);
  const Occlusion within = frame.stats.bodies <= few_bodies ? Occlusion::none : Occlusion::faint;
  for (size_t slot = 0; slot < poses.size(); ++slot) {
    const BodyFrame& body = frame.body(slot);
    if (body.id.is_null()) continue;
    const Vec3& x = poses[slot].x;
    if (overlays.velocities)
      add_thin_arrow(out, x, body.v / scales.velocity, size, overlay_colour::velocity);
    if (frame.info(slot).type != BodyType::dynamic) continue;
    if (overlays.momenta) {
      const Vec3 along = frame.info(slot).mass / scales.momentum * body.v;
      add_vector(out, x + aside(along, 0.06 * size), along, size, overlay_colour::momentum, within);
    }
    if (!overlays.total_forces || !before) continue;
    if (const auto force = mean_total_force(*before, frame, slot))
      add_vector(out, x, *force / scales.force, size, overlay_colour::total_force, within);
  }
  if (!overlays.velocities && !overlays.momenta) return;
  if (before && before->tick + 1 == frame.tick)
    add_particle_vectors(*before, frame, overlays, scales, size, out);
}

}  // namespace tumble
