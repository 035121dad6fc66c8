#pragma once
#include "engine/dynamics/event/certify.hpp"
#include "engine/math/lcp/pivoting/pivot_trace.hpp"
#include "engine/world/microscope/sketch.hpp"

#include <string>
#include <vector>

namespace tumble {

/// Readable names of the unknowns of a problem of contact forces.
struct PivotNames {
  struct Unknown {
    int point = -1;        ///< index of the contact point; -1: a row of a joint, or a torque
    bool lateral = false;  ///< friction
    std::string text;      ///< "normal force of contact 3"
  };
  std::vector<Unknown> unknowns;

  /// `kept`: indices of the unknowns of the posed problem that are in the recorded one.
  PivotNames(const GroupForceProblem& posed, const std::vector<Eigen::Index>& kept);
  const std::string& operator[](int i) const { return unknowns[size_t(i)].text; }
};

Ink ink_of(lcp::PivotSet set);

/// "the normal force of contact 3 has come to 0, and the contact opens".
std::string event_text(const lcp::PivotStep& step, const PivotNames& names);
/// What the method does at this step and why, for people who see it for the first time.
std::string pivot_caption(const lcp::PivotStep& step, const PivotNames& names, double unit_step);

/// A bar for each unknown, forces upwards and accelerations downwards, in the colours of the sets.
Diagram pivot_bars(const lcp::PivotStep& step, const PivotNames& names, const lcp::VecX& w,
                   double z_most, double w_most);

}  // namespace tumble
