#pragma once
#include "engine/math/lcp/pivoting/pivot_state.hpp"
#include "engine/math/lcp/pivoting/pivot_trace.hpp"

namespace tumble::lcp {

/// Drives unknowns of a PivotState one after the other until all conditions hold, with the
/// directions of laterals on the cone's surface fixed: the main part of dantzig() and, with groups,
/// of baraff() ("Fast contact force computation for nonpenetrating rigid bodies", SIGGRAPH 1994, §4
/// to §5), where it is described.
class PivotDriver {
 public:
  /// Records its steps in a trace, if there is one.
  PivotDriver(PivotState& state, int limit, PivotTrace* trace = nullptr)
      : s_(state), limit_(limit), trace_(trace) {}

  /// `solved` when all conditions hold, except that laterals need not be aligned with w. If a
  /// motion is not stopped by anything, sets `ray`: `infeasible` without groups, else `ray`.
  LcpStatus run();
  VecX ray;

 private:
  using Event = PivotEvent;
  struct Stop {
    Event event = Event::none;
    int index = -1;
    double room = 0, rate = 1;
    double step() const { return room / rate; }
  };

  int choose() const;
  LcpStatus correct(int l);
  LcpStatus push_axial(int l);
  LcpStatus drive(int l);
  LcpStatus finish_unblocked(int l, bool flat);
  double change() const;
  void collect(int l, double sign, bool flat);
  void collect_surfaces(const PivotState::Group& g);
  void collect_slacks(int l);
  void offer(Event event, int index, double room, double rate);
  Stop pick() const;
  bool apply(const Stop& stop, int l);
  void meet_surface(int i, PivotState::Group& g);
  bool repeats(int l, double step);
  bool holds();
  void note(int driven, const Stop& stop) const;

  PivotState& s_;
  int limit_;
  PivotTrace* trace_;
  VecX dz_, dw_;
  bool least_index_ = false;  ///< against cycling
  std::vector<Stop> stops_;
  std::vector<uint64_t> seen_;
};

}  // namespace tumble::lcp
