#pragma once
#include "engine/math/lcp/problem.hpp"

namespace tumble::lcp {

/// Event that ends the motion of a driven unknown, or changes the role of another.
enum class PivotEvent : uint8_t {
  none,
  own_w,      ///< its w has become 0: it is clamped from then on
  own_bound,  ///< it has reached its other bound
  bound,      ///< a clamped unknown has reached a bound, where it stays
  apex,       ///< the axial unknown of a group has become 0: the group opens
  surface,    ///< the laterals of a group have reached the cone's surface
  other_w,    ///< the w of another unknown has become 0 and would change its sign
  inward,     ///< laterals on the surface move back inside
};

/// Role of an unknown during pivoting.
enum class PivotSet : uint8_t {
  at_lower,
  at_upper,
  clamped,  ///< its w is held at 0
  resting,  ///< free, but its w is still wrong
  tied,     ///< a lateral on the cone's surface, which follows its axial unknown
};

/// A state during principal pivoting.
struct PivotStep {
  int driven = -1;  ///< the unknown that moved; -1: none, at the start
  PivotEvent event = PivotEvent::none;
  int limiting = -1;  ///< the unknown whose limit stopped the motion
  double step = 0;    ///< displacement of the driven unknown, in its own unit
  VecX z;             ///< in the problem's own units and axes
  /// By unknown; for laterals of circular groups along the axes as rotated by the method.
  std::vector<PivotSet> sets;
};

/// Record of a pivoting method, made on request (watch_dantzig(), watch_baraff()).
struct PivotTrace {
  std::vector<PivotStep> steps;  ///< the first one is the start
  size_t most = 400;             ///< further steps are counted, but not kept
  size_t left_out = 0;
  /// The directions of laterals were turned by Newton's method after the last step.
  bool polished = false;
};

}  // namespace tumble::lcp
