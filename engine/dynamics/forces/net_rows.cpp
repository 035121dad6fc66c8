#include "engine/dynamics/forces/net_rows.hpp"

#include "engine/dynamics/forces/tolerances.hpp"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

/// -(change of the moment r x F) of an end per turn of the node, across the arm: its largest value
/// over the axes of turning, |r| |F| cos^2(phi/2) with phi the angle between both, so that it is
/// never negative.
double turning_stiffness(const Vec3& arm, const Vec3& force) {
  return 0.5 * (arm.dot(force) + arm.norm() * force.norm());
}

/// Stiffness of the ties and stencils at each node, over its mass: with weights, sums of rows.
void sum_stiffness(const SpringNet& net, std::vector<double>& stiffness) {
  stiffness.assign(net.nodes.size(), 0);
  for (const SpringNet::Tie& tie : net.ties)
    for (const SpringNet::End* end : {&tie.a, &tie.b})
      if (end->node != SpringNet::fixed) stiffness[end->node] += tie.stiffness * end->mobility;
  for (const SpringNet::Stencil& s : net.stencils)
    for (uint32_t i = 0; i < s.count; ++i)
      if (s.end[i].node != SpringNet::fixed)
        stiffness[s.end[i].node] += s.stiffness * std::fabs(s.weight[i]) * s.end[i].mobility;
}

/// What is taken of a stiffness, and what of that the step does not resolve.
struct Taken {
  double k, unresolved;
};
Taken taken(double stiffness, double z) {
  const double k = stiffness * std::min(1.0, tolerances::stiffest_spring / z);
  return {k, k * (1 - 1 / std::max(1.0, std::min(z, tolerances::stiffest_spring)))};
}

}  // namespace

void prepare_rows(const SpringNet& net, std::vector<NetRow>& rows, std::vector<double>& stiffness) {
  const double h2 = net.h * net.h;
  rows.assign(net.ties.size(), {});
  sum_stiffness(net, stiffness);
  for (size_t i = 0; i < rows.size(); ++i) {
    const SpringNet::Tie& tie = net.ties[i];
    NetRow& row = rows[i];
    const double length = tie.d.norm();
    if (!(length > 0)) {
      row.n = row.pull = Vec3::Zero();
      continue;
    }
    row.n = tie.d / length;
    double z = 0;
    for (const SpringNet::End* end : {&tie.a, &tie.b})
      if (end->node != SpringNet::fixed) z += h2 * stiffness[end->node];
    const auto [k, unresolved] = taken(tie.stiffness, z);
    const double across = std::max(0.0, 1 - tie.rest_length / length);
    const double rate = row.n.dot(tie.dv);
    const double damping = tie.damping + net.ease * net.h * unresolved;
    row.pull = (k * (length - tie.rest_length) + damping * rate) * row.n;
    if (unresolved > 0) {
      const Vec3 ahead = (net.h - net.lead) * tie.dv;
      row.pull += unresolved * (across * ahead + ((1 - across) * row.n.dot(ahead)) * row.n);
      row.turn_a = unresolved / k * turning_stiffness(tie.a.arm, row.pull);
      row.turn_b = unresolved / k * turning_stiffness(tie.b.arm, -row.pull);
    }
    row.along = net.h * damping + h2 * unresolved;
    row.across = h2 * unresolved * across;
  }
}

void prepare_bows(const SpringNet& net, const std::vector<double>& stiffness,
                  std::vector<NetBow>& bows) {
  const double h2 = net.h * net.h;
  bows.resize(net.stencils.size());
  for (size_t i = 0; i < bows.size(); ++i) {
    const SpringNet::Stencil& s = net.stencils[i];
    double z = 0;
    for (uint32_t k = 0; k < s.count; ++k)
      if (s.end[k].node != SpringNet::fixed)
        z += h2 * std::fabs(s.weight[k]) * stiffness[s.end[k].node];
    const auto [k, unresolved] = taken(s.stiffness, z);
    const double length = s.q.norm();
    bows[i].n = length > 0 ? Vec3(s.q / length) : Vec3(Vec3::Zero());
    const double ease = net.ease * net.h * unresolved;
    bows[i].pull = k * s.q + (s.damping * bows[i].n.dot(s.dq)) * bows[i].n +
                   (unresolved * (net.h - net.lead) + ease) * s.dq;
    bows[i].e = h2 * unresolved + net.h * ease;
    bows[i].along = net.h * s.damping;
  }
}

}  // namespace tumble
