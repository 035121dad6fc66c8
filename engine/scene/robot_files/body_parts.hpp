#pragma once
#include "engine/scene/description.hpp"
#include "engine/scene/robot_files/robot_bodies.hpp"

namespace tumble {

/// The description of a body but for its place: shapes, what is drawn, mass. Meshes that it needs
/// are added to `meshes` under names that begin with `prefix`; links collide as the hulls of
/// theirs. Of a body that shows nothing the box of equal inertia is drawn, which is said.
BodyDescription body_of(const RobotBody& body, const std::string& prefix,
                        NamedList<MeshDescription>& meshes, RobotLog& log);

/// What is seen of a body: what is drawn, or else what collides.
const std::vector<RobotGeometry>& seen_of(const RobotBody& body);
/// Of a geometry of a body with this pose; empty for planes.
Aabb bounds_of(const RobotGeometry& geometry, const Pose& body);
bool is_plane(const RobotGeometry& geometry);

}  // namespace tumble
