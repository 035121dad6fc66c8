#pragma once
#include "engine/scene/description/body.hpp"

namespace tumble {

/// What body_defs() made a definition from, but for shapes, materials and what only files know
/// (repetitions, labels): to be shown, changed by its declared parameters, and given back.
BodyDescription describe_body(const BodyDef& def);
/// The material with every member given.
MaterialDescription describe_material(const Material& material);

/// Sets in `def` what differs between two descriptions of it. Mass and density exclude each other,
/// so that a new one of either counts.
void apply_changes(const BodyDescription& before, const BodyDescription& after, BodyDef& def);
void apply_changes(const MaterialDescription& before, const MaterialDescription& after,
                   Material& material);

}  // namespace tumble
