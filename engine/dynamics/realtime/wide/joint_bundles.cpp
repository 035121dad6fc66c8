#include "engine/dynamics/realtime/wide/joint_bundles.hpp"

#include "engine/dynamics/realtime/tolerances.hpp"
#include "engine/dynamics/realtime/wide/lane_values.hpp"

#include <algorithm>

namespace tumble {
namespace {

bool is_hinge(const Joint& joint) {
  return joint.kind == JointKind::revolute;
}

bool moves(std::span<const RigidBody> bodies, uint32_t slot) {
  return slot != no_body && bodies[slot].dynamic();
}

/// Upper bound on the mobility of an anchor by rotation of its body [1/kg].
double turning(std::span<const RigidBody> bodies, uint32_t slot, const Pose& frame) {
  return moves(bodies, slot) ? frame.x.squaredNorm() * bodies[slot].inverse_inertia_body.trace()
                             : 0;
}

double inverse_mass(std::span<const RigidBody> bodies, uint32_t slot) {
  return moves(bodies, slot) ? bodies[slot].inverse_mass : 0;
}

bool turns(std::span<const RigidBody> bodies, uint32_t slot) {
  return slot != no_body && bodies[slot].type != BodyType::fixed;
}

/// Where an anchor is: all that a ball joint needs of its ends.
struct AnchorNow {
  Vec3 arm, at;
};

AnchorNow anchor_now(std::span<const RigidBody> bodies, uint32_t slot, const Pose& frame) {
  if (slot == no_body) return {frame.x, frame.x};
  const Pose& pose = bodies[slot].pose;
  const Vec3 arm = pose.direction(frame.x);
  return {arm, pose.x + arm};
}

/// The axes of the joint's frame on a body, as columns.
Mat3 axes_now(std::span<const RigidBody> bodies, uint32_t slot, const Pose& frame) {
  const Quat q = slot == no_body ? frame.q : bodies[slot].pose.q * frame.q;
  return q.toRotationMatrix();
}

void stage_joint(const SolverContext& c, const Joint& from, size_t lane, double hs, WideJoint& out,
                 WideHinge* hinge) {
  const AnchorNow a = anchor_now(c.bodies, from.a, from.frame_a);
  const AnchorNow b = anchor_now(c.bodies, from.b, from.frame_b);
  const Vec3 none = Vec3::Zero();
  put_floats(out.at_a, lane, turns(c.bodies, from.a) ? a.arm : none);
  put_floats(out.at_b, lane, turns(c.bodies, from.b) ? b.arm : none);
  put_floats(out.apart, lane, b.at - a.at);
  for (size_t k = 0; k < 3; ++k) {
    out.moving[k][lane] = float(hs * from.moving_force[k]);
    out.relaxing[k][lane] = float(hs * from.relaxing_force[k]);
  }
  if (!hinge) return;
  const Mat3 axes_a = axes_now(c.bodies, from.a, from.frame_a);
  const Mat3 axes_b = axes_now(c.bodies, from.b, from.frame_b);
  put_floats(hinge->x_a, lane, axes_a.col(0));
  put_floats(hinge->y_a, lane, axes_a.col(1));
  put_floats(hinge->z_b, lane, axes_b.col(2));
  for (size_t k = 0; k < 2; ++k) {
    hinge->moving[k][lane] = float(hs * from.moving_force[3 + k]);
    hinge->relaxing[k][lane] = float(hs * from.relaxing_force[3 + k]);
  }
}

/// Fills in a lane without a joint, which connects the fixed body with itself.
void stage_nothing(size_t lane, uint32_t fixed, WideJoint& out, WideHinge* hinge) {
  out.a[lane] = out.b[lane] = fixed;
  out.source[lane] = no_body;
  for (LaneVec* v : {&out.at_a, &out.at_b, &out.apart, &out.moving, &out.relaxing})
    put_floats(*v, lane, Vec3::Zero());
  if (!hinge) return;
  for (LaneVec* v : {&hinge->x_a, &hinge->y_a, &hinge->z_b}) put_floats(*v, lane, Vec3::Zero());
  for (size_t k = 0; k < 2; ++k) hinge->moving[k][lane] = hinge->relaxing[k][lane] = 0;
}

}  // namespace

bool JointBundles::takes(const Joint& joint, std::span<const RigidBody> bodies) {
  if (joint.drives || (joint.kind != JointKind::spherical && !is_hinge(joint))) return false;
  const double turns =
      turning(bodies, joint.a, joint.frame_a) + turning(bodies, joint.b, joint.frame_b);
  return turns < tolerances::single_precision_arm *
                     (inverse_mass(bodies, joint.a) + inverse_mass(bodies, joint.b));
}

void JointBundles::clear() {
  added_.clear();
  edges_.clear();
  by_colour_.clear();
  bundles_.clear();
  colours_.clear();
  left_over_.clear();
  hinges_ = 0;
}

void JointBundles::add(const SolverContext& c, uint32_t source, uint32_t a, uint32_t b) {
  const Joint& joint = c.joints[source];
  added_.push_back({source, a, b});
  edges_.push_back({moves(c.bodies, joint.a) ? a : ColourEdge::fixed,
                    moves(c.bodies, joint.b) ? b : ColourEdge::fixed});
}

void JointBundles::add_bundles(uint32_t first, uint32_t end, bool hinges) {
  for (uint32_t i = first; i < end; i += uint32_t(wide_lanes))
    bundles_.push_back(
        {i, std::min(uint32_t(wide_lanes), end - i), hinges ? hinges_++ : WideJoint::no_hinge});
}

std::span<const uint32_t> JointBundles::bundle(const SolverContext& c, uint32_t bodies) {
  colouring_.assign(edges_, bodies);
  for (uint32_t colour = 0; colour < colouring_.colours(); ++colour) {
    const auto begin = uint32_t(bundles_.size());
    for (const bool hinges : {false, true}) {
      const auto first = uint32_t(by_colour_.size());
      for (const uint32_t edge : colouring_.of(colour))
        if (is_hinge(c.joints[added_[edge].source]) == hinges) by_colour_.push_back(edge);
      add_bundles(first, uint32_t(by_colour_.size()), hinges);
    }
    colours_.push_back({begin, uint32_t(bundles_.size())});
  }
  for (const uint32_t edge : colouring_.left_over()) left_over_.push_back(added_[edge].source);
  return left_over_;
}

void JointBundles::resize(WideRows& rows) const {
  rows.joints.resize(bundles_.size());
  rows.hinges.resize(hinges_);
}

void JointBundles::stage_bundle(const SolverContext& c, const Bundle& bundle, uint32_t fixed,
                                double hs, std::span<const WideMass> masses, WideJoint& out,
                                WideHinge* hinge) const {
  out.hinge = bundle.hinge;
  out.lanes = bundle.lanes;
  out.writes_a = out.writes_b = 0;
  out.any_uneven = false;
  out.uneven = {};
  out.impulse = out.moment_a = out.moment_b = {};
  if (hinge) hinge->twist = {};
  for (size_t lane = 0; lane < wide_lanes; ++lane) {
    if (lane >= bundle.lanes) {
      stage_nothing(lane, fixed, out, hinge);
      continue;
    }
    const Added& added = added_[by_colour_[bundle.first + lane]];
    const Joint& from = c.joints[added.source];
    out.source[lane] = added.source;
    out.a[lane] = added.a;
    out.b[lane] = added.b;
    if (moves(c.bodies, from.a)) out.writes_a = uint16_t(out.writes_a | 1u << lane);
    if (moves(c.bodies, from.b)) out.writes_b = uint16_t(out.writes_b | 1u << lane);
    out.uneven[lane] = masses[added.a].uneven + masses[added.b].uneven;
    out.any_uneven = out.any_uneven || out.uneven[lane] > 0;
    stage_joint(c, from, lane, hs, out, hinge);
  }
}

void JointBundles::stage(const SolverContext& c, WideRange bundles, uint32_t fixed, double hs,
                         WideRows& rows) const {
  for (uint32_t i = bundles.begin; i < bundles.end; ++i) {
    const Bundle& bundle = bundles_[i];
    stage_bundle(c, bundle, fixed, hs, rows.masses, rows.joints[i],
                 bundle.hinge == WideJoint::no_hinge ? nullptr : &rows.hinges[bundle.hinge]);
  }
}

void JointBundles::store(const SolverContext& c, WideRange bundles, double hs,
                         const WideRows& rows) const {
  const double rate = 1 / hs;
  for (uint32_t i = bundles.begin; i < bundles.end; ++i) {
    const WideJoint& from = rows.joints[i];
    for (uint32_t lane = 0; lane < from.lanes; ++lane) {
      Joint& to = c.joints[from.source[lane]];
      if (!c.joint_pushes.empty())
        c.joint_pushes[from.source[lane]] = {doubles_of(from.impulse, lane),
                                             doubles_of(from.moment_a, lane),
                                             doubles_of(from.moment_b, lane)};
      for (size_t k = 0; k < 3; ++k) {
        to.moving_force[k] = rate * double(from.moving[k][lane]);
        to.relaxing_force[k] = rate * double(from.relaxing[k][lane]);
      }
      if (from.hinge == WideJoint::no_hinge) continue;
      const WideHinge& hinge = rows.hinges[from.hinge];
      if (!c.joint_pushes.empty())
        c.joint_pushes[from.source[lane]].twist = doubles_of(hinge.twist, lane);
      for (size_t k = 0; k < 2; ++k) {
        to.moving_force[3 + k] = rate * double(hinge.moving[k][lane]);
        to.relaxing_force[3 + k] = rate * double(hinge.relaxing[k][lane]);
      }
    }
  }
}

}  // namespace tumble
