#include "engine/scene/description/material.hpp"

#include "engine/core/text.hpp"

namespace tumble {
namespace {

void lay_over(Material& material, const MaterialDescription& d) {
  if (d.friction) material.friction = *d.friction;
  if (d.restitution) material.restitution = *d.restitution;
  if (d.density) material.density = *d.density;
  if (d.surface_velocity) material.surface_velocity = *d.surface_velocity;
  if (d.rolling_friction) material.rolling_friction = *d.rolling_friction;
  if (d.torsional_friction) material.torsional_friction = *d.torsional_friction;
}

Error unknown_material(const std::string& name, const NamedList<MaterialDescription>& materials) {
  std::vector<std::string> known = materials.names();
  for (const auto& [built_in, m] : built_in_materials()) known.emplace_back(built_in);
  return {ErrorCode::not_found, unknown_name("material", name, known), {}, {}};
}

}  // namespace

const std::vector<std::pair<std::string_view, Material>>& built_in_materials() {
  // Textbook values, rounded; friction against the same material, dry.
  static const std::vector<std::pair<std::string_view, Material>> materials = {
      {"default", {}},
      {"wood", {0.45, 0.2, 700, Vec3::Zero()}},
      {"steel", {0.4, 0.4, 7850, Vec3::Zero()}},
      {"aluminium", {0.45, 0.3, 2700, Vec3::Zero()}},
      {"stone", {0.65, 0.1, 2500, Vec3::Zero()}},
      {"brick", {0.65, 0.05, 1900, Vec3::Zero()}},
      {"concrete", {0.7, 0.05, 2400, Vec3::Zero()}},
      {"glass", {0.4, 0.5, 2500, Vec3::Zero()}},
      {"ice", {0.03, 0.1, 917, Vec3::Zero()}},
      {"rubber", {0.9, 0.75, 1100, Vec3::Zero()}},
      {"plastic", {0.35, 0.4, 1000, Vec3::Zero()}},
      {"cork", {0.6, 0.3, 240, Vec3::Zero()}},
      {"card", {0.5, 0, 800, Vec3::Zero()}},
      {"frictionless", {0, 0, 1000, Vec3::Zero(), 0, 0}}};
  return materials;
}

Result<Material> resolve_material(const MaterialDescription& description,
                                  const NamedList<MaterialDescription>& materials) {
  // From the requested one up to the base, then merged from the base down.
  std::vector<const MaterialDescription*> chain{&description};
  Material out;
  while (!chain.back()->like.empty()) {
    const std::string& name = chain.back()->like;
    const MaterialDescription* next = materials.find(name);
    // "steel": {"like": "steel", ...} refines the built-in material.
    if (next == chain.back()) next = nullptr;
    if (!next) {
      bool found = false;
      for (const auto& [built_in, material] : built_in_materials())
        if (built_in == name) out = material, found = true;
      if (!found) return unknown_material(name, materials);
      break;
    }
    if (chain.size() > 16)
      return Error{
          ErrorCode::parse,
          "the materials refer to each other in a circle, or over more than 16 names, at '" + name +
              "'",
          {},
          {}};
    chain.push_back(next);
  }
  for (size_t i = chain.size(); i-- > 0;) lay_over(out, *chain[i]);
  return out;
}

}  // namespace tumble
