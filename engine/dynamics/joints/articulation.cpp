#include "engine/dynamics/joints/articulation.hpp"

#include "engine/core/stop.hpp"
#include "engine/core/work_meter.hpp"
#include "engine/dynamics/joints/tolerances.hpp"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

/// A body with more joints than this is coupled to each of them, and not these to each other.
constexpr size_t most_coupled_by_body = 3;

/// How fast a row's side goes by `moves`.
double dot(const RowSide& push, const std::array<double, 6>& moves) {
  return push.linear[0] * moves[0] + push.linear[1] * moves[1] + push.linear[2] * moves[2] +
         push.angular[0] * moves[3] + push.angular[1] * moves[4] + push.angular[2] * moves[5];
}

/// Whether the body on a side of a joint answers to pushes.
bool moves(const Joint& joint, size_t side, std::span<const RigidBody> bodies) {
  const uint32_t slot = side == 0 ? joint.a : joint.b;
  return slot != no_body && bodies[slot].dynamic();
}

}  // namespace

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
  moves_.resize(2 * which.joints.size());
  for (const uint32_t j : which.joints) {
    const Joint& joint = all.joints[j];
    add_ends(std::array{joint.a, joint.b}, block_of, bodies,
             std::span(block_of_).subspan(2 * joints_.size(), 2));
    for (size_t k = 0; k < 2; ++k) moves_[2 * joints_.size() + k] = moves(joint, k, bodies);
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
  rows_.reserve(held_.size());
  plain_ = couplings_.empty() &&
           std::ranges::all_of(held_, [](const HeldRow& r) { return r.give == 0; });
  answers_.resize(2 * (held_.size() + couplings_.size()));
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
      if (block != block_of_[2 * place + k] || moves(joint, k, bodies) != moves_[2 * place + k])
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
  for (size_t i = 0; i < joints_.size(); ++i) joints_[i] = all.joints[which.joints[i]];
  return true;
}

namespace {

/// Which bodies may be hubs: those with many joints, where nothing that holds them together is a
/// loop. Counted as at rest, as it is until its own momentum is eliminated, a hub would make of the
/// rows around a loop more than the loop has freedoms.
class Hubs {
 public:
  /// The blocks of each joint, no_block where nothing moves.
  Hubs(size_t blocks, std::span<const std::array<uint32_t, 2>> joints)
      : joints_(joints), at_(blocks), hub_(blocks) {
    for (uint32_t j = 0; j < joints.size(); ++j)
      for (const uint32_t block : joints[j])
        if (block != no_block) at_[block].push_back(j);
    for (size_t i = 0; i < blocks; ++i) any_ = any_ || at_[i].size() > most_coupled_by_body;
    child_.assign(joints.size(), no_block);
    if (any_) find();
  }
  bool is_hub(uint32_t block) const { return hub_[block]; }
  /// Whether the joint leads to a hub, from where the tree begins.
  bool leads_to_hub(size_t joint) const { return child_[joint] != no_block && hub_[child_[joint]]; }

 private:
  void find() {
    std::vector<uint32_t> order;
    for (uint32_t j = 0; j < joints_.size(); ++j)
      if (joints_[j][0] == no_block || joints_[j][1] == no_block)
        order.push_back(joints_[j][0] == no_block ? joints_[j][1] : joints_[j][0]);
    // From the world outwards, then what floats.
    for (uint32_t i = 0; i < at_.size(); ++i) order.push_back(i);
    std::vector<uint8_t> seen(at_.size());
    for (const uint32_t root : order)
      if (root != no_block && !seen[root]) grow(root, seen);
  }
  /// The tree of a root; its hubs where it is one.
  void grow(uint32_t root, std::vector<uint8_t>& seen) {
    std::vector<uint32_t> tree{root};
    seen[root] = 1;
    size_t to_world = 0, ends = 0;
    for (size_t k = 0; k < tree.size(); ++k)
      for (const uint32_t j : at_[tree[k]]) {
        const uint32_t other = joints_[j][0] == tree[k] ? joints_[j][1] : joints_[j][0];
        (other == no_block ? to_world : ends) += 1;
        if (other == no_block) child_[j] = tree[k];
        if (other == no_block || seen[other]) continue;
        seen[other] = 1;
        child_[j] = other;
        tree.push_back(other);
      }
    const bool loops = to_world + ends / 2 > tree.size() - (to_world > 0 ? 0 : 1);
    for (const uint32_t block : tree)
      hub_[block] = !loops && at_[block].size() > most_coupled_by_body;
  }

  std::span<const std::array<uint32_t, 2>> joints_;
  std::vector<std::vector<uint32_t>> at_;
  std::vector<uint8_t> hub_;
  std::vector<uint32_t> child_;  ///< by joint of a tree: the block farther from the root
  bool any_ = false;
};

}  // namespace

/// The factor's blocks, and what each body adds to them.
void Articulation::lay_out(size_t blocks) {
  std::erase_if(ends_, [&](const End& e) { return rows_of(e) == 0; });
  std::vector<std::array<uint32_t, 2>> between(joints_.size(), {no_block, no_block});
  for (const End& e : ends_)
    if (e.owner < joints_.size()) between[e.owner][e.side] = e.block;
  // Couplings make loops of many bodies.
  const Hubs hubs(blocks, couplings_.empty() ? std::span(between) : std::span(between).first(0));
  std::ranges::stable_sort(ends_, {}, &End::block);
  first_end_.assign(blocks + 1, 0);
  for (const End& e : ends_) ++first_end_[e.block + 1];
  for (size_t i = 0; i < blocks; ++i) first_end_[i + 1] += first_end_[i];

  using Kind = BlockLdl::Kind;
  std::vector<uint32_t> sizes;
  std::vector<Kind> kinds(owners(), Kind::positive);
  for (size_t i = 0; i < owners(); ++i) {
    sizes.push_back(uint32_t(first_row_[i + 1] - first_row_[i]));
    if (couplings_.empty() && hubs.leads_to_hub(i)) kinds[i] = Kind::after_negative;
  }
  std::vector<std::pair<uint32_t, uint32_t>> coupled;
  std::vector<uint32_t> hub_of(blocks, no_end);
  for (uint32_t block = 0; block < blocks; ++block) {
    const auto ends = ends_at(block);
    if (hubs.is_hub(block)) {
      hub_of[block] = uint32_t(sizes.size());
      for (const End& e : ends) coupled.emplace_back(e.owner, hub_of[block]);
      sizes.push_back(6);
      kinds.push_back(Kind::negative);
      continue;
    }
    for (size_t i = 0; i < ends.size(); ++i)
      for (size_t k = 0; k < i; ++k)
        if (ends[i].owner != ends[k].owner) coupled.emplace_back(ends[i].owner, ends[k].owner);
  }
  factor_ = BlockLdl(sizes, coupled, kinds);
  for (uint32_t block = 0; block < blocks; ++block) {
    const uint32_t first = first_end_[block], last = first_end_[block + 1];
    const uint32_t hub = hub_of[block];
    if (hub != no_end) hubs_.emplace_back(block, factor_.place(hub, hub));
    for (uint32_t p = first; p < last; ++p) {
      if (hub != no_end) {
        terms_.push_back({p, no_end, factor_.place(ends_[p].owner, hub)});
        continue;
      }
      for (uint32_t q = first; q <= p; ++q) {
        terms_.push_back({p, q, factor_.place(ends_[p].owner, ends_[q].owner)});
        if (p != q && ends_[p].owner == ends_[q].owner)
          terms_.push_back({q, p, factor_.place(ends_[q].owner, ends_[p].owner)});
      }
    }
  }
}

/// The answers of an end's rows begin here, two apart of joints' and of couplings' first two sides.
size_t Articulation::first_answer(const End& end) const {
  const size_t row = first_row_[end.owner];
  if (end.side < 2) return 2 * row + end.side;
  return 2 * held_.size() + 2 * (end.owner - joints_.size()) + (end.side - 2u);
}

/// Rows along the coordinates of a joint.
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

/// The next row, which is along a coordinate.
void Articulation::update_drive(HeldRow& held, const JointSides& sides, double t) {
  const Joint& joint = joints_[held.owner];
  const size_t k = coordinate_of(rows_.size());
  JointRow row = entry_of(joint.kind).coordinates[k].row(sides);
  row.error = 0;
  if (held.use == RowUse::armature) {
    held.rate = row_rate(row, sides);
  } else {
    const CoordinateMotor& motor = (*joint.drives)[k].motor;
    const bool stands = stands_[rows_.size()];
    held.rate = stands ? 0 : motor.target_at(t);
    row.bias -= stands ? 0 : motor.target_rate;
  }
  rows_.push_back(row);
}

bool Articulation::rates_held(std::span<const DofBlock> blocks) const {
  for (size_t i = 0; i < rows_.size(); ++i) {
    double size = std::fabs(held_[i].rate);
    for_sides(i, [&](const RowSide& s) {
      const DofBlock& b = blocks[s.block];
      // By lengths: what turns about an axis has the digits of its speed across it too.
      size += s.linear.norm() * b.v.norm() + s.angular.norm() * b.omega.norm();
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

void Articulation::update_coupling(Coupled& c, std::span<const RigidBody> bodies, double t) {
  JointSides of_a = sides_with_axes(c.a, bodies), of_b = sides_with_axes(c.b, bodies);
  of_a.a.block = c.block_of[0], of_a.b.block = c.block_of[1];
  of_b.a.block = c.block_of[2], of_b.b.block = c.block_of[3];
  const JointRow x = c.x.look(entry_of(c.a.kind).coordinates[c.coupling.x], of_a, t);
  const JointRow y = c.y.look(entry_of(c.b.kind).coordinates[c.coupling.y], of_b, t);
  const CouplingRow row = coupling_row(c.coupling, x, y);
  rows_.push_back({row.of_x.row, row.error(), row.bias()});
  c.of_y = row.of_y.row;
}

void Articulation::look(std::span<const RigidBody> bodies, double t) {
  rows_.clear();
  JointRows own;
  for (size_t j = 0; j < joints_.size(); ++j) {
    JointSides sides = joint_sides(joints_[j], bodies);
    sides.a.block = block_of_[2 * j];
    sides.b.block = block_of_[2 * j + 1];
    own.clear();
    joint_rows(joints_[j].kind, sides, own);
    rows_.insert(rows_.end(), own.all().begin(), own.all().end());
    while (rows_.size() < first_row_[j + 1]) update_drive(held_[rows_.size()], sides, t);
  }
  for (Coupled& c : couplings_) update_coupling(c, bodies, t);
}

/// What pushes along the rows of an end do to its body.
void Articulation::answer(const DofBlock& block, const End& end) {
  const size_t first = first_answer(end);
  for (size_t r = 0; r < rows_of(end); ++r) {
    const RowSide& s = side(first_row_[end.owner] + r, end.side);
    Answer& to = answers_[first + 2 * r];
    const Vec3 turns = block.inverse_inertia * s.angular;
    for (size_t k = 0; k < 3; ++k) {
      const auto i = Eigen::Index(k);
      to[k] = block.inverse_mass * s.linear[i], to[3 + k] = turns[i];
    }
  }
}

void Articulation::add_term(const Term& term) {
  const End& p = ends_[term.p];
  double* const to = &factor_.values()[term.to.first];
  const size_t rows = rows_of(p), first = first_row_[p.owner];
  if (term.q == no_end) {
    const Answer* const of_p = &answers_[first_answer(p)];
    for (size_t r = 0; r < rows; ++r) {
      for (size_t k = 0; k < 6; ++k)
        to[r * term.to.row_step + k * term.to.column_step] += of_p[2 * r][k];
      factor_.add_size(first + r, dot(side(first + r, p.side), of_p[2 * r]));
    }
    return;
  }
  const End& q = ends_[term.q];
  const Answer* const of_q = &answers_[first_answer(q)];
  // Of a diagonal block the half below the diagonal is enough for the other one.
  const bool own = term.p == term.q;
  const size_t columns = rows_of(q);
  for (size_t r = 0; r < rows; ++r) {
    const RowSide& push = side(first + r, p.side);
    for (size_t c = 0; c < (own ? r + 1 : columns); ++c) {
      const double value = dot(push, of_q[2 * c]);
      to[r * term.to.row_step + c * term.to.column_step] += value;
      if (own && c != r) to[c * term.to.row_step + r * term.to.column_step] += value;
    }
  }
}

void Articulation::factor(std::span<const DofBlock> blocks) {
  for (const End& e : ends_) answer(blocks[e.block], e);
  factor_.clear();
  for (const Term& term : terms_) add_term(term);
  for (const auto& [block, to] : hubs_) {
    double* const values = &factor_.values()[to.first];
    for (size_t k = 0; k < 3; ++k) {
      values[k * (to.row_step + to.column_step)] = -blocks[block].inverse_mass;
      for (size_t i = 0; i < 3; ++i)
        values[(3 + k) * to.row_step + (3 + i) * to.column_step] =
            -blocks[block].inverse_inertia(Eigen::Index(k), Eigen::Index(i));
    }
  }
  for (size_t owner = 0; owner < joints_.size(); ++owner)
    for (size_t r = first_row_[owner]; r < first_row_[owner + 1]; ++r) {
      const auto place = uint32_t(r - first_row_[owner]);
      if (held_[r].give > 0)
        factor_.add(uint32_t(owner), place, uint32_t(owner), place, held_[r].give);
    }
  factor_.factor();
}

double Articulation::error() const {
  double worst = 0;
  for (const JointRow& r : rows_) worst = std::max(worst, std::fabs(r.error));
  return worst;
}

void Articulation::apply_change(std::span<double> change, std::span<DofBlock> blocks,
                                std::span<double> pushes) const {
  factor_.solve(change);
  for (const End& e : ends_) {
    const Answer* answer = &answers_[first_answer(e)];
    DofBlock& block = blocks[e.block];
    for (size_t i = first_row_[e.owner]; i < first_row_[e.owner + 1]; ++i, answer += 2)
      for (size_t k = 0; k < 3; ++k) {
        block.v[Eigen::Index(k)] += change[i] * (*answer)[k];
        block.omega[Eigen::Index(k)] += change[i] * (*answer)[3 + k];
      }
  }
  for (size_t i = 0; i < rows_.size(); ++i) pushes[i] += change[i];
}

void Articulation::reduce(std::span<const Row> rows, Eigen::MatrixXd& delassus) const {
  if (empty()) return;
  // G M^-1 J^T of each row that touches jointed bodies: few entries each.
  std::vector<std::vector<std::pair<uint32_t, double>>> felt(rows.size());
  for (size_t k = 0; k < rows.size(); ++k)
    for (const RowSide* s : {&rows[k].a, &rows[k].b}) {
      if (s->block == no_block) continue;
      for (const End& e : ends_at(s->block))
        for (size_t r = 0; r < rows_of(e); ++r)
          felt[k].emplace_back(uint32_t(first_row_[e.owner] + r),
                               dot(*s, answers_[first_answer(e) + 2 * r]));
    }
  std::vector<std::pair<Eigen::Index, double>> locked;
  std::vector<double> held(factor_.size());
  for (size_t k = 0; k < rows.size(); ++k) {
    if (felt[k].empty()) continue;
    charge_work(8 * (k + 1) + 50);
    if (stop_requested()) return;
    std::fill(held.begin(), held.end(), 0.0);
    for (const auto& [r, value] : felt[k]) held[r] += value;
    factor_.solve(held);
    const auto column = Eigen::Index(k);
    const double free = delassus(column, column);
    for (size_t i = 0; i <= k; ++i) {
      double sum = 0;
      for (const auto& [r, value] : felt[i]) sum += value * held[r];
      const auto row = Eigen::Index(i);
      delassus(row, column) = delassus(column, row) = delassus(row, column) - sum;
    }
    if (delassus(column, column) > tolerances::locked_share * free) continue;
    // No push changes this velocity, nor needs to: by itself, as of free bodies, it gets none.
    locked.emplace_back(column, free);
  }
  for (const auto& [k, free] : locked) {
    delassus.row(k).setZero();
    delassus.col(k).setZero();
    delassus(k, k) = free;
  }
}

std::vector<DofBlock> blocks_of(std::span<const RigidBody> bodies,
                                std::span<const uint32_t> slots) {
  std::vector<DofBlock> out(slots.size());
  for (size_t i = 0; i < out.size(); ++i) {
    const RigidBody& b = bodies[slots[i]];
    out[i].v = b.v;
    out[i].omega = b.omega;
    if (!b.dynamic()) continue;
    out[i].inverse_mass = b.inverse_mass;
    out[i].inverse_inertia = b.inverse_inertia_world();
  }
  return out;
}

}  // namespace tumble
