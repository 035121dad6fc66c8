#pragma once
#include "engine/dynamics/joints/folded_trees.hpp"
#include "engine/dynamics/joints/joint_coupling.hpp"
#include "engine/dynamics/joints/tolerances.hpp"
#include "engine/math/block_ldl.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include <Eigen/Core>

namespace tumble {

/// What a row of an Articulation belongs to.
enum class RowUse : uint8_t {
  part,      ///< a constraint of a part of a joint
  armature,  ///< inertia along a coordinate
  motor,     ///< a motor of unlimited force, which holds a rate
  coupling,
};

/// What is known of a row of an Articulation besides its Jacobian.
struct HeldRow {
  RowUse use = RowUse::part;
  uint32_t owner = 0;  ///< index of its joint, or coupling, among the chosen ones
  uint8_t place = 0;   ///< index in the joint: rows of its parts, then one for each coordinate
  /// Compliance of the row: acceleration along the row per force on it that is not constrained. For
  /// the rotor behind an armature I it is 1/I, since F = -I x''; zero for all other rows.
  double give = 0;
  /// The velocity that is held; for an armature, that of its rotor at the last update() [m/s,
  /// rad/s].
  double rate = 0;
};

/// Inverse mass and inertia of a body by itself.
struct BodyMass {
  double inverse_mass = 0;
  Mat3 inverse_inertia = Mat3::Zero();
};

/// The joints of a group of bodies as equations for exact steppers, for accelerations, velocities
/// and displacements (Coutinho 2013 §5.4, §5.6). The change that joints cause is the least in the
/// norm of kinetic energy. With G for their Jacobian, the bodies respond to external pushes by
///   W = M^-1 - M^-1 G^T (G M^-1 G^T + C)^+ G M^-1
/// instead of M^-1. C is diagonal: a row with C = 1/I is an inertia I along it, since W is then the
/// inverse of M + G^T I G (Woodbury). Redundant joints (closed loops) are allowed.
///
/// Trees are eliminated from their leaves inwards (FoldedTrees), at a cost that is linear in the
/// number of bodies. What remains, where joints or couplings form loops or bodies do not rotate, is
/// the core: equations of the rows there,
///   (G M'^-1 G^T + C) f = change,
/// with M' the masses of bodies including everything that was folded into them, in sparse blocks.
/// The cost of a core grows with the cube of the number of rows that must be cut to open all its
/// loops.
class Articulation {
 public:
  /// Whether armatures and motors of unlimited force along coordinates have rows too.
  enum class Drives : uint8_t { none, held };

  Articulation() = default;
  /// `which` names the joints that hold, and their couplings, each of which has a joint among
  /// these. block_of[slot] < `blocks` is the block of a body, no_block for immovable ones.
  Articulation(const JointsAndCouplings& all, const JointChoice& which,
               std::span<const uint32_t> block_of, std::span<const RigidBody> bodies, size_t blocks,
               Drives drives = Drives::held);

  /// Replaces the joints by others, with the same result as a new Articulation of those but without
  /// a new layout. Returns false and does nothing if the others do not connect the same blocks by
  /// the same kinds, or if there are rows other than those of parts.
  bool renew(const JointsAndCouplings& all, const JointChoice& which,
             std::span<const uint32_t> block_of, std::span<const RigidBody> bodies, size_t blocks,
             Drives drives = Drives::held);

  bool empty() const { return joints_.empty(); }
  /// Updates the equations to the bodies' present poses and velocities and the masses of the
  /// blocks, `t` seconds since the tick began, when the values of coordinates were known.
  void update(std::span<const RigidBody> bodies, std::span<const DofBlock> blocks, double t = 0) {
    look(bodies, t);
    factor(blocks);
  }
  /// The two halves of update(): look() computes rows and their errors; factor() what solutions
  /// need. `inertias` are, by block, the inverses of those of the blocks; computed if not given.
  void look(std::span<const RigidBody> bodies, double t = 0);
  void factor(std::span<const DofBlock> blocks, std::span<const Mat3> inertias = {});
  /// look(), unless nothing has been done since the last look() and the bodies have not moved. In
  /// that case the biases of rows, which depend on velocities, are not updated.
  void look_where_moved(std::span<const RigidBody> bodies, double t = 0);

  /// As of the last update(): joint by joint, then couplings, of which these are the halves of
  /// coordinate x.
  std::span<const JointRow> rows() const { return rows_; }
  std::span<const HeldRow> held() const { return held_; }
  /// The coordinate of a row of an armature or motor.
  size_t coordinate_of(size_t row) const;
  /// Sets whether the motor of a row stands still, because it drives into a limit that is reached.
  void stand(size_t row, bool stands) { stands_[row] = stands; }
  /// Velocity J v of a row less the one that it holds.
  double rate_off(size_t row, std::span<const DofBlock> blocks) const {
    return velocity(row, blocks) - held_[row].rate;
  }
  /// Whether all rows hold their velocities up to rounding, relative to the velocities that cancel
  /// in them.
  bool rates_held(std::span<const DofBlock> blocks) const;
  /// Kinetic energy of the rotors behind armatures at the bodies' present state [J].
  double rotor_energy(std::span<const RigidBody> bodies) const;
  /// Calls f(RowSide) for the sides of a row that have a block.
  template <class F>
  void for_sides(size_t row, const F& f) const {
    for (uint8_t k = 0; k < sides_of(row); ++k)
      if (const RowSide& s = side(row, k); s.block != no_block) f(s);
  }
  /// Whether every row is between two bodies only and has no compliance, so that rows() contains
  /// the whole equations.
  bool plain() const { return plain_; }
  /// Number of rows.
  size_t size() const { return held_.size(); }
  size_t joints() const { return joints_.size(); }
  /// The first row of a joint; for index joints(), the first row of the couplings.
  size_t first_row(size_t joint) const { return first_row_[joint]; }
  /// Number of rows that depended linearly on others at the last update().
  size_t dependent_rows() const { return trees_.dependent() + factor_.dependent(); }
  /// Whether a row did; it gets no force, since the rows before it hold it too.
  bool depends(size_t row) const {
    return core_row_[row] == no_row ? trees_.depends(row) : factor_.depends(core_row_[row]);
  }
  /// Greatest |C| beyond the accepted error [m, rad].
  double error() const;
  /// From here on, joints and couplings whose error exceeds `worked_off` are held at their present
  /// error less `worked_off`: the errors in rows() are what exceeds that. The error of a joint is
  /// the length of the vector of its rows' errors [m, rad]. Returns whether there are such joints.
  bool accept_errors(std::span<const RigidBody> bodies, double t, double worked_off);

  /// Changes accelerations of the blocks (stored in place of velocities) so that d2C/dt2 = 0 for
  /// every row, as far as dependent rows allow; adds the forces by row to `forces`.
  void hold_accelerations(std::span<DofBlock> accelerations, std::span<double> forces) const {
    hold([this](size_t i) { return -rows_[i].bias; }, accelerations, forces);
  }
  /// The same for velocities, to those that rows hold; impulses are added up since update().
  void hold_velocities(std::span<DofBlock> velocities, std::span<double> impulses) const {
    hold([this](size_t i) { return held_[i].rate; }, velocities, impulses);
  }
  /// The same for displacements, so that they change no row.
  void hold_displacements(std::span<DofBlock> displacements, std::span<double> pushes) const {
    hold([](size_t) { return 0.0; }, displacements, pushes);
  }
  /// The same for displacements that remove the errors of rows.
  void close(std::span<DofBlock> displacements, std::span<double> pushes) const {
    hold([this](size_t i) { return -rows_[i].error; }, displacements, pushes);
  }

  /// From the Delassus matrix of rows of free bodies to that of jointed ones, J W J^T. Rows that
  /// joints lock keep their diagonal entry and are coupled to nothing.
  void reduce(std::span<const Row> rows, Eigen::MatrixXd& delassus) const;

 private:
  /// The part of a joint or coupling (the owner) at one body.
  struct End {
    uint32_t block;
    uint32_t owner;
    uint8_t side;  ///< A and B of a joint; of a coupling, those of both joints
  };
  /// M'^-1 times a row's Jacobian on one side: the response of the body to a push along the row.
  using Answer = std::array<double, 6>;
  /// The contribution of a body to the block of the factor for two of its ends.
  struct Term {
    uint32_t p, q;  ///< indices of ends
    BlockLdl::Place to;
  };
  /// How a body responds to pushes.
  enum class Answering : uint8_t {
    stays,
    /// But does not rotate, or so easily about one axis that its tensor is badly conditioned.
    moves,
    turns,
  };
  static constexpr uint32_t no_row = ~uint32_t{0};
  struct Coupled {
    JointCoupling coupling;
    Joint a, b;
    std::array<uint32_t, 4> block_of;
    FollowedCoordinate x, y;
    Row of_y;  ///< the other half of its row, of coordinate y
  };
  /// Changes velocities so that J v of every row becomes `target(row)` less its compliance times
  /// its push.
  template <class Target>
  void hold(const Target& target, std::span<DofBlock> blocks, std::span<double> pushes) const {
    // The second pass corrects the rounding error of the first, where it is more than the last
    // digits, and what rows of a slightly later state do. Trees satisfy their rows by the order in
    // which motion is propagated outwards.
    std::vector<double>& change = change_;
    change.resize(rows_.size());
    double wanted = 0;
    for (int pass = 0; pass < 2; ++pass) {
      double most = 0;
      for (size_t i = 0; i < rows_.size(); ++i) {
        change[i] = target(i) - velocity(i, blocks) - held_[i].give * pushes[i];
        most = std::max(most, std::fabs(change[i]));
      }
      if (pass > 0 && most <= tolerances::solved_share * wanted) return;
      wanted = most;
      apply_change(change, blocks, pushes);
      if (fresh_ && core_ends_.empty()) return;
    }
  }
  /// For the body on a side of a joint.
  static Answering answering(const Joint& joint, size_t side, std::span<const RigidBody> bodies);
  void add_drives(const Joint& joint, uint32_t place);
  void update_drive(size_t row, const JointSides& sides, double t);
  void apply_change(std::span<double> change, std::span<DofBlock> blocks,
                    std::span<double> pushes) const;
  size_t owners() const { return joints_.size() + couplings_.size(); }
  uint8_t sides_of(size_t row) const { return held_[row].use == RowUse::coupling ? 4 : 2; }
  const RowSide& side(size_t row, uint8_t k) const {
    const Row& of = k < 2 ? rows_[row].row : couplings_[row - first_row_[joints_.size()]].of_y;
    return k % 2 == 0 ? of.a : of.b;
  }
  double velocity(size_t row, std::span<const DofBlock> blocks) const {
    const double v = row_velocity(rows_[row].row, blocks);
    return sides_of(row) == 2
               ? v
               : v + row_velocity(couplings_[row - first_row_[joints_.size()]].of_y, blocks);
  }
  void add_ends(std::span<const uint32_t> slots, std::span<const uint32_t> block_of,
                std::span<const RigidBody> bodies, std::span<uint32_t> blocks);
  void lay_out(size_t blocks);
  std::vector<uint8_t> fold_trees(size_t blocks);
  void lay_out_core(std::span<const uint8_t> folded, size_t blocks);
  size_t rows_of(const End& end) const { return first_row_[end.owner + 1] - first_row_[end.owner]; }
  size_t first_answer(const End& end) const;
  /// The ends at a block.
  std::span<const End> ends_at(uint32_t block) const {
    return std::span(ends_).subspan(first_end_[block], first_end_[block + 1] - first_end_[block]);
  }
  void answer(const DofBlock& block, const End& end);
  void add_term(const Term& term);
  /// Change := (G M^-1 G^T + C)^+ change; leaves the motion of tree bodies in trees_.
  void solve(std::span<double> change) const;
  JointRow update_coupling(Coupled& c, std::span<const RigidBody> bodies, double t);

  std::vector<Joint> joints_;
  std::vector<Coupled> couplings_;
  std::vector<uint32_t> block_of_;    ///< two by joint
  std::vector<Answering> answering_;  ///< likewise
  std::vector<size_t> first_row_;     ///< by owner
  std::vector<End> ends_;             ///< sorted by block (movable ones only), then by owner
  std::vector<uint32_t> first_end_;   ///< by block
  FoldedTrees trees_;
  std::vector<uint32_t> tree_blocks_;
  std::vector<uint32_t> core_ends_;  ///< ends in the core
  std::vector<uint32_t> core_row_;   ///< by row: index in the core's factor
  std::vector<Answer> answers_;      ///< two per row, then two more for couplings; only of the core
  std::vector<Term> terms_;
  /// Core rows with compliance, and its place in the factor.
  std::vector<std::pair<uint32_t, size_t>> core_gives_;
  std::vector<BodyMass> masses_;  ///< by block
  std::vector<double> gives_;     ///< by row: compliance
  std::vector<JointRow> rows_;
  std::vector<double> accepted_;  ///< by row: accepted error; empty if none
  std::vector<HeldRow> held_;     ///< by row
  bool plain_ = true, parts_only_ = true;
  std::vector<uint8_t> stands_;  ///< by row: the motor stands still
  BlockLdl factor_;              ///< of the core
  bool fresh_ = false;           ///< the rows are those of the last factor()
  /// Two per joint: poses of the bodies at the last look(); otherwise empty.
  std::vector<Pose> seen_;
  // Scratch memory: only one thread at a time may solve.
  mutable std::vector<double> change_, core_change_;
  mutable std::vector<std::pair<double, double>> speeds_;  ///< by block: speeds of v and omega
};

/// Fill in blocks of bodies: only velocities; only masses, of dynamic bodies.
void put_velocities(std::span<const RigidBody> bodies, std::span<const uint32_t> slots,
                    std::span<DofBlock> out);
void put_masses(std::span<const RigidBody> bodies, std::span<const uint32_t> slots,
                std::span<DofBlock> out);
/// The blocks of bodies, with their velocities.
std::vector<DofBlock> blocks_of(std::span<const RigidBody> bodies, std::span<const uint32_t> slots);

}  // namespace tumble
