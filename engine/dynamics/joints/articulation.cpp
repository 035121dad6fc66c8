#include "engine/dynamics/joints/articulation.hpp"

#include "engine/core/stop.hpp"
#include "engine/core/work_meter.hpp"
#include "engine/dynamics/joints/tolerances.hpp"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

double product(const RowSide& s, const DofBlock& block, const RowSide& o) {
  return block.inverse_mass * s.linear.dot(o.linear) +
         s.angular.dot(block.inverse_inertia * o.angular);
}

}  // namespace

void Articulation::add_ends(std::span<const uint32_t> slots, std::span<const uint32_t> block_of,
                            std::span<const RigidBody> bodies, std::span<uint32_t> blocks) {
  const auto owner = uint32_t(first_row_.size());
  for (uint8_t k = 0; k < slots.size(); ++k) {
    blocks[k] = slots[k] == no_body ? no_block : block_of[slots[k]];
    if (blocks[k] != no_block && bodies[slots[k]].dynamic()) ends_[blocks[k]].push_back({owner, k});
  }
}

Articulation::Articulation(const JointsAndCouplings& all, const JointChoice& which,
                           std::span<const uint32_t> block_of, std::span<const RigidBody> bodies,
                           size_t blocks, Drives drives)
    : ends_(blocks) {
  std::vector<uint32_t> sizes;
  const auto end_owner = [&](size_t first) {
    sizes.push_back(uint32_t(held_.size() - first));
    first_row_.push_back(first);
  };
  block_of_.resize(2 * which.joints.size());
  for (const uint32_t j : which.joints) {
    const Joint& joint = all.joints[j];
    add_ends(std::array{joint.a, joint.b}, block_of, bodies,
             std::span(block_of_).subspan(2 * joints_.size(), 2));
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
  std::vector<std::pair<uint32_t, uint32_t>> coupled;
  for (const std::vector<End>& ends : ends_)
    for (size_t i = 0; i < ends.size(); ++i)
      for (size_t k = 0; k < i; ++k)
        if (ends[i].owner != ends[k].owner) coupled.emplace_back(ends[i].owner, ends[k].owner);
  factor_ = BlockLdl(sizes, coupled);
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

void Articulation::update(std::span<const RigidBody> bodies, std::span<const DofBlock> blocks,
                          double t) {
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
  factor_.clear();
  for (size_t block = 0; block < ends_.size(); ++block)
    for (const End& p : ends_[block])
      for (const End& q : ends_[block]) {
        if (q.owner > p.owner) break;
        const size_t first_p = first_row_[p.owner], first_q = first_row_[q.owner];
        for (size_t r = first_p; r < first_row_[p.owner + 1]; ++r)
          for (size_t c = first_q; c < first_row_[q.owner + 1]; ++c)
            factor_.add(p.owner, uint32_t(r - first_p), q.owner, uint32_t(c - first_q),
                        product(side(r, p.side), blocks[block], side(c, q.side)));
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
  for (size_t i = 0; i < rows_.size(); ++i) {
    apply_row(rows_[i].row, change[i], blocks);
    if (sides_of(i) > 2)
      apply_row(couplings_[i - first_row_[joints_.size()]].of_y, change[i], blocks);
    pushes[i] += change[i];
  }
}

void Articulation::reduce(std::span<const Row> rows, std::span<const DofBlock> blocks,
                          Eigen::MatrixXd& delassus) const {
  if (empty()) return;
  const auto n = Eigen::Index(rows.size()), m = Eigen::Index(rows_.size());
  // y = L^-1 G M^-1 J^T of each row that touches jointed bodies.
  Eigen::MatrixXd y = Eigen::MatrixXd::Zero(m, n);
  std::vector<uint8_t> jointed(rows.size());
  std::vector<std::pair<Eigen::Index, double>> locked;
  for (Eigen::Index k = 0; k < n; ++k) {
    for (const RowSide* s : {&rows[size_t(k)].a, &rows[size_t(k)].b}) {
      if (s->block == no_block) continue;
      for (const End& e : ends_[s->block]) {
        jointed[size_t(k)] = 1;
        for (size_t r = first_row_[e.owner]; r < first_row_[e.owner + 1]; ++r)
          y(Eigen::Index(r), k) += product(side(r, e.side), blocks[s->block], *s);
      }
    }
    charge_work(size_t(m) + 50);
    if (jointed[size_t(k)]) factor_.forward({&y(0, k), size_t(m)});
  }
  const std::span<const double> inverse = factor_.inverse_pivots();
  std::vector<double> scaled(size_t(m), 0.0);
  for (Eigen::Index k = 0; k < n; ++k) {
    if (!jointed[size_t(k)]) continue;
    charge_work(size_t(m), size_t(k + 2));
    if (stop_requested()) return;
    for (Eigen::Index r = 0; r < m; ++r) scaled[size_t(r)] = inverse[size_t(r)] * y(r, k);
    const double free = delassus(k, k);
    for (Eigen::Index i = 0; i <= k; ++i) {
      if (!jointed[size_t(i)]) continue;
      double sum = 0;
      for (Eigen::Index r = 0; r < m; ++r) sum += scaled[size_t(r)] * y(r, i);
      delassus(i, k) = delassus(k, i) = delassus(i, k) - sum;
    }
    if (delassus(k, k) > tolerances::locked_share * free) continue;
    // No push changes this velocity, nor needs to: by itself, as of free bodies, it gets none.
    locked.emplace_back(k, free);
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
