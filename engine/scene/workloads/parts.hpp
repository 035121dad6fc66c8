#pragma once
#include "engine/scene/workloads/workload.hpp"

/// Bodies of which several workloads are made; density 1000 kg/m3.
namespace tumble {

ShapeDef box_shape(const Vec3& half_extents);
BodyDef box_body(const Vec3& x, const Vec3& half_extents);
BodyDef sphere_body(const Vec3& x, double radius);
/// Along the body's y axis; `half_length` is half the distance of the two centres.
BodyDef capsule_body(const Vec3& x, double radius, double half_length);
BodyDef fixed_box(const Vec3& x, const Vec3& half_extents);
/// 200 m by 200 m, its top at y = 0.
BodyDef wide_floor();

/// Five fixed boxes, 1 m thick: a floor whose top is y = 0 and four walls.
void add_bin(Workload& w, double half_width, double wall_height);

/// Position of element i of a stack filled layer by layer: side x side positions per layer, `pitch`
/// apart and centred about the y axis; layers are `pitch` apart too, the lowest at height `bottom`
/// [m].
Vec3 layered_place(int i, int side, double pitch, double bottom);

}  // namespace tumble
