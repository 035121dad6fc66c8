#pragma once
#include "engine/math/lcp/pivoting/pivot_state.hpp"

#include <limits>

namespace tumble::lcp {

/// Drives unknowns of a PivotState one after the other until every w has the right sign (the main
/// part of dantzig(), which says how).
class BoundDriver {
 public:
  BoundDriver(PivotState& state, int limit)
      : s_(state),
        p_(state.problem),
        limit_(limit),
        y_(size_t(p_.n)),
        dz_(size_t(p_.n)),
        dw_(size_t(p_.n)) {}

  LcpStatus run(VecX& ray);

 private:
  /// What stops the motion of the driven unknown.
  struct Stop {
    enum Kind { none, driven_w, driven_bound, clamped_bound, other_w } kind = none;
    double step = std::numeric_limits<double>::infinity();
    int index = -1;  // unknown; for clamped_bound its position among the members
  };
  int choose() const;
  LcpStatus drive(int l, VecX& ray);
  void find_direction(int l, double sign);
  bool changes_nothing(int l) const;
  Stop find_stop(int l, double sign, bool flat);
  void offer(Stop::Kind kind, int index, double room, double rate);
  Stop pick() const;
  void move(int l, double sign, const Stop& stop, bool flat);
  bool repeats(int l, double step);
  LcpStatus blame() const;
  LcpStatus finish_unblocked(int l, double sign, VecX& ray);

  struct Candidate {
    Stop::Kind kind;
    int index;
    double room, rate;
  };

  PivotState& s_;
  const ScaledProblem& p_;
  int limit_;
  std::vector<double> y_, dz_, dw_;
  double remainder_ = 0;
  bool least_index_ = false;
  std::vector<uint64_t> seen_;
  std::vector<Candidate> candidates_;
};

}  // namespace tumble::lcp
