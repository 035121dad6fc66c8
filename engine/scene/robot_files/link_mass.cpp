#include "engine/scene/robot_files/link_mass.hpp"

#include "engine/geometry/hull/convex_hull.hpp"
#include "engine/geometry/mesh_topology.hpp"
#include "engine/scene/mesh_import.hpp"
#include "engine/scene/robot_files/physical_inertia.hpp"
#include "engine/scene/robot_files/tolerances.hpp"

#include <cmath>
#include <numbers>

#include <fmt/format.h>

namespace tumble {
namespace {

constexpr double water = 1000, densest = 22590;  // [kg/m3], of water and of osmium

/// Mass properties of the colliding, or else drawn, geometry at density 1; mass 0 if there is none.
MassProperties geometry_mass(const RobotLink& link) {
  std::vector<MassProperties> parts;
  for (const RobotGeometry& g : link.collides.empty() ? link.drawn : link.collides)
    if (const auto m = mass_of(g, 1)) parts.push_back(*m);
  return compound(parts);
}

/// The least moment of inertia for a mass and density, that of a ball [kg m2].
double least_inertia(double mass, double density) {
  const double radius = std::cbrt(0.75 * mass / (density * std::numbers::pi));
  return 0.4 * mass * radius * radius;
}

/// Warns of an inertia smaller than any material gives: links attached to such a body with a lever
/// arm accelerate it so much that neither stepper resolves the motion.
void look_at_density(const RobotLink& link, const Vec3& moments, const GivenInertia& given,
                     RobotLog& log) {
  const double largest = moments.maxCoeff();
  if (!(largest < least_inertia(link.mass.mass, densest))) return;
  const MassProperties shape = geometry_mass(link);
  const double of_shape =
      shape.mass > 0 ? inertia_about(shape.times(link.mass.mass / shape.mass), link.mass.centre)
                           .diagonal()
                           .maxCoeff()
                     : 0;
  log.warn(given.at,
           fmt::format("link '{}': {:.6g} kg with a moment of inertia of {:.3g} kg m2 at most is "
                       "denser than any matter, and joints on it may blow up (a ball of water has "
                       "{:.3g}{})",
                       link.name, link.mass.mass, largest, least_inertia(link.mass.mass, water),
                       of_shape > 0 ? fmt::format(", its geometry, evenly filled, {:.3g}", of_shape)
                                    : std::string()));
}

}  // namespace

std::optional<MassProperties> mass_of(const RobotGeometry& g, double density) {
  std::optional<MassProperties> own;
  if (g.mesh.empty()) {
    const auto shape = make_shape(g.shape);
    const auto m = shape ? (*shape)->mass_properties() : shape.error();
    if (m) own = m->times(density);
  } else if (const auto read = import_mesh(g.mesh, {.stretch = g.scale})) {
    const MassProperties solid = build_topology(read->mesh).closed()
                                     ? mesh_integrals(read->mesh, density)
                                     : MassProperties{};
    if (solid.mass > 0)
      own = solid;
    else if (const auto hull = convex_hull(read->mesh.vertices))
      own = polyhedron_mass(hull->polyhedron, density);
  }
  return own && own->mass > 0 ? std::optional(moved(*own, g.pose)) : std::nullopt;
}

void complete_mass(RobotLink& link, const GivenInertia& given, RobotLog& log) {
  MassProperties& m = link.mass;
  if (!(m.mass > robot_tolerances::least_mass)) {
    m = {};
    return;
  }
  if (const auto made = given.tensor ? physical_inertia(*given.tensor) : std::nullopt) {
    m.inertia = made->inertia;
    if (made->changed)
      log.warn(given.at,
               fmt::format("link '{}': no body has principal moments of inertia {:.6g}, {:.6g}, "
                           "{:.6g} kg m2, for each must be above 0 and at most the sum of the "
                           "others; the nearest that one has are taken: {:.6g}, {:.6g}, {:.6g}",
                           link.name, made->given.x(), made->given.y(), made->given.z(),
                           made->made.x(), made->made.y(), made->made.z()));
    look_at_density(link, made->made, given, log);
    return;
  }
  const MassProperties shape = geometry_mass(link);
  if (shape.mass > 0) {
    m.inertia = inertia_about(shape.times(m.mass / shape.mass), m.centre);
    if (const auto sane = physical_inertia(m.inertia)) m.inertia = sane->inertia;
  } else {
    m.inertia = least_inertia(m.mass, water) * Mat3::Identity();
  }
  log.warn(given.at,
           fmt::format("link '{}' has a mass and {} inertia: that of {} is taken", link.name,
                       given.tensor ? "an unusable" : "no",
                       shape.mass > 0 ? "its geometry, evenly filled," : "a ball of water"));
}

}  // namespace tumble
