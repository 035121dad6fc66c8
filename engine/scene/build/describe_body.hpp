#pragma once
#include "engine/scene/description/body.hpp"

namespace tumble {

/// The description from which body_defs() would make this definition, without shapes, materials and
/// what only files have (repetitions, labels): to be displayed, changed by its declared parameters,
/// and applied again.
BodyDescription describe_body(const BodyDef& def);
/// The material with every member given.
MaterialDescription describe_material(const Material& material);

/// Sets in `def` what differs between two descriptions of it. Mass and density exclude each other:
/// a change of either replaces the other.
void apply_changes(const BodyDescription& before, const BodyDescription& after, BodyDef& def);
void apply_changes(const MaterialDescription& before, const MaterialDescription& after,
                   Material& material);

}  // namespace tumble
