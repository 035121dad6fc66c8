#pragma once
#include "engine/collision/v_clip/walk.hpp"

namespace tumble::vclip {

/// A direction in frame 0 along which the bodies have the gap `gap` [m]; a negative one is their
/// overlap along it.
struct PartingDirection {
  Vec3 normal = Vec3::UnitX();  ///< unit, from A to B
  double gap = -std::numeric_limits<double>::infinity();
  double distance = 0;  ///< estimate of the distance, to be verified [m]
};

/// The gap along `normal`, computed from all vertices.
double gap_across(const Walk& walk, const Vec3& normal);

/// A direction along which the bodies are apart or overlap by no more than the contact tolerance;
/// if there is none, that with the least overlap (the penetration depth, up to rounding).
/// Candidates come from GJK and EPA; one counts only if the gap computed along it confirms it. If
/// they fail (thin bodies that almost coincide), all normals of faces and pairs of edges are tried.
PartingDirection parting_direction(const Walk& walk);

}  // namespace tumble::vclip
