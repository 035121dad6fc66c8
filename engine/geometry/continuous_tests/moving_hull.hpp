#pragma once
#include "engine/geometry/continuous_tests/moving.hpp"

#include <array>
#include <optional>

namespace tumble {

/// The corners of the difference A - B of two features, at both ends of the motion: the features
/// meet when their hull holds the origin. Vertex p and face q: p - q_i. Edges: a_i - b_j at 2i + j.
struct MovingHull {
  std::array<Vec3, 4> start, end;
  int corners = 0;  ///< 3: vertex and face; 4: edges

  MovingHull(const MovingPoint& vertex, const MovingTriangle& face);
  MovingHull(const MovingEdge& a, const MovingEdge& b);
};

/// Marches forward in time from `from` by steps that are proven free, until nothing is left or
/// nothing can be proven.
///
/// A step [s, t] is free when some direction that turns linearly from w(s) to w(t) separates: each
/// w . corner is quadratic in time, and its three Bernstein coefficients exceed `separation` and a
/// bound on all rounding. |w| <= 1 throughout, a norm being convex. The loss against the true
/// distance is of second order in the step, so that grazing passes take few steps; a constant
/// direction always allows some step while the distance is above rounding. Directions are taken
/// from the nearest points and the common normal; they need not be exact.
///
/// Works for every position of the corners: without area, without length, parallel, coplanar.
std::optional<MovingContact> march(const MovingHull& hull, double separation, double from);
/// What march() says from 0 where the features are known to meet at the start, without the search
/// for the end of the doubt.
MovingContact contact_at_start(const MovingHull& hull);

}  // namespace tumble
