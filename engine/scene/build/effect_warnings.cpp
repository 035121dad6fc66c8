#include "engine/scene/build/effect_warnings.hpp"

#include "engine/scene/json_tree.hpp"
#include "engine/world/world.hpp"

#include <variant>

#include <fmt/format.h>

namespace tumble {
namespace {

/// Adds a warning for a value that has no effect.
class Idle {
 public:
  explicit Idle(std::vector<std::string>& out) : out_(out) {}
  void operator()(bool idle, const std::string& path, const char* why) {
    if (idle) out_.push_back(fmt::format("{}: has no effect: {}", path, why));
  }

 private:
  std::vector<std::string>& out_;
};

void look_at_fluid(const FluidDef& d, const std::string& path, Idle& idle) {
  const FluidDef usual;
  const bool wcsph = d.solver == FluidSolverKind::wcsph;
  idle(!wcsph && d.sound_speed != usual.sound_speed, path + ".sound_speed",
       "it is of wcsph, and the solver is dfsph (\"solver\": \"wcsph\")");
  idle(wcsph && d.density_error != usual.density_error, path + ".density_error",
       "it is of dfsph, and the solver is wcsph (leave it out)");
  idle(wcsph && d.most_iterations != usual.most_iterations, path + ".most_iterations",
       "it is of dfsph, and the solver is wcsph (leave it out)");
  idle(d.adhesion > 0 && !(d.surface_tension > 0), path + ".adhesion",
       "it is a share of surface_tension, which is 0 (give that too)");
}

void look_at_look(const ParticleLookDescription& d, const std::string& path, Idle& idle) {
  const ParticleLookDescription usual;
  const bool surface = d.style == ParticleStyle::surface, smoke = d.style == ParticleStyle::smoke;
  idle(!surface && d.clarity != usual.clarity, path + ".clarity",
       "it is of the style surface (leave it out)");
  idle(!surface && d.foam != usual.foam, path + ".foam",
       "it is of the style surface (leave it out)");
  idle(!smoke && d.opacity != usual.opacity, path + ".opacity",
       "it is of the style smoke (leave it out)");
}

/// Whether a shape has outward normals; for the others, outward means the axis.
bool has_outward(const std::optional<EmissionShapeDescription>& shape) {
  if (!shape) return false;
  if (const auto* box = std::get_if<BoxEmission>(&shape->kind)) return box->surface;
  return std::holds_alternative<SphereEmission>(shape->kind) ||
         std::holds_alternative<MeshEmissionDescription<MeshSurfaceEmission>>(shape->kind);
}

void look_at_emitter(const SceneDescription& scene, const std::string& name,
                     const EmitterDescription& d, Idle& idle) {
  const std::string path = "emitters." + name;
  const ParticleSystemDescription* system = scene.particles.find(d.particles);
  idle(!d.colours.empty() && !d.colour_over_life.empty(), path + ".colours",
       "colour_over_life takes their place (leave one of them out)");
  idle(system && system->look.style != ParticleStyle::smoke && !d.opacity_over_life.empty(),
       path + ".opacity_over_life",
       "only smoke can be seen through (\"look\": \"smoke\" of the particles)");
  idle(
      d.direction == EmissionDirection::outward && !has_outward(d.shape), path + ".direction",
      "this shape has no outside, and they leave about the axis (a sphere, or a surface, has one)");
  idle(d.spread_deg > 0 && d.speed.number.mean == 0 && d.speed.number.spread == 0,
       path + ".spread_deg", "the speed is 0 (give a speed)");
}

/// Looks for lists that are given but empty, which the description cannot distinguish from those
/// left out.
void look_at_empty_lists(const SceneDescription& scene, Idle& idle) {
  const JsonNode* tree = scene.source ? scene.source->tree.get() : nullptr;
  const JsonNode* emitters = tree ? tree->find("emitters") : nullptr;
  if (!emitters) return;
  for (size_t i = 0; i < emitters->keys.size(); ++i)
    for (const char* key : {"colours", "size_over_life", "mass_over_life", "colour_over_life",
                            "opacity_over_life", "over_time", "bursts", "events"}) {
      const JsonNode* list = emitters->items[i].find(key);
      idle(list && list->is(JsonNode::Kind::array) && list->items.empty(),
           fmt::format("emitters.{}.{}", emitters->keys[i], key),
           "the list is empty (leave it out)");
    }
}

}  // namespace

std::vector<std::string> effect_warnings(const BuiltScene& built) {
  std::vector<std::string> out;
  Idle idle(out);
  const SceneDescription& scene = *built.description;
  for (const auto& [name, p] : scene.particles.items) {
    if (p.fluid) look_at_fluid(p.fluid->def, "particles." + name + ".fluid", idle);
    look_at_look(p.look, "particles." + name + ".look", idle);
  }
  for (const auto& [name, e] : scene.emitters.items) look_at_emitter(scene, name, e, idle);
  look_at_empty_lists(scene, idle);
  return out;
}

}  // namespace tumble
