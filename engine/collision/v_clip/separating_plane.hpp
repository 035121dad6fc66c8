#pragma once
#include "engine/collision/v_clip/walk.hpp"

namespace tumble::vclip {

/// A direction in frame 0 across which the bodies are parted by `gap` [m]; negative: they overlap
/// by that much across it.
struct PartingDirection {
  Vec3 normal = Vec3::UnitX();  ///< unit, from A to B
  double gap = -std::numeric_limits<double>::infinity();
  double distance = 0;  ///< what the distance is thought to be; to be checked [m]
};

/// The gap across `normal`, from all vertices.
double gap_across(const Walk& walk, const Vec3& normal);

/// A direction in which the bodies are apart or overlap by no more than the contact tolerance; when
/// there is none, the one with the least overlap (up to rounding the penetration depth). GJK and
/// EPA propose; a proposal counts only when the gap across it bears it out. Where they fail (thin
/// bodies that almost coincide) all normals of faces and pairs of edges are tried.
PartingDirection parting_direction(const Walk& walk);

}  // namespace tumble::vclip
