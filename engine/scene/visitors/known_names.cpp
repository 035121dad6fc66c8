#include "engine/scene/visitors/known_names.hpp"

#include "engine/collision/broad_phase.hpp"
#include "engine/collision/narrow_phase.hpp"
#include "engine/collision/time_of_contact.hpp"
#include "engine/dynamics/event/contact_forces.hpp"
#include "engine/dynamics/event/impulses/impact_law.hpp"
#include "engine/geometry/hierarchy/hierarchy.hpp"
#include "engine/math/ode/integrator.hpp"
#include "engine/world/microscope/microscope.hpp"
#include "engine/world/settings.hpp"

namespace tumble {
namespace {

template <class Entry>
std::vector<std::string> names_of(const std::vector<Entry>& entries) {
  std::vector<std::string> out;
  for (const Entry& e : entries) out.emplace_back(e.name);
  return out;
}

}  // namespace

std::vector<std::string> known_names(std::string_view parameter) {
  if (parameter == "stepper") {
    const auto names = stepper_names();
    return {names.begin(), names.end()};
  }
  if (parameter == "broad_phase") return names_of(all_broad_phases());
  if (parameter == "hierarchy") return names_of(all_hierarchies());
  if (parameter == "narrow_phase") return names_of(all_narrow_phases());
  if (parameter == "algorithm") return names_of(all_microscopes());
  if (parameter == "contact_time") return names_of(all_contact_time_methods());
  if (parameter == "integrator") return names_of(ode::all_integrators());
  if (parameter == "impulses") return names_of(all_impact_laws());
  if (parameter == "contact_solver") {
    std::vector<std::string> names = names_of(lcp::all_lcp_solvers());
    names.insert(names.begin(), "automatic");
    return names;
  }
  if (parameter == "friction_cone") {
    const auto cones = all_friction_cones();
    return {cones.begin(), cones.end()};
  }
  // The overlays are declared by the viewer, which this library does not know: a test compares this
  // list with all_overlays().
  if (parameter == "overlays")
    return {"contacts",  "normals",    "forces",  "friction_cones", "aabbs",           "grid",
            "joints",    "velocities", "momenta", "total_forces",   "collision_shape", "islands",
            "hierarchy", "sensors"};
  if (parameter == "volumes") {
    std::vector<std::string> names = names_of(all_hierarchies());
    std::erase(names, "brute_force");  // has no volumes
    return names;
  }
  return {};
}

}  // namespace tumble
