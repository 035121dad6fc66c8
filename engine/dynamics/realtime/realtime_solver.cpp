#include "engine/dynamics/realtime/realtime_solver.hpp"

#include "engine/core/chunks.hpp"
#include "engine/dynamics/realtime/integrate_bodies.hpp"
#include "engine/dynamics/realtime/solve_island.hpp"
#include "engine/dynamics/realtime/solve_joints.hpp"
#include "engine/dynamics/realtime/solve_plan.hpp"
#include "engine/dynamics/realtime/solver_rows.hpp"
#include "engine/dynamics/realtime/wide/wide_island.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <vector>

#include <fmt/format.h>

namespace tumble {

/// Memory that is reused from step to step; each island owns a range of every array. Ordinary
/// islands with contacts or joints are in `wide` and own nothing here.
struct RealtimeSolver::Scratch {
  struct Range {
    uint32_t begin = 0, end = 0;
  };
  struct Layout {
    Range bodies, rows, points, joints, drives, coupled, springs, spring_turns;
  };
  SolvePlans plans;
  WideIsland wide;
  std::vector<Layout> layouts;
  std::vector<SolverBody> bodies;
  std::vector<SolverMotion> motions;
  std::vector<ContactRow> rows;
  std::vector<PointRow> points;
  std::vector<JointBlock> joints;
  std::vector<DriveRow> drives;
  std::vector<CoupledJoints> coupled;
  std::vector<SpringRow> springs;
  std::vector<SpringTurn> spring_turns;
  std::vector<JointPush> joint_pushes;
  std::vector<uint8_t> begun;             ///< by joint: whether it was solved in this tick
  std::vector<SolveResiduals> residuals;  ///< by island
  std::vector<uint32_t>
      local;  ///< by body slot: its solver body in the island being laid out, else no_slot

  void lay_out(const SolverContext& context, const IslandSet& islands);

 private:
  uint32_t add_body(uint32_t slot);
  template <class Find>
  void add_couplings(const SolverContext& context, uint32_t island, const Layout& layout,
                     const Find& find);
  void lay_out_island(const SolverContext& context, const IslandSet& islands, const Island& island,
                      const Layout& layout);
};

namespace {

constexpr uint32_t no_slot = ~uint32_t{0};

template <class T, class Range>
std::span<T> part(std::vector<T>& all, Range r) {
  return std::span<T>(all).subspan(r.begin, r.end - r.begin);
}

}  // namespace

uint32_t RealtimeSolver::Scratch::add_body(uint32_t slot) {
  bodies.emplace_back();
  motions.emplace_back();
  motions.back().slot = slot;
  return uint32_t(bodies.size() - 1);
}

/// Adds the couplings of an island, whose joints must have been added.
template <class Find>
void RealtimeSolver::Scratch::add_couplings(const SolverContext& context, uint32_t island,
                                            const Layout& layout, const Find& find) {
  const std::span<JointBlock> blocks = std::span(joints).subspan(layout.joints.begin);
  const auto block_of = [&](uint32_t joint) {
    const auto at = std::ranges::find(blocks, joint, &JointBlock::source);
    return at == blocks.end() ? CouplingBlock::none : uint32_t(at - blocks.begin());
  };
  std::vector<CouplingBlock> tied;
  for (const uint32_t k : plans.couplings(island)) {
    const JointCoupling& c = context.couplings[k];
    const Joint &a = context.joints[c.a], &b = context.joints[c.b];
    CouplingBlock& block = tied.emplace_back();
    block.source = k;
    block.body = {find(a.a), find(a.b), find(b.a), find(b.b)};
    block.block = {block_of(c.a), block_of(c.b)};
  }
  for (CoupledJoints& all : couple_joints(blocks, tied)) coupled.push_back(std::move(all));
}

void RealtimeSolver::Scratch::lay_out_island(const SolverContext& context, const IslandSet& islands,
                                             const Island& island, const Layout& layout) {
  const uint32_t base = layout.bodies.begin;
  for (uint32_t k = island.body_begin; k < island.body_end; ++k) {
    local[islands.bodies[k]] = add_body(islands.bodies[k]);
  }
  const uint32_t fixed = add_body(no_slot);
  const auto find = [&](uint32_t slot) {
    if (slot == no_body || context.bodies[slot].type == BodyType::fixed) return fixed - base;
    // kinematic body that occurs for the first time
    if (local[slot] == no_slot) local[slot] = add_body(slot);
    return local[slot] - base;
  };
  for (uint32_t k = island.contact_begin; k < island.contact_end; ++k) {
    const Contact& c = context.contacts[islands.contacts[k]];
    ContactRow& row = rows.emplace_back();
    row.source = islands.contacts[k];
    row.a = find(c.key.body_a);
    row.b = find(c.key.body_b);
    row.first = uint32_t(points.size()) - layout.points.begin;
    row.count = uint32_t(c.count);
    points.resize(points.size() + size_t(c.count));
  }
  for (uint32_t k = island.joint_begin; k < island.joint_end; ++k) {
    JointBlock& joint = joints.emplace_back();
    joint.source = islands.joints[k];
    joint.a = find(context.joints[joint.source].a);
    joint.b = find(context.joints[joint.source].b);
    add_drives(context.joints[joint.source], layout.drives.begin, joint, drives);
    motions[base + joint.a].jointed = motions[base + joint.b].jointed = true;
  }
  const auto index = uint32_t(&island - islands.islands.data());
  for (const uint32_t k : plans.springs(index)) {
    const SolvedSpring& spring = context.springs[k];
    SpringRow& row = springs.emplace_back();
    row.source = k;
    row.count = spring.count;
    for (uint32_t i = 0; i < spring.count; ++i) {
      const SolvedSpring::End& end = spring.end[i];
      row.body[i] = find(end.slot);
      row.weight[i] = end.weight;
      if (end.slot != no_body && !end.point.isZero(0) &&
          context.bodies[end.slot].type != BodyType::fixed)
        row.turns = uint32_t(spring_turns.size()) - layout.spring_turns.begin;
    }
    if (row.turns != SpringRow::none) spring_turns.emplace_back();
  }
  if (!plans.couplings(index).empty()) add_couplings(context, index, layout, find);
  for (uint32_t k = base; k < bodies.size(); ++k) {
    if (motions[k].slot != no_slot) local[motions[k].slot] = no_slot;
  }
}

void RealtimeSolver::Scratch::lay_out(const SolverContext& context, const IslandSet& islands) {
  layouts.clear();
  bodies.clear();
  motions.clear();
  rows.clear();
  points.clear();
  joints.clear();
  drives.clear();
  coupled.clear();
  springs.clear();
  spring_turns.clear();
  local.resize(context.bodies.size(), no_slot);
  for (uint32_t i = 0; i < islands.islands.size(); ++i) {
    const Island& island = islands.islands[i];
    const bool touches = island.contact_begin < island.contact_end;
    const bool tied = island.joint_begin < island.joint_end || !plans.springs(i).empty();
    Layout& layout = layouts.emplace_back();
    layout.bodies.begin = uint32_t(bodies.size());
    layout.rows.begin = uint32_t(rows.size());
    layout.points.begin = uint32_t(points.size());
    layout.joints.begin = uint32_t(joints.size());
    layout.drives.begin = uint32_t(drives.size());
    layout.coupled.begin = uint32_t(coupled.size());
    layout.springs.begin = uint32_t(springs.size());
    layout.spring_turns.begin = uint32_t(spring_turns.size());
    if (!plans.plans()[i].wide && (touches || tied))
      lay_out_island(context, islands, island, layout);
    layout.bodies.end = uint32_t(bodies.size());
    layout.rows.end = uint32_t(rows.size());
    layout.points.end = uint32_t(points.size());
    layout.joints.end = uint32_t(joints.size());
    layout.drives.end = uint32_t(drives.size());
    layout.coupled.end = uint32_t(coupled.size());
    layout.springs.end = uint32_t(springs.size());
    layout.spring_turns.end = uint32_t(spring_turns.size());
  }
  residuals.assign(layouts.size(), {});
}

namespace {

/// Discards the impulses of the last tick in which a joint of these islands was solved, where this
/// one has not been solved in the present tick. A joint may be solved in later parts of a tick
/// only, if a body of it wakes there.
void begin_joints(const SolverContext& c, const IslandSet& islands, std::span<uint8_t> begun) {
  for (const uint32_t k : islands.joints) {
    if (begun[k]) continue;
    begun[k] = 1;
    c.joints[k].impulse = {};
    c.joints[k].motor_impulse.fill(0);
  }
}

/// Adds up the impulses of the islands' joints over the tick so far, and updates the values of
/// their coordinates after `c.h`.
void follow_joints(const SolverContext& c, const IslandSet& islands, Crew& crew) {
  const std::span<const uint32_t> which = islands.joints;
  for_chunks(&crew, which.size(), [&](size_t, size_t first, size_t last) {
    for (const uint32_t k : which.subspan(first, last - first)) {
      Joint& joint = c.joints[k];
      joint.impulse.force += c.joint_pushes[k].impulse;
      joint.impulse.torque += c.joint_pushes[k].twist;
      if (joint.followed()) follow_coordinates(joint, c.bodies, c.h, true);
    }
  });
}

/// Names the body that became non-finite and its deepest contact.
Error non_finite(std::span<const RigidBody> bodies, std::span<const Contact> contacts,
                 uint32_t slot) {
  const Contact* deepest = nullptr;
  double gap = std::numeric_limits<double>::infinity();
  for (const Contact& c : contacts) {
    if (c.key.body_a != slot && c.key.body_b != slot) continue;
    for (int i = 0; i < c.count; ++i) {
      if (!deepest || c.points[size_t(i)].gap < gap) {
        deepest = &c;
        gap = c.points[size_t(i)].gap;
      }
    }
  }
  const RigidBody& b = bodies[slot];
  const char* what = b.pose.x.allFinite() && b.pose.q.coeffs().allFinite() ? "velocity" : "pose";
  std::string cause = "it touches nothing, so a force on it is to blame";
  if (deepest) {
    cause = fmt::format("its deepest contact is body {} shape {} with body {} shape {}, gap {} m",
                        deepest->key.body_a, deepest->shapes.a, deepest->key.body_b,
                        deepest->shapes.b, gap);
  }
  return {ErrorCode::numeric, fmt::format("the {} became non-finite: {}", what, cause),
          fmt::format("body {}", slot), "use a shorter tick, or less extreme masses and forces"};
}

bool finite(const RigidBody& b) {
  // The sum suffices: any infinity or NaN makes it non-finite.
  const double sum = b.pose.x.cwiseAbs().sum() + b.pose.q.coeffs().cwiseAbs().sum() +
                     b.v.cwiseAbs().sum() + b.omega.cwiseAbs().sum();
  return std::isfinite(sum);
}

/// The first of these bodies that is not finite.
std::optional<uint32_t> first_non_finite(std::span<const RigidBody> bodies,
                                         std::span<const uint32_t> slots, Crew& crew) {
  std::array<std::optional<uint32_t>, chunk_count> firsts;
  for_chunks(&crew, slots.size(), [&](size_t chunk, size_t first, size_t last) {
    const auto of_chunk = slots.subspan(first, last - first);
    const auto found =
        std::ranges::find_if(of_chunk, [&](uint32_t slot) { return !finite(bodies[slot]); });
    if (found != of_chunk.end()) firsts[chunk] = *found;
  });
  const auto found = std::ranges::find_if(firsts, [](const auto& f) { return f.has_value(); });
  return found != firsts.end() ? *found : std::nullopt;
}

}  // namespace

void RealtimeSolveStats::add(const RealtimeSolveStats& other) {
  islands += other.islands;
  awake += other.awake;
  contacts += other.contacts;
  points += other.points;
  joints += other.joints;
  residual = std::max(residual, other.residual);
  joint_residual = std::max(joint_residual, other.joint_residual);
}

RealtimeSolver::RealtimeSolver() : scratch_(std::make_unique<Scratch>()) {}
RealtimeSolver::~RealtimeSolver() = default;

std::span<const JointPush> RealtimeSolver::joint_pushes() const {
  return scratch_->joint_pushes;
}
void RealtimeSolver::add_memory(MemoryUse& use) const {
  const Scratch& s = *scratch_;
  use.bodies += heap_bytes(s.layouts, s.bodies, s.motions, s.local) + s.plans.bytes();
  use.contacts += heap_bytes(s.rows, s.points);
  use.joints += heap_bytes(s.joints, s.drives, s.joint_pushes, s.begun, s.springs, s.spring_turns);
  s.wide.add_memory(use);
}

RealtimeSolver::RealtimeSolver(RealtimeSolver&&) noexcept = default;
RealtimeSolver& RealtimeSolver::operator=(RealtimeSolver&&) noexcept = default;

void RealtimeSolver::begin_tick() {
  scratch_->begun.clear();
}

Result<RealtimeSolveStats> RealtimeSolver::step(std::span<RigidBody> bodies, ContactSet& contacts,
                                                const IslandSet& islands, const Vec3& gravity,
                                                double h, const RealtimeSettings& settings,
                                                Crew& crew, std::span<Joint> joints,
                                                std::span<JointCoupling> couplings, double passed,
                                                std::span<SolvedSpring> springs,
                                                std::span<const CourseMotion> courses) {
  Scratch& s = *scratch_;
  s.joint_pushes.resize(joints.size());
  s.begun.resize(joints.size(), 0);
  const SolverContext context{bodies, contacts.contacts(), gravity,   h,      &settings,
                              joints, s.joint_pushes,      couplings, passed, springs,
                              courses};
  begin_joints(context, islands, s.begun);
  s.plans.make(context, islands, crew);
  s.lay_out(context, islands);
  crew.each(s.layouts.size(), [&](size_t i) {
    const Scratch::Layout& l = s.layouts[i];
    const SolvePlan& plan = s.plans.plans()[i];
    if (plan.wide) return;
    SolverIsland island{part(s.bodies, l.bodies),   part(s.motions, l.bodies),
                        part(s.rows, l.rows),       part(s.points, l.points),
                        part(s.joints, l.joints),   plan.joint_sweeps,
                        part(s.drives, l.drives),   part(s.coupled, l.coupled),
                        part(s.springs, l.springs), part(s.spring_turns, l.spring_turns)};
    if (!island.rows.empty() || !island.joints.empty() || !island.springs.empty()) {
      s.residuals[i] = solve_island(context, island, plan.substeps);
      store_bodies(context, island);
      return;
    }
    const Island& free = islands.islands[i];
    for (uint32_t k = free.body_begin; k < free.body_end; ++k) {
      fly(bodies[islands.bodies[k]], gravity, h);
    }
  });
  RealtimeSolveStats stats;
  for (size_t k = 0; k < wide_sorts; ++k) {
    const auto sort = WideSort(k);
    if (s.plans.wide(sort).empty()) continue;
    s.wide.lay_out(context, islands, s.plans.wide(sort), s.plans.traits(), sort, crew);
    s.residuals.push_back(s.wide.solve(context, crew));
    stats.contacts += s.wide.contacts();
    stats.points += s.wide.points();
    stats.joints += s.wide.joints();
  }
  const std::span<const uint32_t> involved = islands.involved;
  for_chunks(&crew, involved.size(), [&](size_t, size_t first, size_t last) {
    for (const uint32_t i : involved.subspan(first, last - first))
      if (!bodies[i].dynamic() && is_active(bodies[i])) carry(bodies[i], h);
  });
  follow_joints(context, islands, crew);
  if (const auto broken = first_non_finite(bodies, islands.bodies, crew))
    return non_finite(bodies, contacts.contacts(), *broken);
  stats.islands = islands.islands.size();
  stats.awake = islands.bodies.size();
  stats.contacts += s.rows.size();
  stats.points += s.points.size();
  stats.joints += s.joints.size();
  for (const SolveResiduals& r : s.residuals) {
    stats.residual = std::max(stats.residual, r.contacts);
    stats.joint_residual = std::max(stats.joint_residual, r.joints);
  }
  return stats;
}

}  // namespace tumble
