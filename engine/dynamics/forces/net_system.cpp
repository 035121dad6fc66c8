#include "engine/dynamics/forces/net_system.hpp"

#include "engine/core/stop.hpp"
#include "engine/dynamics/forces/tolerances.hpp"
#include "engine/math/dense.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>

namespace tumble {
namespace {

Mat3 block_of(const NetPart& a, const Mat3& E, const NetPart& b) {
  if (a.plain && b.plain) return (a.weight * b.weight) * E;
  return a.full().transpose() * E * b.full();
}

/// In single precision, its transpose by rows: combine() then multiplies with the matrix.
Rows3 columns_of(const Mat3& m) {
  return {{Float4::round(m(0, 0), m(1, 0), m(2, 0)), Float4::round(m(0, 1), m(1, 1), m(2, 1)),
           Float4::round(m(0, 2), m(1, 2), m(2, 2))}};
}

void add_scaled(Rows3& sum, Float4 factor, const Rows3& m) {
  for (size_t k = 0; k < 3; ++k) sum.row[k] = sum.row[k] + factor * m.row[k];
}

double dot(std::span<const Float4> a, std::span<const Float4> b) {
  double sum = 0;
  for (size_t i = 0; i < a.size(); ++i) sum += double(dot3(a[i], b[i]));
  return sum;
}

}  // namespace

void NetSystem::put_together() {
  off_.assign(pattern_.columns.size(), {});
  diagonal_.assign(pattern_.blocks, Mat3::Zero());
  for (size_t k = 0; k < net_->nodes.size(); ++k) {
    const SpringNet::Node& node = net_->nodes[k];
    const NetPattern::Blocks blocks = pattern_.of_node[k];
    diagonal_[blocks.moves] = node.mass * Mat3::Identity();
    if (node.turns) diagonal_[blocks.turns] = node.inertia;
  }
  const uint32_t* place = pattern_.places.data();
  for (size_t i = 0; i < rows_.size(); ++i) place = put_tie(i, place);
  for (size_t i = 0; i < bows_.size(); ++i) place = put_bow(i, place);
}

/// Adds J^T E J for every two parts of a row; gives the place of the next row.
const uint32_t* NetSystem::put(const NetParts& parts, const Mat3& E, const uint32_t* place) {
  for (uint32_t i = 0; i < parts.count; ++i)
    for (uint32_t j = 0; j < parts.count; ++j) {
      const Mat3 block = block_of(parts.at[i], E, parts.at[j]);
      if (i == j)
        diagonal_[parts.at[i].block] += block;
      else
        add_scaled(off_[*place++], Float4(1), columns_of(block));
    }
  return place;
}

const uint32_t* NetSystem::put_tie(size_t i, const uint32_t* place) {
  const SpringNet::Tie& tie = net_->ties[i];
  const Mat3 nn = rows_[i].n * rows_[i].n.transpose();
  const Mat3 E = rows_[i].along * nn + rows_[i].across * (Mat3::Identity() - nn);
  const NetPattern::Blocks a = pattern_.blocks_of(tie.a), b = pattern_.blocks_of(tie.b);
  constexpr uint32_t none = NetPattern::none;
  if (a.turns != none || b.turns != none || a.moves == b.moves) {
    place = put(parts_of(pattern_, tie), E, place);
    add_turning(tie.a, rows_[i].turn_a);
    add_turning(tie.b, rows_[i].turn_b);
    return place;
  }
  // The common case of the same.
  if (a.moves != none) diagonal_[a.moves] += E;
  if (b.moves != none) diagonal_[b.moves] += E;
  if (a.moves == none || b.moves == none) return place;
  const Rows3 columns = columns_of(E);
  for (int side = 0; side < 2; ++side) add_scaled(off_[*place++], Float4(-1), columns);
  return place;
}

const uint32_t* NetSystem::put_bow(size_t i, const uint32_t* place) {
  const SpringNet::Stencil& s = net_->stencils[i];
  const Mat3 E =
      bows_[i].e * Mat3::Identity() + bows_[i].along * bows_[i].n * bows_[i].n.transpose();
  const Rows3 columns = columns_of(E);
  std::array<uint32_t, 4> block{};
  std::array<double, 4> weight{};
  uint32_t count = 0;
  bool plain = true;
  for (uint32_t k = 0; k < s.count; ++k) {
    const NetPattern::Blocks at = pattern_.blocks_of(s.end[k]);
    if (at.moves == NetPattern::none) continue;
    plain = plain && at.turns == NetPattern::none &&
            std::find(block.begin(), block.begin() + count, at.moves) == block.begin() + count;
    block[count] = at.moves, weight[count++] = s.weight[k];
  }
  if (!plain) return put(parts_of(pattern_, s), E, place);
  for (uint32_t j = 0; j < count; ++j)
    for (uint32_t k = 0; k < count; ++k) {
      const double w = weight[j] * weight[k];
      if (j == k)
        diagonal_[block[j]] += w * E;
      else
        add_scaled(off_[*place++], Float4(float(w)), columns);
    }
  return place;
}

void NetSystem::add_turning(const SpringNet::End& end, double turn) {
  const NetPattern::Blocks blocks = pattern_.blocks_of(end);
  const double r2 = end.arm.squaredNorm();
  if (turn == 0 || blocks.turns == NetPattern::none || !(r2 > 0)) return;
  diagonal_[blocks.turns] +=
      (net_->h * net_->h * turn) * (Mat3::Identity() - end.arm * end.arm.transpose() / r2);
}

void NetSystem::invert_diagonal() {
  inverse_.resize(diagonal_.size());
  diagonal4_.resize(diagonal_.size());
  for (size_t i = 0; i < diagonal_.size(); ++i) {
    inverse_[i] = columns_of(diagonal_[i].inverse());
    diagonal4_[i] = columns_of(diagonal_[i]);
  }
}

Vec3 NetSystem::velocity(const SpringNet::End& end, const std::vector<Vec3>& x) const {
  const NetPattern::Blocks blocks = pattern_.blocks_of(end);
  if (blocks.moves == NetPattern::none) return Vec3::Zero();
  if (blocks.turns == NetPattern::none) return x[blocks.moves];
  return x[blocks.moves] + x[blocks.turns].cross(end.arm);
}

Vec3 NetSystem::moves_apart(const SpringNet::Tie& tie, const std::vector<Vec3>& x) const {
  return velocity(tie.b, x) - velocity(tie.a, x);
}

void NetSystem::push(const SpringNet::End& end, const Vec3& impulse, std::vector<Vec3>& out) const {
  const NetPattern::Blocks blocks = pattern_.blocks_of(end);
  if (blocks.moves == NetPattern::none) return;
  out[blocks.moves] += impulse;
  if (blocks.turns != NetPattern::none) out[blocks.turns] += end.arm.cross(impulse);
}

/// Right-hand side less matrix times change_, from the rows.
void NetSystem::residual(std::vector<Vec3>& out) const {
  const double h = net_->h;
  out.resize(pattern_.blocks);
  for (size_t k = 0; k < net_->nodes.size(); ++k) {
    const SpringNet::Node& node = net_->nodes[k];
    const NetPattern::Blocks blocks = pattern_.of_node[k];
    out[blocks.moves] = node.mass * (node.dv_free - change_[blocks.moves]);
    if (node.turns) out[blocks.turns] = node.inertia * (node.domega_free - change_[blocks.turns]);
  }
  const auto turn = [&](const SpringNet::End& end, double stiffness) {
    if (stiffness == 0 || end.node == SpringNet::fixed) return;
    const uint32_t block = pattern_.of_node[end.node].turns;
    if (block == NetPattern::none) return;
    const Vec3 turned = (h - net_->lead) * net_->nodes[end.node].omega + h * change_[block];
    out[block] -= (h * stiffness) * across_arm(end.arm, turned);
  };
  for (size_t i = 0; i < rows_.size(); ++i) {
    const SpringNet::Tie& tie = net_->ties[i];
    const Vec3 impulse = h * rows_[i].pull + rows_[i].times_E(moves_apart(tie, change_));
    push(tie.a, impulse, out);
    push(tie.b, -impulse, out);
    turn(tie.a, rows_[i].turn_a);
    turn(tie.b, rows_[i].turn_b);
  }
  for (size_t i = 0; i < bows_.size(); ++i) {
    const SpringNet::Stencil& s = net_->stencils[i];
    Vec3 sum = Vec3::Zero();
    for (uint32_t k = 0; k < s.count; ++k) sum += s.weight[k] * velocity(s.end[k], change_);
    const Vec3 impulse = h * bows_[i].pull + bows_[i].times_E(sum);
    for (uint32_t k = 0; k < s.count; ++k) push(s.end[k], -s.weight[k] * impulse, out);
  }
}

/// In the norm of the inverted diagonal.
double NetSystem::size(std::span<const Vec3> r) const {
  double sum = 0;
  for (size_t i = 0; i < r.size(); ++i) {
    const Float4 x = Float4::round(r[i].x(), r[i].y(), r[i].z());
    sum += double(dot3(x, inverse_[i].combine(x)));
  }
  return std::sqrt(std::max(0.0, sum));
}

void NetSystem::apply(std::span<const Float4> x, std::span<Float4> y) const {
  const uint32_t* start = pattern_.row_start.data();
  const uint32_t* column = pattern_.columns.data();
  for (size_t i = 0; i < x.size(); ++i) {
    Float4 sum = diagonal4_[i].combine(x[i]);
    for (uint32_t k = start[i]; k < start[i + 1]; ++k) sum = sum + off_[k].combine(x[column[k]]);
    y[i] = sum;
  }
}

void NetSystem::precondition(std::span<const Float4> r, std::span<Float4> y) const {
  for (size_t i = 0; i < r.size(); ++i) y[i] = inverse_[i].combine(r[i]);
}

/// Adds to change_ what solves for r, until so much of it is left; counts steps.
int NetSystem::correct(std::span<const Vec3> r, double target) {
  const size_t n = r.size();
  for (std::vector<Float4>* v : {&residual_, &y_, &p_, &product_, &correction_})
    v->assign(n, Float4());
  for (size_t i = 0; i < n; ++i) residual_[i] = Float4::round(r[i].x(), r[i].y(), r[i].z());
  precondition(residual_, y_);
  p_ = y_;
  double ry = dot(residual_, y_);
  int steps = 0;
  while (steps < tolerances::most_mesh_net_steps && ry > target * target) {
    if (stop_requested()) break;
    apply(p_, product_);
    const double curvature = dot(p_, product_);
    if (!(curvature > 0)) break;  // rounding is all that is left
    const Float4 alpha(float(ry / curvature));
    for (size_t i = 0; i < n; ++i) {
      correction_[i] = correction_[i] + alpha * p_[i];
      residual_[i] = residual_[i] - alpha * product_[i];
    }
    precondition(residual_, y_);
    const double next = dot(residual_, y_);
    const Float4 beta(float(next / ry));
    for (size_t i = 0; i < n; ++i) p_[i] = y_[i] + beta * p_[i];
    ry = next;
    ++steps;
  }
  for (size_t i = 0; i < n; ++i) {
    const std::array<float, 4> c = correction_[i].array();
    change_[i] += Vec3(double(c[0]), double(c[1]), double(c[2]));
  }
  return steps;
}

void NetSystem::solve(const SpringNet& net, SpringNet::Answer& out) {
  net_ = &net;
  prepare_rows(net, rows_, stiffness_);
  prepare_bows(net, stiffness_, bows_);
  pattern_.number(net);
  pattern_.find(net);
  put_together();
  invert_diagonal();
  change_.assign(pattern_.blocks, Vec3::Zero());
  out.report = {};
  double reference = 0;
  for (int round = 0; round < tolerances::most_mesh_net_rounds; ++round) {
    residual(r_);
    const double left = size(r_);
    if (round == 0) {
      std::vector<Vec3> weight(pattern_.blocks, Vec3::Zero());
      for (size_t k = 0; k < net.nodes.size(); ++k)
        weight[pattern_.of_node[k].moves] = net.nodes[k].mass * net.nodes[k].dv_free;
      reference = std::max(left, size(weight));
    }
    if (!(reference > 0)) break;
    out.report.residual = left / reference;
    if (left <= tolerances::mesh_net_residual * reference || stop_requested()) break;
    out.report.iterations += correct(r_, 0.5 * tolerances::mesh_net_residual * reference);
  }
  answer(out);
}

void NetSystem::answer(SpringNet::Answer& out) const {
  out.ties.assign(rows_.size(), {});
  for (size_t i = 0; i < rows_.size(); ++i) {
    const SpringNet::Tie& tie = net_->ties[i];
    if (rows_[i].n.isZero(0)) continue;
    SpringNet::Pull& pull = out.ties[i];
    pull.force = rows_[i].pull + rows_[i].times_E(moves_apart(tie, change_)) / net_->h;
    pull.elastic = tie.stiffness * (tie.d.norm() - tie.rest_length) * rows_[i].n;
    const auto turned = [&](const SpringNet::End& end, double stiffness) -> Vec3 {
      const uint32_t block = pattern_.blocks_of(end).turns;
      if (stiffness == 0 || block == NetPattern::none) return Vec3::Zero();
      const Vec3 turn =
          (net_->h - net_->lead) * net_->nodes[end.node].omega + net_->h * change_[block];
      return stiffness * across_arm(end.arm, turn);
    };
    pull.turn_a = -turned(tie.a, rows_[i].turn_a);
    pull.turn_b = -turned(tie.b, rows_[i].turn_b);
  }
  out.stencils.resize(bows_.size());
  for (size_t i = 0; i < bows_.size(); ++i) {
    const SpringNet::Stencil& s = net_->stencils[i];
    Vec3 sum = Vec3::Zero();
    for (uint32_t k = 0; k < s.count; ++k) sum += s.weight[k] * velocity(s.end[k], change_);
    out.stencils[i] = {bows_[i].pull + bows_[i].times_E(sum) / net_->h, s.stiffness * s.q};
  }
  rest(out.rest_force, out.rest_torque);
}

/// What is left of the residual, as forces: with them the nodes get the velocities that were solved
/// for.
void NetSystem::rest(std::vector<Vec3>& force, std::vector<Vec3>& torque) const {
  std::vector<Vec3> r;
  residual(r);
  const size_t count = net_->nodes.size();
  force.assign(count, Vec3::Zero());
  torque.assign(count, Vec3::Zero());
  for (size_t k = 0; k < count; ++k) {
    const NetPattern::Blocks blocks = pattern_.of_node[k];
    if (!net_->nodes[k].meshed) continue;
    force[k] = -r[blocks.moves] / net_->h;
    if (blocks.turns != NetPattern::none) torque[k] = -r[blocks.turns] / net_->h;
  }
  if (!is_held()) take_rigid_motion(r, force, torque);
}

/// Whether points that nothing moves hold some of its nodes.
bool NetSystem::is_held() const {
  const auto is_fixed = [](const SpringNet::End& end) { return end.node == SpringNet::fixed; };
  bool held = false;
  for (const SpringNet::Tie& tie : net_->ties) held = held || is_fixed(tie.a) || is_fixed(tie.b);
  for (const SpringNet::Stencil& s : net_->stencils)
    for (uint32_t i = 0; i < s.count; ++i) held = held || is_fixed(s.end[i]);
  return held;
}

/// The forces of all springs of a free net on its nodes must have neither sum nor moment; what they
/// have (backward Euler gives them a moment) a motion of all of the net as one rigid body takes
/// away. `left` is the residual.
void NetSystem::take_rigid_motion(std::span<const Vec3> left, std::vector<Vec3>& force,
                                  std::vector<Vec3>& torque) const {
  const size_t count = net_->nodes.size();
  double mass = 0;
  Vec3 centre = Vec3::Zero(), sum = Vec3::Zero(), moment = Vec3::Zero();
  for (const SpringNet::Node& node : net_->nodes) {
    if (!node.meshed) continue;
    mass += node.mass;
    centre += node.mass * node.x;
  }
  centre /= mass;
  Mat3 inertia = Mat3::Zero();
  for (size_t k = 0; k < count; ++k) {
    const SpringNet::Node& node = net_->nodes[k];
    if (!node.meshed) continue;
    const Mat3 arm = skew(node.x - centre);
    inertia += node.inertia - node.mass * arm * arm;
  }
  for (size_t k = 0; k < count; ++k) {
    const SpringNet::Node& node = net_->nodes[k];
    const NetPattern::Blocks blocks = pattern_.of_node[k];
    // All that the springs do to it: what its change needs, or what the pulls give.
    const double short_of = node.meshed ? 0 : 1;
    const Vec3 push =
        (node.mass * (change_[blocks.moves] - node.dv_free) + short_of * left[blocks.moves]) /
        net_->h;
    sum += push;
    moment += (node.x - centre).cross(push);
    if (blocks.turns != NetPattern::none)
      moment += (node.inertia * (change_[blocks.turns] - node.domega_free) +
                 short_of * left[blocks.turns]) /
                net_->h;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(dense(inertia));
  const Mat3 R = small_matrix(axes.eigenvectors());
  Vec3 spin = R.transpose() * moment;
  // A straight rope has no moment along itself, and no inertia but rounding.
  for (int i = 0; i < 3; ++i) {
    const double about = axes.eigenvalues()[i];
    spin[i] = about > tolerances::no_rope_inertia * axes.eigenvalues()[2] ? spin[i] / about : 0;
  }
  spin = R * spin;
  for (size_t k = 0; k < count; ++k) {
    const SpringNet::Node& node = net_->nodes[k];
    if (!node.meshed) continue;
    force[k] -= node.mass * (sum / mass + spin.cross(node.x - centre));
    torque[k] -= node.inertia * spin;
  }
}

}  // namespace tumble
