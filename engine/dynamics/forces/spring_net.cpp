#include "engine/dynamics/forces/spring_net.hpp"

#include "engine/core/stop.hpp"
#include "engine/dynamics/forces/net_rows.hpp"
#include "engine/dynamics/forces/net_system.hpp"
#include "engine/dynamics/forces/tolerances.hpp"
#include "engine/math/dense.hpp"
#include "engine/math/rotation.hpp"

#include <cmath>

#include <Eigen/Cholesky>

namespace tumble {
namespace {

using Mat6 = Eigen::Matrix<double, 6, 6>;

/// Solves for the change of the velocities of a net, in memory that it keeps for the next.
class NetSolver {
 public:
  void start(const SpringNet& net) {
    net_ = &net;
    first_.clear();
    dofs_ = 0;
    for (const SpringNet::Node& node : net.nodes) {
      first_.push_back(dofs_);
      dofs_ += node.turns ? 6 : 3;
    }
    prepare_rows(net, rows_, stiffness_);
    prepare_blocks();
  }

  SpringNet::Report solve() {
    right_hand_side(r_);
    change_.setZero(dofs_);
    product_.resize(dofs_);
    precondition(r_, y_);
    p_ = y_;
    double ry = r_.dot(y_);
    SpringNet::Report report;
    while (report.iterations < tolerances::most_net_iterations) {
      report.residual = residual(r_);
      if (!(report.residual > tolerances::net_residual) || !(ry > 0)) break;
      if (stop_requested()) break;
      multiply(p_, product_);
      const double alpha = ry / p_.dot(product_);
      change_ += alpha * p_;
      r_ -= alpha * product_;
      precondition(r_, y_);
      const double next = r_.dot(y_);
      p_ = y_ + (next / ry) * p_;
      ry = next;
      ++report.iterations;
    }
    return report;
  }

  SpringNet::Pull pull(size_t i) const {
    const SpringNet::Tie& tie = net_->ties[i];
    const NetRow& row = rows_[i];
    SpringNet::Pull out;
    out.force = row.pull + row.times_E(moves_apart(tie, change_)) / net_->h;
    out.elastic = tie.stiffness * (tie.d.norm() - tie.rest_length) * row.n;
    out.turn_a = -turned(tie.a, row.turn_a);
    out.turn_b = -turned(tie.b, row.turn_b);
    return out;
  }
  bool pulls(size_t i) const { return !rows_[i].n.isZero(0); }

 private:
  /// The blocks of the matrix on its diagonal, inverted: its preconditioner.
  void prepare_blocks() {
    whole_of_.clear();
    blocks_.clear();
    inverse_inertia_.clear();
    whole_.clear();
    for (size_t k = 0; k < net_->nodes.size(); ++k) {
      const SpringNet::Node& node = net_->nodes[k];
      whole_of_.push_back(whole_.size());
      blocks_.push_back(node.mass * Mat3::Identity());
      inverse_inertia_.push_back(node.turns ? Mat3(node.inertia.inverse()) : Mat3(Mat3::Zero()));
      if (node.turns)
        whole_.emplace_back(Mat6::Zero()).bottomRightCorner<3, 3>() = dense(node.inertia);
    }
    for (size_t i = 0; i < rows_.size(); ++i) {
      add_block(net_->ties[i].a, rows_[i], rows_[i].turn_a);
      add_block(net_->ties[i].b, rows_[i], rows_[i].turn_b);
    }
    for (size_t k = 0; k < net_->nodes.size(); ++k) {
      if (net_->nodes[k].turns) {
        Mat6& block = whole_[whole_of_[k]];
        block.topLeftCorner<3, 3>() = dense(blocks_[k]);
        block = block.llt().solve(Mat6::Identity()).eval();
      } else {
        blocks_[k] = blocks_[k].inverse();
      }
    }
  }
  void add_block(const SpringNet::End& end, const NetRow& row, double turn) {
    if (end.node == SpringNet::fixed) return;
    const Mat3 nn = row.n * row.n.transpose();
    const Mat3 E = row.along * nn + row.across * (Mat3::Identity() - nn);
    blocks_[end.node] += E;
    if (!net_->nodes[end.node].turns) return;
    const Mat3 arm = skew(end.arm), arm_E = arm * E;
    Mat6& block = whole_[whole_of_[end.node]];
    block.bottomLeftCorner<3, 3>() += dense(arm_E);
    block.topRightCorner<3, 3>() += dense(arm_E).transpose();
    block.bottomRightCorner<3, 3>() -= dense(arm_E * arm);
    block.bottomRightCorner<3, 3>() += net_->h * net_->h * turn * Eigen::Matrix3d::Identity();
  }

  void right_hand_side(Eigen::VectorXd& b) const {
    b.resize(dofs_);
    for (size_t k = 0; k < net_->nodes.size(); ++k) {
      const SpringNet::Node& node = net_->nodes[k];
      b.segment<3>(first_[k]) = node.mass * dense(node.dv_free);
      if (node.turns) b.segment<3>(first_[k] + 3) = dense(node.inertia) * dense(node.domega_free);
    }
    for (size_t i = 0; i < rows_.size(); ++i) {
      const SpringNet::Tie& tie = net_->ties[i];
      push(tie.a, net_->h * rows_[i].pull, b);
      push(tie.b, -net_->h * rows_[i].pull, b);
      turn(tie.a, rows_[i].turn_a, omega_of(tie.a), net_->h * (net_->h - net_->lead), b);
      turn(tie.b, rows_[i].turn_b, omega_of(tie.b), net_->h * (net_->h - net_->lead), b);
    }
  }

  void multiply(const Eigen::VectorXd& x, Eigen::VectorXd& out) const {
    for (size_t k = 0; k < net_->nodes.size(); ++k) {
      const SpringNet::Node& node = net_->nodes[k];
      out.segment<3>(first_[k]) = node.mass * x.segment<3>(first_[k]);
      if (node.turns)
        out.segment<3>(first_[k] + 3) = dense(node.inertia) * x.segment<3>(first_[k] + 3);
    }
    for (size_t i = 0; i < rows_.size(); ++i) {
      const SpringNet::Tie& tie = net_->ties[i];
      const Vec3 f = rows_[i].times_E(moves_apart(tie, x));
      push(tie.a, -f, out);
      push(tie.b, f, out);
      const double h2 = net_->h * net_->h;
      if (rows_[i].turn_a != 0) turn(tie.a, rows_[i].turn_a, turn_of(tie.a, x), -h2, out);
      if (rows_[i].turn_b != 0) turn(tie.b, rows_[i].turn_b, turn_of(tie.b, x), -h2, out);
    }
  }

  Vec3 velocity(const SpringNet::End& end, const Eigen::VectorXd& x) const {
    if (end.node == SpringNet::fixed) return Vec3::Zero();
    const Vec3 v = small_vector(x.segment<3>(first_[end.node]));
    if (!net_->nodes[end.node].turns) return v;
    return v + turn_of(end, x).cross(end.arm);
  }
  Vec3 turn_of(const SpringNet::End& end, const Eigen::VectorXd& x) const {
    return small_vector(x.segment<3>(first_[end.node] + 3));
  }
  Vec3 omega_of(const SpringNet::End& end) const {
    return end.node == SpringNet::fixed ? Vec3(Vec3::Zero()) : net_->nodes[end.node].omega;
  }
  Vec3 moves_apart(const SpringNet::Tie& tie, const Eigen::VectorXd& x) const {
    return velocity(tie.b, x) - velocity(tie.a, x);
  }
  void push(const SpringNet::End& end, const Vec3& impulse, Eigen::VectorXd& out) const {
    if (end.node == SpringNet::fixed) return;
    out.segment<3>(first_[end.node]) += dense(impulse);
    if (net_->nodes[end.node].turns)
      out.segment<3>(first_[end.node] + 3) += dense(end.arm.cross(impulse));
  }
  /// Subtracts what the stiffness against turning does to the moments, over `time` squared.
  void turn(const SpringNet::End& end, double stiffness, const Vec3& omega, double time2,
            Eigen::VectorXd& out) const {
    if (end.node == SpringNet::fixed || !net_->nodes[end.node].turns || stiffness == 0) return;
    out.segment<3>(first_[end.node] + 3) -= time2 * stiffness * dense(across_arm(end.arm, omega));
  }
  Vec3 turned(const SpringNet::End& end, double stiffness) const {
    if (end.node == SpringNet::fixed || !net_->nodes[end.node].turns || stiffness == 0)
      return Vec3::Zero();
    const Vec3 turn = (net_->h - net_->lead) * omega_of(end) + net_->h * turn_of(end, change_);
    return stiffness * across_arm(end.arm, turn);
  }

  void precondition(const Eigen::VectorXd& r, Eigen::VectorXd& out) const {
    out.resize(dofs_);
    for (size_t k = 0; k < net_->nodes.size(); ++k) {
      if (net_->nodes[k].turns)
        out.segment<6>(first_[k]) = whole_[whole_of_[k]] * r.segment<6>(first_[k]);
      else
        out.segment<3>(first_[k]) = dense(blocks_[k]) * r.segment<3>(first_[k]);
    }
  }
  /// SpringNet::Report::residual.
  double residual(const Eigen::VectorXd& r) const {
    double left = 0, all = 0;
    for (size_t k = 0; k < net_->nodes.size(); ++k) {
      const SpringNet::Node& node = net_->nodes[k];
      left += r.segment<3>(first_[k]).squaredNorm() / node.mass;
      all += node.mass * change_.segment<3>(first_[k]).squaredNorm();
      if (!node.turns) continue;
      const Vec3 moment = small_vector(r.segment<3>(first_[k] + 3)),
                 spin = small_vector(change_.segment<3>(first_[k] + 3));
      left += moment.dot(inverse_inertia_[k] * moment);
      all += spin.dot(node.inertia * spin);
    }
    if (!(left > 0)) return 0;
    return all > 0 ? std::sqrt(left / all) : 1;
  }

  const SpringNet* net_ = nullptr;
  std::vector<NetRow> rows_;
  std::vector<Eigen::Index> first_;  ///< by node: its first number
  Eigen::Index dofs_ = 0;
  std::vector<Mat3> blocks_;             ///< by node
  std::vector<Mat6> whole_;              ///< of those that turn
  std::vector<size_t> whole_of_;         ///< by node: its place there
  std::vector<Mat3> inverse_inertia_;    ///< by node
  std::vector<double> stiffness_;        ///< of prepare_rows()
  Eigen::VectorXd change_;               ///< of the velocities
  Eigen::VectorXd r_, y_, p_, product_;  ///< of conjugate gradients
};

}  // namespace

SpringNet::Report SpringNet::solve(std::vector<Pull>& out) const {
  out.assign(ties.size(), {});
  thread_local NetSolver solver;
  solver.start(*this);
  const Report report = solver.solve();
  for (size_t i = 0; i < ties.size(); ++i)
    if (solver.pulls(i)) out[i] = solver.pull(i);
  return report;
}

void SpringNet::solve_meshed(Answer& out) const {
  thread_local NetSystem system;
  system.solve(*this, out);
}

}  // namespace tumble
