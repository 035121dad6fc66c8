#include "engine/scene/workloads/end_state.hpp"

#include "engine/scene/workloads/solid_depth.hpp"
#include "engine/scene/workloads/tori_overlaps.hpp"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

bool may_collide(const RigidBody& a, const RigidBody& b) {
  return (a.dynamic() || b.dynamic()) && (a.group == 0 || a.group != b.group);
}

/// A shape of a body, in the world.
struct PlacedSolid {
  MeasuredSolid solid;
  size_t body;
};

std::vector<PlacedSolid> place_solids(std::span<const RigidBody> bodies) {
  std::vector<PlacedSolid> out;
  for (size_t i = 0; i < bodies.size(); ++i) {
    if (has_escaped(bodies[i])) continue;
    for (const BodyShape& s : bodies[i].shapes)
      out.push_back({measured_solid(*s.shape, bodies[i].pose * s.pose), i});
  }
  std::sort(out.begin(), out.end(), [](const PlacedSolid& a, const PlacedSolid& b) {
    return a.solid.bounds.min.x() < b.solid.bounds.min.x();
  });
  return out;
}

double joint_gap(const Workload& w, std::span<const RigidBody> bodies) {
  double most = 0;
  for (const WorkloadJoint& j : w.joints) {
    const auto anchor = [&](size_t i) {
      return bodies[i].body_frame().point(w.bodies[i].pose.inverse_point(j.frame.x));
    };
    most = std::max(most, (anchor(j.a) - anchor(j.b)).norm());
  }
  return most;
}

}  // namespace

bool has_escaped(const RigidBody& b) {
  const bool near = b.pose.x.allFinite() && b.pose.x.cwiseAbs().maxCoeff() < 1e4;
  return b.dynamic() && !(near && b.pose.x.y() > -20);
}

void OverlapDepths::add(double depth) {
  if (!(depth > 1e-6)) return;
  deepest = std::max(deepest, depth);
  sum += depth;
  ++pairs;
}

OverlapDepths measure_overlaps(const Workload& w, std::span<const RigidBody> bodies) {
  if (!w.collides) return {};
  if (w.tori) return tori_overlaps(*w.tori, bodies);
  OverlapDepths out;
  const std::vector<PlacedSolid> solids = place_solids(bodies);
  for (size_t i = 0; i < solids.size(); ++i) {
    const auto& [a, body_a] = solids[i];
    for (size_t j = i + 1; j < solids.size(); ++j) {
      const auto& [b, body_b] = solids[j];
      if (b.bounds.min.x() > a.bounds.max.x()) break;
      if (body_a == body_b || !a.bounds.overlaps(b.bounds)) continue;
      if (may_collide(bodies[body_a], bodies[body_b])) out.add(solid_depth(a, b));
    }
  }
  return out;
}

EndState measure_end_state(const Workload& w, std::span<const RigidBody> bodies) {
  EndState out;
  for (const RigidBody& b : bodies) {
    if (!b.dynamic()) continue;
    if (has_escaped(b)) {
      ++out.escaped;
      continue;
    }
    out.kinetic_energy += b.kinetic_energy();
    out.fastest = std::max(out.fastest, b.v.norm());
  }
  out.overlap = measure_overlaps(w, bodies);
  out.joint_gap = joint_gap(w, bodies);
  return out;
}

std::vector<RigidBody> bodies_at_start(const Workload& w) {
  std::vector<RigidBody> out;
  for (const BodyDef& def : w.bodies) out.push_back(make_body(def).value());
  return out;
}

}  // namespace tumble
