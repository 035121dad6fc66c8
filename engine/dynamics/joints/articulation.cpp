#include "engine/dynamics/joints/articulation.hpp"

#include "engine/core/stop.hpp"
#include "engine/core/work_meter.hpp"
#include "engine/dynamics/joints/tolerances.hpp"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

/// Velocity along one side of a row by a motion of its body.
double dot(const RowSide& push, const std::array<double, 6>& moves) {
  return push.linear[0] * moves[0] + push.linear[1] * moves[1] + push.linear[2] * moves[2] +
         push.angular[0] * moves[3] + push.angular[1] * moves[4] + push.angular[2] * moves[5];
}

/// Response of a body by itself to a push along one side of a row.
std::array<double, 6> answer_of(const BodyMass& mass, const RowSide& push) {
  const Vec3 turning = mass.inverse_inertia * push.angular;
  return {mass.inverse_mass * push.linear[0],
          mass.inverse_mass * push.linear[1],
          mass.inverse_mass * push.linear[2],
          turning[0],
          turning[1],
          turning[2]};
}

}  // namespace

Articulation::Answering Articulation::answering(const Joint& joint, size_t side,
                                                std::span<const RigidBody> bodies) {
  const uint32_t slot = side == 0 ? joint.a : joint.b;
  if (slot == no_body || !bodies[slot].dynamic()) return Answering::stays;
  const RigidBody& b = bodies[slot];
  const double ratio = b.inertia_body.trace() * b.inverse_inertia_body.trace();
  return ratio > 0 && ratio < tolerances::most_moment_ratio ? Answering::turns : Answering::moves;
}

void Articulation::add_ends(std::span<const uint32_t> slots, std::span<const uint32_t> block_of,
                            std::span<const RigidBody> bodies, std::span<uint32_t> blocks) {
  const auto owner = uint32_t(first_row_.size());
  for (uint8_t k = 0; k < slots.size(); ++k) {
    blocks[k] = slots[k] == no_body ? no_block : block_of[slots[k]];
    if (blocks[k] != no_block && bodies[slots[k]].dynamic()) ends_.push_back({blocks[k], owner, k});
  }
}

Articulation::Articulation(const JointsAndCouplings& all, const JointChoice& which,
                           std::span<const uint32_t> block_of, std::span<const RigidBody> bodies,
                           size_t blocks, Drives drives) {
  const auto end_owner = [&](size_t first) { first_row_.push_back(first); };
  block_of_.resize(2 * which.joints.size());
  answering_.resize(2 * which.joints.size());
  for (const uint32_t j : which.joints) {
    const Joint& joint = all.joints[j];
    add_ends(std::array{joint.a, joint.b}, block_of, bodies,
             std::span(block_of_).subspan(2 * joints_.size(), 2));
    for (size_t k = 0; k < 2; ++k) answering_[2 * joints_.size() + k] = answering(joint, k, bodies);
    const size_t first = held_.size();
    const auto place = uint32_t(joints_.size());
    for (size_t k = 0; k < row_count(joint.kind); ++k)
      held_.push_back({RowUse::part, place, uint8_t(k)});
    if (drives == Drives::held) add_drives(joint, place);
    joints_.push_back(joint);
    end_owner(first);
  }
  for (const uint32_t k : which.couplings) {
    const JointCoupling& c = all.couplings[k];
    Coupled made{c, all.joints[c.a], all.joints[c.b], {}, {}, {}, {}};
    made.x = {made.a.value[c.x], made.a.rate[c.x], 0};
    made.y = {made.b.value[c.y], made.b.rate[c.y], 0};
    add_ends(std::array{made.a.a, made.a.b, made.b.a, made.b.b}, block_of, bodies, made.block_of);
    held_.push_back({RowUse::coupling, uint32_t(couplings_.size())});
    couplings_.push_back(std::move(made));
    end_owner(held_.size() - 1);
  }
  first_row_.push_back(held_.size());
  stands_.resize(held_.size());
  rows_.resize(held_.size());
  parts_only_ = std::ranges::all_of(held_, [](const HeldRow& r) { return r.use == RowUse::part; });
  plain_ = couplings_.empty() &&
           std::ranges::all_of(held_, [](const HeldRow& r) { return r.give == 0; });
  for (const HeldRow& r : held_) gives_.push_back(r.give);
  lay_out(blocks);
}

bool Articulation::renew(const JointsAndCouplings& all, const JointChoice& which,
                         std::span<const uint32_t> block_of, std::span<const RigidBody> bodies,
                         size_t blocks, Drives drives) {
  if (joints_.empty() || which.joints.size() != joints_.size()) return false;
  if (!couplings_.empty() || !which.couplings.empty() || first_end_.size() != blocks + 1)
    return false;
  const auto same = [&](size_t place) {
    const Joint& joint = all.joints[which.joints[place]];
    if (joint.kind != joints_[place].kind) return false;
    for (size_t k = 0; k < 2; ++k) {
      const uint32_t slot = k == 0 ? joint.a : joint.b;
      const uint32_t block = slot == no_body ? no_block : block_of[slot];
      if (block != block_of_[2 * place + k] ||
          answering(joint, k, bodies) != answering_[2 * place + k])
        return false;
    }
    const auto has_row = [](const CoordinateDrive& d) {
      return d.armature > 0 || d.motor.holds_rate_with_any_force();
    };
    return first_row_[place + 1] - first_row_[place] == row_count(joint.kind) &&
           (drives == Drives::none || !joint.drives ||
            std::ranges::none_of(*joint.drives, has_row));
  };
  for (size_t i = 0; i < joints_.size(); ++i)
    if (!same(i)) return false;
  const auto moved = [](const Pose& p, const Pose& q) {
    return p.x != q.x || p.q.coeffs() != q.q.coeffs();
  };
  for (size_t i = 0; i < joints_.size(); ++i) {
    const Joint& joint = all.joints[which.joints[i]];
    Joint& known = joints_[i];
    if (joint.a != known.a || joint.b != known.b || joint.length != known.length ||
        moved(joint.frame_a, known.frame_a) || moved(joint.frame_b, known.frame_b))
      seen_.clear();
    known = joint;
  }
  if (!accepted_.empty()) seen_.clear();
  accepted_.clear();
  return true;
}

void Articulation::lay_out(size_t blocks) {
  std::erase_if(ends_, [&](const End& e) { return rows_of(e) == 0; });
  std::ranges::stable_sort(ends_, {}, &End::block);
  first_end_.assign(blocks + 1, 0);
  for (const End& e : ends_) ++first_end_[e.block + 1];
  for (size_t i = 0; i < blocks; ++i) first_end_[i + 1] += first_end_[i];
  masses_.resize(blocks);
  lay_out_core(fold_trees(blocks), blocks);
}

/// Folds leaf after leaf; returns by owner which joints are folded.
std::vector<uint8_t> Articulation::fold_trees(size_t blocks) {
  std::vector<uint8_t> folded(owners());
  std::vector<uint32_t> left(blocks), leaves;
  const auto look = [&](uint32_t block) {
    if (left[block] == 1) leaves.push_back(block);
  };
  for (uint32_t b = 0; b < blocks; ++b) left[b] = uint32_t(ends_at(b).size());
  for (uint32_t b = 0; b < blocks; ++b) look(b);
  std::vector<FoldedJoint> joints;
  for (size_t i = 0; i < leaves.size(); ++i) {
    const uint32_t leaf = leaves[i];
    const auto ends = ends_at(leaf);
    const auto last = std::ranges::find_if(ends, [&](const End& e) { return !folded[e.owner]; });
    // Its last neighbour may have been folded into this block.
    if (last == ends.end() || last->owner >= joints_.size()) continue;
    const size_t at = 2 * last->owner, other = at + 1 - last->side;
    if (answering_[at + last->side] != Answering::turns || answering_[other] == Answering::moves)
      continue;
    const uint32_t parent = answering_[other] == Answering::stays ? no_block : block_of_[other];
    const size_t parts = row_count(joints_[last->owner].kind);
    joints.push_back({leaf, parent, uint32_t(first_row_[last->owner]), last->side, uint8_t(parts),
                      uint8_t(rows_of(*last) - parts)});
    folded[last->owner] = 1;
    if (parent == no_block) continue;
    --left[parent];
    look(parent);
  }
  trees_ = joints.empty() ? FoldedTrees() : FoldedTrees(joints, blocks, held_.size());
  tree_blocks_.clear();
  for (uint32_t b = 0; b < blocks; ++b)
    if (trees_.has(b)) tree_blocks_.push_back(b);
  return folded;
}

/// Lays out the blocks of the core's factor, and what each body adds to them.
void Articulation::lay_out_core(std::span<const uint8_t> folded, size_t blocks) {
  core_row_.assign(held_.size(), no_row);
  std::vector<uint32_t> sizes, place(owners());
  uint32_t rows = 0;
  for (size_t i = 0; i < owners(); ++i) {
    if (folded[i]) continue;
    place[i] = uint32_t(sizes.size());
    sizes.push_back(uint32_t(first_row_[i + 1] - first_row_[i]));
    for (size_t r = first_row_[i]; r < first_row_[i + 1]; ++r) core_row_[r] = rows++;
  }
  if (rows == 0) return;
  answers_.resize(2 * (held_.size() + couplings_.size()));
  std::vector<std::vector<uint32_t>> at(blocks);
  for (uint32_t e = 0; e < ends_.size(); ++e) {
    if (folded[ends_[e].owner]) continue;
    core_ends_.push_back(e);
    at[ends_[e].block].push_back(e);
  }
  std::vector<std::pair<uint32_t, uint32_t>> coupled;
  for (const std::vector<uint32_t>& ends : at)
    for (size_t i = 0; i < ends.size(); ++i)
      for (size_t k = 0; k < i; ++k) {
        const uint32_t p = ends_[ends[i]].owner, q = ends_[ends[k]].owner;
        if (p != q) coupled.emplace_back(place[p], place[q]);
      }
  factor_ = BlockLdl(sizes, coupled);
  for (uint32_t i = 0; i < owners(); ++i)
    for (size_t r = first_row_[i]; r < first_row_[i + 1]; ++r) {
      if (folded[i] || held_[r].give == 0) continue;
      const BlockLdl::Place to = factor_.place(place[i], place[i]);
      core_gives_.emplace_back(uint32_t(r),
                               to.first + (r - first_row_[i]) * (to.row_step + to.column_step));
    }
  core_change_.resize(factor_.size());
  for (const std::vector<uint32_t>& ends : at)
    for (size_t i = 0; i < ends.size(); ++i)
      for (size_t k = 0; k <= i; ++k) {
        const uint32_t p = ends[i], q = ends[k];
        const uint32_t of_p = place[ends_[p].owner], of_q = place[ends_[q].owner];
        terms_.push_back({p, q, factor_.place(of_p, of_q)});
        if (p != q && of_p == of_q) terms_.push_back({q, p, factor_.place(of_q, of_p)});
      }
}

/// Index of the first answer of an end's rows; successive rows are two apart.
size_t Articulation::first_answer(const End& end) const {
  const size_t row = first_row_[end.owner];
  if (end.side < 2) return 2 * row + end.side;
  return 2 * held_.size() + 2 * (end.owner - joints_.size()) + (end.side - 2u);
}

/// Adds the rows along the coordinates of a joint.
void Articulation::add_drives(const Joint& joint, uint32_t place) {
  const size_t parts = row_count(joint.kind);
  for (size_t k = 0; joint.drives && k < most_coordinates; ++k) {
    const CoordinateDrive& d = (*joint.drives)[k];
    if (d.armature > 0)
      held_.push_back({RowUse::armature, place, uint8_t(parts + k), 1 / d.armature});
    if (d.motor.holds_rate_with_any_force())
      held_.push_back({RowUse::motor, place, uint8_t(parts + k)});
  }
}

size_t Articulation::coordinate_of(size_t row) const {
  return held_[row].place - row_count(joints_[held_[row].owner].kind);
}

/// Updates a row along a coordinate.
void Articulation::update_drive(size_t at, const JointSides& sides, double t) {
  HeldRow& held = held_[at];
  const Joint& joint = joints_[held.owner];
  const size_t k = coordinate_of(at);
  JointRow& row = rows_[at] = entry_of(joint.kind).coordinates[k].row(sides);
  row.error = 0;
  if (held.use == RowUse::armature) {
    held.rate = row_rate(row, sides);
  } else {
    const CoordinateMotor& motor = (*joint.drives)[k].motor;
    const bool stands = stands_[at];
    held.rate = stands ? 0 : motor.target_at(t);
    row.bias -= stands ? 0 : motor.target_rate;
  }
}

bool Articulation::rates_held(std::span<const DofBlock> blocks) const {
  // By magnitudes: rounding error of a rotation has all directions.
  speeds_.resize(blocks.size());
  for (size_t i = 0; i < blocks.size(); ++i)
    speeds_[i] = {blocks[i].v.norm(), blocks[i].omega.norm()};
  for (size_t i = 0; i < rows_.size(); ++i) {
    double size = std::fabs(held_[i].rate);
    for_sides(i, [&](const RowSide& s) {
      const auto& [v, omega] = speeds_[s.block];
      size += s.linear.norm() * v + s.angular.norm() * omega;
    });
    if (!(std::fabs(rate_off(i, blocks)) <= tolerances::held_share * size)) return false;
  }
  return true;
}

double Articulation::rotor_energy(std::span<const RigidBody> bodies) const {
  double sum = 0;
  for (size_t i = 0; i < held_.size(); ++i) {
    if (held_[i].use != RowUse::armature) continue;
    const Joint& joint = joints_[held_[i].owner];
    const JointSides sides = joint_sides(joint, bodies);
    const double rate =
        row_rate(entry_of(joint.kind).coordinates[coordinate_of(i)].row(sides), sides);
    sum += 0.5 * rate * rate / held_[i].give;
  }
  return sum;
}

JointRow Articulation::update_coupling(Coupled& c, std::span<const RigidBody> bodies, double t) {
  JointSides of_a = sides_with_axes(c.a, bodies), of_b = sides_with_axes(c.b, bodies);
  of_a.a.block = c.block_of[0], of_a.b.block = c.block_of[1];
  of_b.a.block = c.block_of[2], of_b.b.block = c.block_of[3];
  const JointRow x = c.x.look(entry_of(c.a.kind).coordinates[c.coupling.x], of_a, t);
  const JointRow y = c.y.look(entry_of(c.b.kind).coordinates[c.coupling.y], of_b, t);
  const CouplingRow row = coupling_row(c.coupling, x, y);
  c.of_y = row.of_y.row;
  return {row.of_x.row, row.error(), row.bias()};
}

void Articulation::look(std::span<const RigidBody> bodies, double t) {
  fresh_ = false;
  JointSides sides;
  for (size_t j = 0; j < joints_.size(); ++j) {
    put_joint_sides(joints_[j], bodies, sides);
    sides.a.block = block_of_[2 * j];
    sides.b.block = block_of_[2 * j + 1];
    const JointRow* const end = joint_rows(joints_[j].kind, sides, &rows_[first_row_[j]]);
    for (auto r = size_t(end - rows_.data()); r < first_row_[j + 1]; ++r) update_drive(r, sides, t);
  }
  size_t at = first_row_[joints_.size()];
  for (Coupled& c : couplings_) rows_[at++] = update_coupling(c, bodies, t);
  for (size_t i = 0; i < accepted_.size(); ++i) rows_[i].error -= accepted_[i];
  seen_.clear();
}

void Articulation::look_where_moved(std::span<const RigidBody> bodies, double t) {
  const auto same = [&](size_t j) {
    for (size_t k = 0; k < 2; ++k) {
      const uint32_t slot = k == 0 ? joints_[j].a : joints_[j].b;
      if (slot == no_body) continue;
      const Pose &now = bodies[slot].pose, &then = seen_[2 * j + k];
      if (now.x != then.x || now.q.coeffs() != then.q.coeffs()) return false;
    }
    return true;
  };
  bool known = !seen_.empty();
  for (size_t j = 0; known && j < joints_.size(); ++j) known = same(j);
  if (known) return;
  look(bodies, t);
  if (!parts_only_) return;
  seen_.resize(2 * joints_.size());
  for (size_t j = 0; j < joints_.size(); ++j)
    for (size_t k = 0; k < 2; ++k)
      if (const uint32_t slot = k == 0 ? joints_[j].a : joints_[j].b; slot != no_body)
        seen_[2 * j + k] = bodies[slot].pose;
}

/// Computes the responses of a body, with everything that is folded into it, to pushes along the
/// rows of an end.
void Articulation::answer(const DofBlock& block, const End& end) {
  const size_t first = first_answer(end);
  for (size_t r = 0; r < rows_of(end); ++r) {
    const RowSide& s = side(first_row_[end.owner] + r, end.side);
    answers_[first + 2 * r] = trees_.has(end.block)
                                  ? trees_.answer(end.block, s)
                                  : answer_of({block.inverse_mass, block.inverse_inertia}, s);
  }
}

void Articulation::add_term(const Term& term) {
  const End &p = ends_[term.p], &q = ends_[term.q];
  double* const to = &factor_.values()[term.to.first];
  const size_t rows = rows_of(p), columns = rows_of(q), first = first_row_[p.owner];
  const Answer* const of_q = &answers_[first_answer(q)];
  // For a diagonal block the lower triangle suffices.
  const bool own = term.p == term.q;
  for (size_t r = 0; r < rows; ++r) {
    const RowSide& push = side(first + r, p.side);
    for (size_t c = 0; c < (own ? r + 1 : columns); ++c) {
      const double value = dot(push, of_q[2 * c]);
      to[r * term.to.row_step + c * term.to.column_step] += value;
      if (own && c != r) to[c * term.to.row_step + r * term.to.column_step] += value;
    }
  }
}

void Articulation::factor(std::span<const DofBlock> blocks, std::span<const Mat3> inertias) {
  for (size_t i = 0; i < masses_.size(); ++i)
    masses_[i] = {blocks[i].inverse_mass, blocks[i].inverse_inertia};
  fresh_ = true;
  if (!trees_.empty()) trees_.factor(rows_, gives_, blocks, inertias);
  if (factor_.size() == 0) return;
  for (const uint32_t e : core_ends_) answer(blocks[ends_[e].block], ends_[e]);
  factor_.clear();
  for (const Term& term : terms_) add_term(term);
  for (const auto& [row, to] : core_gives_) factor_.values()[to] += held_[row].give;
  factor_.factor();
}

double Articulation::error() const {
  double worst = 0;
  for (const JointRow& r : rows_) worst = std::max(worst, std::fabs(r.error));
  return worst;
}

bool Articulation::accept_errors(std::span<const RigidBody> bodies, double t, double worked_off) {
  if (empty()) return false;
  if (!accepted_.empty()) seen_.clear();
  accepted_.clear();
  look_where_moved(bodies, t);
  for (size_t k = 0; k < owners(); ++k) {
    const auto rows = std::span(rows_).subspan(first_row_[k], first_row_[k + 1] - first_row_[k]);
    double square = 0;
    for (const JointRow& r : rows) square += r.error * r.error;
    const double off = std::sqrt(square);
    if (!(off > worked_off)) continue;
    accepted_.resize(rows_.size());
    for (size_t i = 0; i < rows.size(); ++i) {
      accepted_[first_row_[k] + i] = rows[i].error * (1 - worked_off / off);
      rows[i].error -= accepted_[first_row_[k] + i];
    }
  }
  return !accepted_.empty();
}

void Articulation::solve(std::span<double> change) const {
  if (!trees_.empty()) trees_.gather(change);
  if (factor_.size() > 0) {
    for (size_t r = 0; r < change.size(); ++r)
      if (core_row_[r] != no_row) core_change_[core_row_[r]] = change[r];
    const auto for_roots = [&](const auto& f) {
      for (const uint32_t at : core_ends_) {
        const End& e = ends_[at];
        if (!trees_.has(e.block)) continue;
        const size_t first = first_row_[e.owner];
        for (size_t r = 0; r < rows_of(e); ++r)
          f(e, first + r, core_change_[core_row_[first + r]], answers_[first_answer(e) + 2 * r]);
      }
    };
    for_roots([&](const End& e, size_t row, double& left, const Answer&) {
      left -= dot(side(row, e.side), trees_.motion(e.block));
    });
    factor_.solve(core_change_);
    for_roots([&](const End& e, size_t, double push, const Answer& answer) {
      for (size_t k = 0; k < 6; ++k) trees_.motion(e.block)[k] += push * answer[k];
    });
    for (size_t r = 0; r < change.size(); ++r)
      if (core_row_[r] != no_row) change[r] = core_change_[core_row_[r]];
  }
  if (!trees_.empty()) trees_.spread(change);
}

void Articulation::apply_change(std::span<double> change, std::span<DofBlock> blocks,
                                std::span<double> pushes) const {
  solve(change);
  const auto add = [](DofBlock& block, double share, const Answer& motion) {
    for (size_t k = 0; k < 3; ++k) {
      block.v[int(k)] += share * motion[k];
      block.omega[int(k)] += share * motion[3 + k];
    }
  };
  for (const uint32_t block : tree_blocks_) add(blocks[block], 1, trees_.motion(block));
  for (const uint32_t at : core_ends_) {
    const End& e = ends_[at];
    if (trees_.has(e.block)) continue;
    const Answer* answer = &answers_[first_answer(e)];
    for (size_t i = first_row_[e.owner]; i < first_row_[e.owner + 1]; ++i, answer += 2)
      add(blocks[e.block], change[i], *answer);
  }
  for (size_t i = 0; i < rows_.size(); ++i) pushes[i] += change[i];
}

void Articulation::reduce(std::span<const Row> rows, Eigen::MatrixXd& delassus) const {
  if (empty()) return;
  // G M^-1 J^T of each row that acts on jointed bodies: few entries each.
  std::vector<std::vector<std::pair<uint32_t, double>>> felt(rows.size());
  for (size_t k = 0; k < rows.size(); ++k)
    for (const RowSide* s : {&rows[k].a, &rows[k].b}) {
      if (s->block == no_block) continue;
      const Answer moved = answer_of(masses_[s->block], *s);
      for (const End& e : ends_at(s->block))
        for (size_t r = 0; r < rows_of(e); ++r) {
          const size_t row = first_row_[e.owner] + r;
          felt[k].emplace_back(uint32_t(row), dot(side(row, e.side), moved));
        }
    }
  std::vector<std::pair<Eigen::Index, double>> locked;
  std::vector<double> held(rows_.size());
  for (size_t k = 0; k < rows.size(); ++k) {
    if (felt[k].empty()) continue;
    charge_work(8 * (k + 1) + 50);
    if (stop_requested()) return;
    std::fill(held.begin(), held.end(), 0.0);
    for (const auto& [r, value] : felt[k]) held[r] += value;
    solve(held);
    const auto column = Eigen::Index(k);
    const double free = delassus(column, column);
    for (size_t i = 0; i <= k; ++i) {
      double sum = 0;
      for (const auto& [r, value] : felt[i]) sum += value * held[r];
      const auto row = Eigen::Index(i);
      delassus(row, column) = delassus(column, row) = delassus(row, column) - sum;
    }
    if (delassus(column, column) > tolerances::locked_share * free) continue;
    // No push can change this velocity: the row is decoupled, with the diagonal entry of free
    // bodies.
    locked.emplace_back(column, free);
  }
  for (const auto& [k, free] : locked) {
    delassus.row(k).setZero();
    delassus.col(k).setZero();
    delassus(k, k) = free;
  }
}

void put_velocities(std::span<const RigidBody> bodies, std::span<const uint32_t> slots,
                    std::span<DofBlock> out) {
  for (size_t i = 0; i < slots.size(); ++i) {
    out[i].v = bodies[slots[i]].v;
    out[i].omega = bodies[slots[i]].omega;
  }
}

void put_masses(std::span<const RigidBody> bodies, std::span<const uint32_t> slots,
                std::span<DofBlock> out) {
  for (size_t i = 0; i < slots.size(); ++i) {
    const RigidBody& b = bodies[slots[i]];
    if (!b.dynamic()) continue;
    out[i].inverse_mass = b.inverse_mass;
    out[i].inverse_inertia = b.inverse_inertia_world();
  }
}

std::vector<DofBlock> blocks_of(std::span<const RigidBody> bodies,
                                std::span<const uint32_t> slots) {
  std::vector<DofBlock> out(slots.size());
  put_velocities(bodies, slots, out);
  put_masses(bodies, slots, out);
  return out;
}

}  // namespace tumble
