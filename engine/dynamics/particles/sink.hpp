#pragma once
#include "engine/core/parameters.hpp"
#include "engine/dynamics/particles/particle_system.hpp"
#include "engine/dynamics/particles/tolerances.hpp"

#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace tumble {

struct SinkTag;
using SinkId = Handle<SinkTag>;

// Regions of sinks, each in its own frame.

/// The half-space y < 0.
struct PlaneSink {
  static constexpr std::string_view type_name = "plane";
  template <class Visitor, class Self>
  static void parameters(Visitor&, Self&) {}
  bool holds(const Vec3& x) const { return x.y() < 0; }
};

struct BoxSink {
  static constexpr std::string_view type_name = "box";
  Vec3 size{1, 1, 1};  ///< full extents [m]
  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.field(d.size, {.name = "size",
                     .unit = "m",
                     .min = 0,
                     .max = tolerances::longest_sink,
                     .exclusive_min = true,
                     .required = true,
                     .doc = "full extents"});
  }
  bool holds(const Vec3& x) const { return (x.array().abs() <= 0.5 * size.array()).all(); }
};

struct SphereSink {
  static constexpr std::string_view type_name = "sphere";
  double radius = 1;  ///< [m]
  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.field(d.radius, {.name = "radius",
                       .unit = "m",
                       .min = 0,
                       .max = tolerances::longest_sink,
                       .exclusive_min = true,
                       .required = true,
                       .doc = "of the ball"});
  }
  bool holds(const Vec3& x) const { return x.squaredNorm() <= radius * radius; }
};

/// The list of regions of sinks; to add one, append an alternative.
using SinkRegion = std::variant<PlaneSink, BoxSink, SphereSink>;

/// Removes particles, and bodies if asked to: particles whose centre is in it at the end of a tick,
/// dynamic bodies at the beginning of the next.
struct SinkDef {
  std::string name;
  SinkRegion region;
  Pose pose;             ///< of the region's frame in the world
  bool outside = false;  ///< the sink is everything outside of the region
  bool takes_particles = true;
  std::vector<ParticleSystemId> systems;  ///< whose particles it takes; empty: those of all systems
  bool takes_bodies = false;
};

bool holds(const SinkDef& sink, const Vec3& x_world);
/// Names the value that is wrong.
Status validate(const SinkDef& def);

}  // namespace tumble
