#include "engine/scene/build/emitter_overlaps.hpp"

#include "engine/collision/query.hpp"
#include "engine/math/det/det.hpp"
#include "engine/world/world.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace tumble {
namespace {

/// Kind of what an emitter emits, with regard to collisions.
enum class Emitted : uint8_t { nothing, fluid, particles, fast_particles, bodies };

Emitted emitted_by(const World& world, const EmitterDef& def) {
  if (def.body) return Emitted::bodies;
  const ParticleSystem* system = world.particles(def.particles);
  if (!system) return Emitted::nothing;
  if (system->fluid) return Emitted::fluid;
  if (!system->collide) return Emitted::nothing;
  return system->fast ? Emitted::fast_particles : Emitted::particles;
}

/// Whether the two collide and neither is meant to come out of the other, as sparks may out of
/// bodies.
bool push_each_other(Emitted a, Emitted b) {
  if (a == b) return a != Emitted::nothing && a != Emitted::fast_particles;
  return std::min(a, b) == Emitted::particles && std::max(a, b) == Emitted::fast_particles;
}

/// The region where an emitter emits, slightly thickened, in its own frame. Its sides are moved
/// inwards by rounding, so that adjacent regions do not overlap.
struct Region {
  double thick;  ///< [m]

  using Placed = std::optional<std::pair<ShapeDef, Pose>>;
  static constexpr double drawn_in = 1 - 1e-6;

  Placed operator()(const PointEmission&) const { return std::pair{ball_def(thick), Pose{}}; }
  Placed operator()(const LineEmission& line) const {
    ShapeDef out;
    out.type = ShapeType::box;
    out.half_extents = {0.5 * line.length * drawn_in, thick, thick};
    return std::pair{out, Pose{}};
  }
  Placed operator()(const DiscEmission& disc) const {
    if (disc.inner_radius > 0) return std::nullopt;
    ShapeDef out;
    out.type = ShapeType::cylinder;
    out.radius = disc.radius * drawn_in;
    out.height = 2 * thick;
    return std::pair{out, Pose{}};
  }
  Placed operator()(const SphereEmission& ball) const {
    if (ball.surface) return std::nullopt;
    return std::pair{ball_def(ball.radius * drawn_in), Pose{}};
  }
  Placed operator()(const BoxEmission& box) const {
    if (box.surface) return std::nullopt;
    ShapeDef out;
    out.type = ShapeType::box;
    out.half_extents = 0.5 * drawn_in * box.size;
    return std::pair{out, Pose{}};
  }
  Placed operator()(const MeshSurfaceEmission&) const { return std::nullopt; }
  Placed operator()(const MeshVolumeEmission&) const { return std::nullopt; }
};

/// With more bursts than this, only the time from the first to the last is considered.
constexpr int most_bursts = 1000;

/// The intervals in which an emitter emits [s]; a burst is an instant.
std::vector<std::pair<double, double>> times_of(const EmitterDef& def) {
  std::vector<std::pair<double, double>> out;
  if (def.rate > 0)
    out.push_back({def.start, std::min(def.end, def.start + double(def.count) / def.rate)});
  for (const Burst& b : def.bursts) {
    if (b.times > most_bursts) out.push_back({b.time, b.time + (b.times - 1) * b.every});
    for (int k = 0; k < b.times && b.times <= most_bursts; ++k)
      out.push_back({b.time + k * b.every, b.time + k * b.every});
  }
  return out;
}

/// An emitter with its position and kind.
struct PlacedEmitter {
  std::string name;
  const EmitterDef* def;
  Emitted emitted;
  std::shared_ptr<const Shape> region;
  Pose pose;
  std::vector<std::pair<double, double>> times;
};

std::optional<PlacedEmitter> placed(const World& world, const std::string& name,
                                    const EmitterDef& def) {
  PlacedEmitter out{name, &def, emitted_by(world, def), nullptr, def.pose, times_of(def)};
  if (out.emitted == Emitted::nothing || out.times.empty()) return std::nullopt;
  // Half a radius: points a whole radius apart already give deep overlaps of the balls.
  double thick = 0.5 * def.radius.mean;
  if (def.body) {
    if (def.body->shapes.empty()) return std::nullopt;
    const auto shape = make_shape(def.body->shapes[0].shape);
    if (!shape || !std::isfinite((*shape)->bounding_radius())) return std::nullopt;
    thick = 1e-3 * (*shape)->bounding_radius();
  }
  const auto region = std::visit(Region{thick}, def.shape);
  const auto shape =
      region ? make_shape(region->first) : Result<std::shared_ptr<const Shape>>(Error{});
  if (!shape) return std::nullopt;
  out.region = *shape;
  if (const RigidBody* carrier = world.body(def.carrier))
    out.pose = carrier->body_frame() * out.pose;
  out.pose = out.pose * region->second;
  return out;
}

bool at_one_time(const PlacedEmitter& a, const PlacedEmitter& b) {
  for (const auto& [from, to] : a.times)
    for (const auto& [begin, end] : b.times)
      if (const double first = std::max(from, begin), last = std::min(to, end);
          first < last || (first == last && (from == to || begin == end)))
        return true;
  return false;
}

}  // namespace

std::vector<EmitterOverlap> emitter_overlaps(const BuiltScene& built) {
  std::vector<PlacedEmitter> all;
  for (const auto& [name, id] : built.emitters)
    if (const Emitter* emitter = built.world->emitter(id))
      if (auto one = placed(*built.world, name, *emitter->def)) all.push_back(*std::move(one));
  std::vector<EmitterOverlap> out;
  for (size_t i = 0; i < all.size(); ++i)
    for (size_t k = i + 1; k < all.size(); ++k) {
      const PlacedEmitter &a = all[i], &b = all[k];
      if (a.def->carrier == b.def->carrier && push_each_other(a.emitted, b.emitted) &&
          at_one_time(a, b) && overlap(*a.region, a.pose, *b.region, b.pose))
        out.push_back({a.name, b.name, b.pose.x});
    }
  return out;
}

}  // namespace tumble
