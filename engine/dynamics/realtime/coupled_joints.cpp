// Joints connected by couplings, solved at once in the inner loops of the realtime solver.
#include "engine/dynamics/realtime/coupled_joints.hpp"

#include "engine/core/disjoint_sets.hpp"
#include "engine/dynamics/realtime/joint_lines.hpp"
#include "engine/dynamics/realtime/kept_rows.hpp"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

using Line = CoupledJoints::Line;

auto entries(CoupledJoints& all) {
  return [&all](uint32_t i, uint32_t j) -> double& { return all.factor[i * all.count + j]; };
}

/// Calls f(joint, its row, row of the group) for the kept rows of all joints, then, after the rows
/// of couplings, for those of their coordinates.
template <class F>
void for_joint_rows(const SolverIsland& island, const CoupledJoints& all, const F& f) {
  uint32_t row = 0;
  for (const uint32_t j : all.joints)
    for (uint32_t i = 0; i < island.joints[j].kept; ++i) f(island.joints[j], i, row++);
  row = all.kept;
  for (const uint32_t j : all.joints)
    for (uint32_t i = island.joints[j].kept; i < island.joints[j].count; ++i)
      f(island.joints[j], i, row++);
}
uint32_t first_coupling_row(const CoupledJoints& all) {
  return all.kept - uint32_t(all.couplings.size());
}

JointBlock::Line line_of(const JointRow& row) {
  return {row.row.b.linear, row.row.a.angular, row.row.b.angular, row.error, row.bias};
}

void refresh_coupling(const SolverContext& c, const SolverIsland& island, double now, double hs,
                      CouplingBlock& block) {
  const JointCoupling& coupling = c.couplings[block.source];
  const auto look = [&](uint32_t slot, size_t first, uint32_t coordinate,
                        FollowedCoordinate& followed) {
    const Joint& joint = c.joints[slot];
    const JointSides sides{side_now(c, island, joint.a, block.body[first], joint.frame_a, true),
                           side_now(c, island, joint.b, block.body[first + 1], joint.frame_b, true),
                           joint.length};
    return followed.look(entry_of(joint.kind).coordinates[coordinate], sides, now);
  };
  const CouplingRow row = coupling_row(coupling, look(coupling.a, 0, coupling.x, block.x),
                                       look(coupling.b, 2, coupling.y, block.y));
  block.lines = {line_of(row.of_x), line_of(row.of_y)};
  block.error = row.error();
  const auto share = [&](size_t first) {
    return followed_share(island.bodies[block.body[first]], island.bodies[block.body[first + 1]],
                          hs);
  };
  block.bias = std::min(share(0), share(2)) * row.bias();
}

void set_lines(const SolverIsland& island, CoupledJoints& all) {
  all.lines.assign(all.count, {});
  for_joint_rows(island, all, [&](const JointBlock& joint, uint32_t i, uint32_t row) {
    add_ends(all.lines[row], joint.a, joint.b, joint.lines[i]);
  });
  for (uint32_t k = 0; k < all.couplings.size(); ++k) {
    const CouplingBlock& c = all.couplings[k];
    Line& line = all.lines[first_coupling_row(all) + k];
    add_ends(line, c.body[0], c.body[1], c.lines[0]);
    add_ends(line, c.body[2], c.body[3], c.lines[1]);
  }
}

/// Sets the compliances of coordinates from the factor.
void set_compliances(const SolverIsland& island, CoupledJoints& all) {
  for_joint_rows(island, all, [&](const JointBlock& joint, uint32_t i, uint32_t row) {
    if (i >= joint.kept)
      drives_of(island, joint)[i - joint.kept].mass = all.factor[row * all.count + row];
  });
}

double& impulse_of(CouplingBlock& c, JointPass pass) {
  if (pass == JointPass::relaxing) return c.relaxing;
  return pass == JointPass::moving ? c.moving : c.correcting;
}

}  // namespace

std::vector<CoupledJoints> couple_joints(std::span<JointBlock> joints,
                                         std::span<const CouplingBlock> couplings) {
  DisjointSets sets(joints.size());
  for (const CouplingBlock& c : couplings)
    if (c.block[0] != CouplingBlock::none && c.block[1] != CouplingBlock::none)
      sets.join(c.block[0], c.block[1]);
  const auto set_of = [&](const CouplingBlock& c) {
    return sets.root(c.block[0] != CouplingBlock::none ? c.block[0] : c.block[1]);
  };
  for (const CouplingBlock& c : couplings) joints[set_of(c)].coupled = true;
  std::vector<CoupledJoints> out;
  std::vector<uint32_t> place(joints.size(), CouplingBlock::none);
  for (uint32_t j = 0; j < joints.size(); ++j) {
    const uint32_t root = sets.root(j);
    joints[j].coupled = joints[root].coupled;
    if (!joints[j].coupled) continue;
    if (root == j) {
      place[j] = uint32_t(out.size());
      out.emplace_back();
    }
    CoupledJoints& all = out[place[root]];
    all.joints.push_back(j);
    all.kept += joints[j].kept;
    all.count += joints[j].count;
  }
  for (const CouplingBlock& c : couplings) {
    CoupledJoints& all = out[place[set_of(c)]];
    all.couplings.push_back(c);
    ++all.kept;
    ++all.count;
  }
  return out;
}

void prepare_couplings(const SolverContext& c, const SolverIsland& island, double hs) {
  for (CoupledJoints& all : island.coupled) {
    all.now = 0;
    for (CouplingBlock& block : all.couplings) {
      const JointCoupling& from = c.couplings[block.source];
      const Joint &a = c.joints[from.a], &b = c.joints[from.b];
      block.moving = hs * from.moving_force;
      block.relaxing = hs * from.relaxing_force;
      block.x = {a.value[from.x], a.rate[from.x], 0};
      block.y = {b.value[from.y], b.rate[from.y], 0};
    }
  }
}

void refresh_couplings(const SolverContext& c, const SolverIsland& island, double hs) {
  for (CoupledJoints& all : island.coupled) {
    for (CouplingBlock& block : all.couplings) refresh_coupling(c, island, all.now, hs, block);
    set_lines(island, all);
    all.factor.resize(size_t(all.count) * all.count);
    const auto k = entries(all);
    for (uint32_t i = 0; i < all.count; ++i)
      for (uint32_t j = 0; j <= i; ++j) k(i, j) = line_product(island, all.lines[i], all.lines[j]);
    all.scaled.resize(all.count);
    factorise_kept(k, all.kept, all.count, all.scaled);
    set_compliances(island, all);
  }
}

void soften_couplings(const SolverIsland& island, double give) {
  for (CoupledJoints& all : island.coupled) {
    soften_kept(entries(all), all.kept, all.count, give);
    set_compliances(island, all);
  }
}

void warm_start_couplings(const SolverIsland& island, double hs, JointPass pass) {
  for (CoupledJoints& all : island.coupled)
    for (uint32_t k = 0; k < all.couplings.size(); ++k) {
      double& impulse = impulse_of(all.couplings[k], pass);
      if (pass == JointPass::moving) all.couplings[k].correcting = 0;
      const Line& line = all.lines[first_coupling_row(all) + k];
      for (uint32_t end = 0; end < line.ends; ++end)
        if (turns_away(island.bodies[line.body[end]], impulse * line.angular[end], hs)) impulse = 0;
      push_line(island, line, impulse);
    }
}

void solve_coupled(const SolverIsland& island, double hs, JointPass pass, CoupledJoints& all) {
  const auto k = entries(all);
  std::vector<double>& change = all.change;
  change.resize(all.count);
  for (uint32_t i = 0; i < all.count; ++i) change[i] = line_velocity(island, all.lines[i]);
  std::vector<double*>& impulses = all.impulses;
  std::vector<DriveRow*>& drives = all.drives;
  impulses.resize(all.count);
  drives.resize(all.count);
  const auto keep = [&](uint32_t row, double error, double bias, double& impulse) {
    change[row] = kept_velocity(change[row], error, bias, hs, island.joint_softness, pass);
    impulses[row] = &impulse;
  };
  for_joint_rows(island, all, [&](JointBlock& joint, uint32_t i, uint32_t row) {
    if (i < joint.kept)
      return keep(row, joint.lines[i].error, joint.lines[i].bias, joint.impulse(i, pass));
    impulses[row] = &joint.impulse(i, pass);
    drives[row] = &drives_of(island, joint)[i - joint.kept];
  });
  for (uint32_t i = 0; i < all.couplings.size(); ++i) {
    CouplingBlock& c = all.couplings[i];
    keep(first_coupling_row(all) + i, c.error, c.bias, impulse_of(c, pass));
  }
  eliminate_kept(k, all.kept, all.count, change);
  if (all.count > all.kept) {
    all.laws.resize(all.count);
    if (pass == JointPass::correcting)
      leave_of_soft(
          k, all.kept, all.count, island.joint_softness.impulse_scale,
          [&impulses](uint32_t i) { return *impulses[i]; }, change);
    solve_laws(
        k, all.kept, all.count,
        [&drives](uint32_t i, double free) { return drives[i]->solve(free); },
        [&impulses](uint32_t i) { return *impulses[i]; }, all.laws, change);
  }
  substitute_kept(k, all.kept, all.count, change);
  for (uint32_t i = 0; i < all.count; ++i) {
    const double by = i < all.kept
                          ? kept_change(change[i], *impulses[i], island.joint_softness, pass)
                          : -change[i];
    *impulses[i] += by;
    push_line(island, all.lines[i], by);
  }
}

void sum_couplings(const SolverIsland& island, double hs, JointPass pass) {
  for (CoupledJoints& all : island.coupled) {
    for (CouplingBlock& c : all.couplings) {
      const double impulse = c.total(pass);
      for (size_t half = 0; half < 2; ++half) {
        if (c.block[half] == CouplingBlock::none) continue;
        const JointBlock::Line& line = c.lines[half];
        island.joints[c.block[half]].add(push_of(line, impulse));
      }
    }
    if (pass == JointPass::moving) all.now += hs;
  }
}

double speed_along(const SolverIsland& island, const CoupledJoints& all, size_t coupling) {
  return line_velocity(island, all.lines[first_coupling_row(all) + coupling]);
}

double store_couplings(const SolverContext& c, const SolverIsland& island, double hs) {
  double residual = 0;
  for (CoupledJoints& all : island.coupled)
    for (uint32_t k = 0; k < all.couplings.size(); ++k) {
      const CouplingBlock& block = all.couplings[k];
      JointCoupling& to = c.couplings[block.source];
      to.moving_force = block.moving / hs;
      to.relaxing_force = block.relaxing / hs;
      if (block.block[0] != CouplingBlock::none) c.joints[to.a].value[to.x] = block.x.value;
      if (block.block[1] != CouplingBlock::none) c.joints[to.b].value[to.y] = block.y.value;
      residual = std::max(residual, std::fabs(speed_along(island, all, k)));
    }
  return residual;
}

}  // namespace tumble
