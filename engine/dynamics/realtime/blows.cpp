#include "engine/dynamics/realtime/blows.hpp"

#include "engine/dynamics/realtime/joint_lines.hpp"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

template <class F>
bool any_drive(const SolverIsland& island, const F& is) {
  return std::ranges::any_of(island.joints, [&](const JointBlock& joint) {
    return std::ranges::any_of(drives_of(island, joint), is);
  });
}

/// Calls f(block) for all joints and couplings.
template <class F>
void for_blocks(const SolverIsland& island, const F& f) {
  for (JointBlock& joint : island.joints) f(joint);
  for (CoupledJoints& coupled : island.coupled)
    for (CouplingBlock& c : coupled.couplings) f(c);
}

/// Calls f(coupling, the speed along its row).
template <class F>
void for_couplings(const SolverIsland& island, const F& f) {
  for (CoupledJoints& coupled : island.coupled)
    for (size_t k = 0; k < coupled.couplings.size(); ++k)
      f(coupled.couplings[k], speed_along(island, coupled, k));
}

/// Calls f(point, its normal speed) for the points that bounce.
template <class F>
void for_bouncing(const SolverIsland& island, const F& f) {
  for (const ContactRow& row : island.rows)
    for (PointRow& p : island.points.subspan(row.first, row.count)) {
      if (!(p.bounce > 0)) continue;
      const SolverBody &a = island.bodies[row.a], &b = island.bodies[row.b];
      f(p, row.n.dot(b.v + b.w.cross(p.rb) - a.v - a.w.cross(p.ra)));
    }
}

double speed_along(const SolverIsland& island, const JointBlock& joint, uint32_t row) {
  return line_velocity(island.bodies[joint.a], island.bodies[joint.b], joint.lines[row]);
}

void scale(double& now, double before, double share) {
  now = before + share * (now - before);
}
void scale(JointBlock::Values& now, const JointBlock::Values& before, double share) {
  for (size_t i = 0; i < now.size(); ++i) scale(now[i], before[i], share);
}

}  // namespace

bool nears_limit(const SolverIsland& island) {
  return any_drive(island, &DriveRow::nears_limit);
}
bool limit_bounces(const SolverIsland& island) {
  return any_drive(island, &DriveRow::bounces);
}

void put_limits(const SolverIsland& island, double hs) {
  for (const JointBlock& joint : island.joints) {
    const std::span<DriveRow> drives = drives_of(island, joint);
    for (uint32_t k = 0; k < drives.size(); ++k)
      if (drives[k].nears_limit)
        drives[k].put_limits(line_velocity(island.bodies[joint.a], island.bodies[joint.b],
                                           joint.lines[joint.kept + k]),
                             hs);
  }
}

double blow_change(const SolverIsland& island) {
  double most = 0;
  for (const JointBlock& joint : island.joints)
    for (DriveRow& d : drives_of(island, joint)) {
      if (!d.bounces()) continue;
      const double blow = d.shares[DriveRow::lower] + d.shares[DriveRow::upper];
      if (blow != d.blow) most = std::max(most, std::fabs(blow - d.blow) / std::fabs(blow));
      d.blow = blow;
    }
  return most;
}

void remember_impulses(const SolverIsland& island) {
  for_blocks(island, [](auto& block) { block.before_blow = {block.moving, block.relaxing}; });
}
void recall_impulses(const SolverIsland& island) {
  for_blocks(island, [](auto& block) {
    block.moving = block.before_blow.moving;
    block.relaxing = block.before_blow.relaxing;
  });
}

bool bounces(const SolverIsland& island) {
  bool any = false;
  for_bouncing(island, [&any](const PointRow&, double) { any = true; });
  return any;
}

void note_speeds(const SolverIsland& island, double share) {
  for_bouncing(island, [share](PointRow& p, double speed) {
    p.speed_before = speed;
    p.normal_before = share * p.normal;
  });
}
double taken_by_contacts(const SolverIsland& island) {
  double taken = 0;
  for_bouncing(island, [&taken](const PointRow& p, double speed) {
    taken -= 0.5 * (p.normal - p.normal_before) * (p.speed_before + speed);
  });
  return taken;
}

void note_joint_speeds(const SolverIsland& island) {
  for (JointBlock& joint : island.joints) {
    for (uint32_t i = 0; i < joint.count; ++i) joint.speeds[i] = speed_along(island, joint, i);
    for (DriveRow& d : drives_of(island, joint)) d.noted = d.v;
  }
  for_couplings(island, [](CouplingBlock& c, double speed) { c.speed = speed; });
}
double taken_by_joints(const SolverIsland& island, JointPass pass) {
  double taken = 0;
  for (const JointBlock& joint : island.joints) {
    for (uint32_t i = 0; i < joint.kept; ++i)
      taken -= 0.5 * joint.total(i, pass) * (joint.speeds[i] + speed_along(island, joint, i));
    for (uint32_t i = joint.kept; i < joint.count; ++i)
      taken += drives_of(island, joint)[i - joint.kept].taken(joint.speeds[i],
                                                              speed_along(island, joint, i));
  }
  for_couplings(island, [&](const CouplingBlock& c, double speed) {
    taken -= 0.5 * c.total(pass) * (c.speed + speed);
  });
  return taken;
}

void remember_velocities(const SolverIsland& island) {
  for (size_t i = 0; i < island.bodies.size(); ++i) {
    island.motions[i].v_before = island.bodies[i].v;
    island.motions[i].w_before = island.bodies[i].w;
  }
}
void remember_relaxing(const SolverIsland& island) {
  for_blocks(island, [](auto& block) { block.before_bounces = block.relaxing; });
}

BlowEnergy blow_energy(const SolverIsland& island) {
  BlowEnergy energy;
  for_bouncing(island, [&](const PointRow& p, double speed) {
    energy.linear += p.rebound * p.speed_before;
    energy.square += 0.5 * p.rebound * (speed - p.speed_before);
  });
  for (const JointBlock& joint : island.joints) {
    const std::span<const DriveRow> drives = drives_of(island, joint);
    for (uint32_t i = 0; i < joint.count; ++i) {
      const double impulse = joint.relaxing[i] - joint.before_bounces[i];
      const double frame = i < joint.kept ? 0 : drives[i - joint.kept].held_rate();
      energy.linear += impulse * (joint.speeds[i] - frame);
      energy.square += 0.5 * impulse * (speed_along(island, joint, i) - joint.speeds[i]);
    }
    for (const DriveRow& d : drives) {
      const double change = d.v - d.noted;
      energy.linear += d.drive->armature * change * (d.noted - d.held_rate());
      energy.square += 0.5 * d.drive->armature * change * change;
    }
  }
  for_couplings(island, [&energy](const CouplingBlock& c, double speed) {
    const double impulse = c.relaxing - c.before_bounces;
    energy.linear += impulse * c.speed;
    energy.square += 0.5 * impulse * (speed - c.speed);
  });
  return energy;
}

double BlowEnergy::bearable_share(double taken) const {
  taken = std::max(taken, 0.0);
  if (linear + square <= taken || !(square > 0)) return 1;
  return std::min((std::sqrt(linear * linear + 4 * square * taken) - linear) / (2 * square), 1.0);
}

void scale_velocities(const SolverIsland& island, double share) {
  for (size_t i = 0; i < island.bodies.size(); ++i) {
    SolverBody& body = island.bodies[i];
    const SolverMotion& from = island.motions[i];
    body.v = from.v_before + share * (body.v - from.v_before);
    body.w = from.w_before + share * (body.w - from.w_before);
  }
}
void scale_impulses(const SolverIsland& island, double share) {
  for_bouncing(island, [share](PointRow& p, double) {
    p.normal_sum -= (1 - share) * p.rebound;
    p.rebound *= share;
  });
  for_blocks(island, [&](auto& block) { scale(block.relaxing, block.before_bounces, share); });
}

}  // namespace tumble
