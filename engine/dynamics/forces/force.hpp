#pragma once
#include "engine/dynamics/forces/drag.hpp"
#include "engine/dynamics/forces/load.hpp"
#include "engine/dynamics/forces/mouse_spring.hpp"
#include "engine/dynamics/forces/pair/pair_potentials.hpp"
#include "engine/dynamics/forces/point_gravity.hpp"
#include "engine/dynamics/forces/spring.hpp"
#include "engine/dynamics/forces/spring_mesh.hpp"
#include "engine/dynamics/forces/turbulence.hpp"
#include "engine/dynamics/forces/uniform_field.hpp"
#include "engine/dynamics/forces/vortex.hpp"
#include "engine/dynamics/forces/vortex_ring.hpp"
#include "engine/dynamics/forces/well.hpp"
#include "engine/dynamics/forces/wind.hpp"

#include <optional>
#include <string_view>
#include <variant>
#include <vector>

namespace tumble {

/// The list of force types; adding one is an alternative at its end (snapshots keep the number),
/// its header, source and test. What it can do is seen from its members: `targets`, `potential`,
/// `at`, `fault`, `varies_in_time`, and functions `apply`, `anchors`, `potential_energy`.
using ForceDef =
    std::variant<LinearDragDef, QuadraticDragDef, SpringDef, MouseSpringDef, PointGravityDef,
                 AttractorDef, RepulsorDef, VortexDef, WindDef, TurbulenceDef, LennardJonesDef,
                 CoulombDef, MutualGravityDef, MorseDef, PairTableDef, VortexRingDef, SpringMeshDef,
                 LoadDef, UniformFieldDef>;

/// Checks ranges and that the anchors exist and are movable where they must be.
Status validate(const ForceDef& def, const ForceContext& context);

/// Whether numbers of it follow courses over time (Varying).
bool follows_courses(const ForceDef& def);
/// Whether these are others at a time than they are now.
bool differs_at(const ForceDef& def, double t);
/// Puts these to what they are at a time.
void go_to(ForceDef& def, double t);
/// Whether every number is finite and in its range, as it is now.
Status check_ranges(const ForceDef& def);

/// Adds the force of this tick to the force and torque sums.
void apply(const ForceDef& def, ForceContext& context);

/// Potential energy stored [J]; 0 for dissipative forces.
double potential_energy(const ForceDef& def, const ForceContext& context);
/// Whether it stores any: springs, fields of acceleration, pair potentials.
bool has_potential(const ForceDef& def);

/// The anchors of a force (two for springs, the nodes of meshes), for drawing and for island links;
/// may be empty. Those of a mesh are the definition's own.
Anchors anchors(const ForceDef& def);

/// Whether a force is one spring or many: over a tick they are solved all together.
inline bool is_spring(const ForceDef& def) {
  return std::holds_alternative<SpringDef>(def) || std::holds_alternative<SpringMeshDef>(def);
}

/// What a field acts on; null for forces that are no fields.
const FieldTargets* field_targets(const ForceDef& def);
inline FieldTargets* field_targets(ForceDef& def) {
  return const_cast<FieldTargets*>(field_targets(std::as_const(def)));
}

/// The particle systems between whose particles a pair potential acts, all where it names none;
/// null for other forces.
const std::vector<ParticleSystemId>* paired_systems(const ForceDef& def);
inline std::vector<ParticleSystemId>* paired_systems(ForceDef& def) {
  return const_cast<std::vector<ParticleSystemId>*>(paired_systems(std::as_const(def)));
}

/// Whether what rests may be moved by it later: the force changes by itself, not by courses.
bool varies_in_time(const ForceDef& def);

/// A field at a point and a time, for drawing: velocity of a flow [m/s], else acceleration [m/s2].
/// Nothing for forces that are no fields.
struct FieldSample {
  Vec3 value = Vec3::Zero();
  bool flow = false;
};
std::optional<FieldSample> sample_field(const ForceDef& def, const Vec3& x_world, double t);

std::string_view type_name(const ForceDef& def);

}  // namespace tumble
