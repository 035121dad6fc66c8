#pragma once
#include "engine/dynamics/joints/joint.hpp"
#include "engine/math/block_ldl.hpp"

#include <span>
#include <vector>

#include <Eigen/Core>

namespace tumble {

/// The joints of a group of bodies as equations for exact steppers, of accelerations, velocities
/// and displacements (Coutinho 2013 §5.4, §5.6). What joints change is the least in the metric of
/// mass; with G for their Jacobian, bodies answer pushes from outside by
///   W = M^-1 - M^-1 G^T (G M^-1 G^T)^+ G M^-1
/// instead of M^-1. Redundant joints (closed loops) are allowed. The cost is linear in the number
/// of bodies for chains and trees (Baraff 1996 by other means: the complement's graph is chordal).
class Articulation {
 public:
  Articulation() = default;
  /// `which` of the joints hold; their blocks are block_of[slot], of `blocks` many, no_block for
  /// what nothing moves.
  Articulation(std::span<const Joint> joints, std::span<const uint32_t> which,
               std::span<const uint32_t> block_of, std::span<const RigidBody> bodies,
               size_t blocks);

  bool empty() const { return joints_.empty(); }
  /// Takes the bodies' present poses and velocities, and the masses of the blocks.
  void update(std::span<const RigidBody> bodies, std::span<const DofBlock> blocks);

  /// As of update(), joint after joint.
  std::span<const JointRow> rows() const { return rows_; }
  /// How many rows there are.
  size_t size() const { return factor_.size(); }
  size_t joints() const { return joints_.size(); }
  /// The rows of one joint begin here; of joints(): where all end.
  size_t first_row(size_t joint) const { return first_row_[joint]; }
  /// How many rows depended on others at the last update().
  size_t dependent_rows() const { return factor_.dependent(); }
  /// Greatest |C| [m, rad].
  double error() const;

  /// Changes velocities so that J v of every row is what `target(row)` says, as far as rows that
  /// depend on each other allow; adds the impulses by row to `pushes`.
  template <class Target>
  void hold(const Target& target, std::span<DofBlock> blocks, std::span<double> pushes) const {
    // The second time takes what rounding left.
    for (int pass = 0; pass < 2; ++pass) {
      std::vector<double> change(rows_.size());
      for (size_t i = 0; i < rows_.size(); ++i)
        change[i] = target(rows_[i]) - row_velocity(rows_[i].row, blocks);
      apply_change(change, blocks, pushes);
    }
  }
  /// Accelerations in the place of velocities, so that d2C/dt2 = 0.
  void hold_accelerations(std::span<DofBlock> accelerations, std::span<double> forces) const {
    hold([](const JointRow& r) { return -r.bias; }, accelerations, forces);
  }
  void hold_velocities(std::span<DofBlock> velocities, std::span<double> impulses) const {
    hold([](const JointRow&) { return 0.0; }, velocities, impulses);
  }

  /// From the Delassus matrix of rows of free bodies to that of jointed ones, J W J^T. Rows that
  /// joints lock keep their entry on the diagonal and are coupled to nothing.
  void reduce(std::span<const Row> rows, std::span<const DofBlock> blocks,
              Eigen::MatrixXd& delassus) const;

 private:
  /// A joint's share in a body.
  struct End {
    uint32_t joint;
    bool at_b;
  };
  void apply_change(std::span<double> change, std::span<DofBlock> blocks,
                    std::span<double> pushes) const;
  const RowSide& side(size_t row, bool at_b) const {
    return at_b ? rows_[row].row.b : rows_[row].row.a;
  }

  std::vector<Joint> joints_;
  std::vector<uint32_t> block_of_;  ///< two by joint
  std::vector<size_t> first_row_;
  std::vector<std::vector<End>> ends_;  ///< by block that moves
  std::vector<JointRow> rows_;
  BlockLdl factor_;
};

/// The blocks of bodies, with their velocities.
std::vector<DofBlock> blocks_of(std::span<const RigidBody> bodies, std::span<const uint32_t> slots);

}  // namespace tumble
