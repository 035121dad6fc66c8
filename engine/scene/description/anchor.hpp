#pragma once
#include "engine/scene/description/values.hpp"

#include <string>

namespace tumble {

/// Where a force takes hold: a point of a body (in its own frame), a particle, or of the world.
struct AnchorDescription {
  std::string body;
  std::string particles;
  int index = 0;
  Vec3 point = Vec3::Zero();  ///< [m]

  static constexpr std::string_view schema_name = "anchor";
  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.field(d.body, {.name = "body", .doc = "name of a body, or of a copy: \"brick[3]\""});
    v.field(d.particles, {.name = "particles", .doc = "instead: name of a particle system"});
    v.field(d.index, {.name = "index", .min = 0, .max = 1e7, .doc = "number of the particle"});
    v.field(d.point, {.name = "point",
                      .unit = "m",
                      .min = -1e7,
                      .max = 1e7,
                      .doc = "in the body's frame; without body or particles in the world"});
  }
  static void check(const AnchorDescription& d, Complaints& complaints) {
    if (!d.body.empty() && !d.particles.empty())
      complaints.add("", "give body or particles, not both");
  }
};

}  // namespace tumble
