#pragma once
#include "engine/math/lcp/problem.hpp"

namespace tumble::lcp {

/// What ends the motion of a driven unknown, or changes who follows it.
enum class PivotEvent : uint8_t {
  none,
  own_w,      ///< its w has come to 0: it is clamped from then on
  own_bound,  ///< it has met its other bound
  bound,      ///< a clamped unknown has met a bound, where it stays
  apex,       ///< the axial unknown of a group has come to 0: the group opens
  surface,    ///< the laterals of a group have met the cone's surface
  other_w,    ///< the w of another unknown has come to 0 and would change its sign
  inward,     ///< laterals on the surface want back inside
};

/// Where an unknown is in the course of pivoting.
enum class PivotSet : uint8_t {
  at_lower,
  at_upper,
  clamped,  ///< its w is held at 0
  resting,  ///< free, but its w is still wrong
  tied,     ///< a lateral on the cone's surface, which follows its axial unknown
};

/// A point on the way of principal pivoting.
struct PivotStep {
  int driven = -1;  ///< the unknown that moved to here; -1: none, the start
  PivotEvent event = PivotEvent::none;
  int limiting = -1;  ///< whose limit it was
  double step = 0;    ///< by which the driven one moved, with its sign, in its own unit
  VecX z;             ///< in the problem's own units and axes
  /// By unknown; of laterals of circular groups along the axes that the method has turned them to.
  std::vector<PivotSet> sets;
};

/// What a pivoting method writes down as it goes, for whoever asks for it (watch_dantzig(),
/// watch_baraff()).
struct PivotTrace {
  std::vector<PivotStep> steps;  ///< the first one is the start
  size_t most = 400;             ///< more are counted, not kept
  size_t left_out = 0;
  /// The direction of laterals has been turned by Newton's method after the last step.
  bool polished = false;
};

}  // namespace tumble::lcp
