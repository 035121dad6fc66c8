#pragma once
#include "engine/math/lcp/pivoting/cone_pivots.hpp"

namespace tumble::lcp {

/// Drives unknowns of ConePivots one after the other until all conditions hold, the directions of
/// laterals on their surfaces being kept (Baraff, "Fast contact force computation for
/// nonpenetrating rigid bodies", SIGGRAPH 1994, §4 to §5).
class ConeDriver {
 public:
  ConeDriver(ConePivots& state, int limit) : s_(state), limit_(limit) {}

  /// `solved` when all conditions but the alignment of laterals with w hold; `ray` with the ray
  /// when a motion is stopped by nothing.
  LcpStatus run();
  VecX ray;
  int pivots = 0;

 private:
  enum class Event { none, own_w, own_bound, bound, apex, surface, other_w, inward };
  struct Stop {
    Event event = Event::none;
    int index = -1;
    double step = 0, rate = 0;
  };
  enum class End { done, open_ended, failed };

  End drive(int l);
  End correct(int l);
  End push_axial(int l);
  bool changes_nothing(int l) const;
  void collect(int l, double sign, bool flat);
  void collect_surfaces(const ConePivots::Group& g);
  void collect_slacks(int l);
  void offer(Event event, int index, double room, double rate);
  Stop pick() const;
  bool apply(const Stop& stop, int l);
  bool repeats(int l, double step);

  ConePivots& s_;
  int limit_;
  LcpStatus failure_ = LcpStatus::numeric;
  VecX dz_, dw_;
  std::vector<Stop> stops_;
  std::vector<uint64_t> seen_;
};

}  // namespace tumble::lcp
