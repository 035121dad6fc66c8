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

/// Why an Articulation has a row.
enum class RowUse : uint8_t {
  part,      ///< a part of a joint keeps it
  armature,  ///< inertia along a coordinate resists it
  motor,     ///< a motor of any strength holds its rate
  coupling,
};

/// A row of an Articulation besides its Jacobian.
struct HeldRow {
  RowUse use = RowUse::part;
  uint32_t owner = 0;  ///< the joint, or the coupling, by its place among those that were chosen
  uint8_t place = 0;   ///< in the joint: rows of its parts, then one for each coordinate
  /// What a force F along the row leaves of its acceleration, that of the rotor behind an armature
  /// I: F = -I x'', so 1/I; nothing for all others.
  double give = 0;
  /// The velocity that is held; of an armature that of its rotor at the last update() [m/s, rad/s].
  double rate = 0;
};

/// How a body by itself answers to pushes.
struct BodyMass {
  double inverse_mass = 0;
  Mat3 inverse_inertia = Mat3::Zero();
};

/// The joints of a group of bodies as equations for exact steppers, of accelerations, velocities
/// and displacements (Coutinho 2013 §5.4, §5.6). What joints change is the least in the metric of
/// mass; with G for their Jacobian, bodies answer pushes from outside by
///   W = M^-1 - M^-1 G^T (G M^-1 G^T + C)^+ G M^-1
/// instead of M^-1. C is diagonal: a row with C = 1/I is an inertia I along it, since W is then the
/// inverse of M + G^T I G (Woodbury). Redundant joints (closed loops) are allowed.
///
/// Trees are folded into what they hang on, from their leaves inwards (FoldedTrees): the cost is
/// linear in the number of bodies. What is left where joints or couplings make loops, or bodies do
/// not turn, is their core: equations of the rows there,
///   (G M'^-1 G^T + C) f = change,
/// with M' the masses of bodies with all that is folded into them, in sparse blocks. The cost of a
/// core grows with the cube of the rows that cut all its loops apart.
class Articulation {
 public:
  /// Whether armatures and motors of any strength along coordinates have rows too.
  enum class Drives : uint8_t { none, held };

  Articulation() = default;
  /// `which` of the joints hold, and of their couplings, each of which has a joint among these;
  /// their blocks are block_of[slot], of `blocks` many, no_block for what nothing moves.
  Articulation(const JointsAndCouplings& all, const JointChoice& which,
               std::span<const uint32_t> block_of, std::span<const RigidBody> bodies, size_t blocks,
               Drives drives = Drives::held);

  /// Takes joints in the place of those that it was made of, and is then what a new one of them
  /// would be, without laying anything out. False, and nothing is done, where they do not tie the
  /// same blocks together by the same kinds, or have rows besides those of their parts.
  bool renew(const JointsAndCouplings& all, const JointChoice& which,
             std::span<const uint32_t> block_of, std::span<const RigidBody> bodies, size_t blocks,
             Drives drives = Drives::held);

  bool empty() const { return joints_.empty(); }
  /// Takes the bodies' present poses and velocities, and the masses of the blocks, `t` seconds
  /// since the tick began, when values of coordinates were known.
  void update(std::span<const RigidBody> bodies, std::span<const DofBlock> blocks, double t = 0) {
    look(bodies, t);
    factor(blocks);
  }
  /// The two halves of that: rows and their errors; all that answers to pushes and changes.
  /// `inertias` by block are the inverses of those of the blocks; found from these where not given.
  void look(std::span<const RigidBody> bodies, double t = 0);
  void factor(std::span<const DofBlock> blocks, std::span<const Mat3> inertias = {});
  /// look(), unless it was the last thing done and the bodies are where they were then; but for the
  /// biases of rows, which go with velocities.
  void look_where_moved(std::span<const RigidBody> bodies, double t = 0);

  /// As of update(), joint after joint, then those of the couplings: of these the half of x.
  std::span<const JointRow> rows() const { return rows_; }
  std::span<const HeldRow> held() const { return held_; }
  /// The coordinate that a row of an armature or a motor is along.
  size_t coordinate_of(size_t row) const;
  /// Rows of motors that may be told to stand: at a stop to which they drive, none is stronger.
  void stand(size_t row, bool stands) { stands_[row] = stands; }
  /// J v of a row less what it holds.
  double rate_off(size_t row, std::span<const DofBlock> blocks) const {
    return velocity(row, blocks) - held_[row].rate;
  }
  /// Whether all rows hold velocities to rounding, relative to what they are made of.
  bool rates_held(std::span<const DofBlock> blocks) const;
  /// Kinetic energy of the rotors behind armatures at the bodies' present state [J].
  double rotor_energy(std::span<const RigidBody> bodies) const;
  /// Calls f(RowSide) for the sides of a row that have a block.
  template <class F>
  void for_sides(size_t row, const F& f) const {
    for (uint8_t k = 0; k < sides_of(row); ++k)
      if (const RowSide& s = side(row, k); s.block != no_block) f(s);
  }
  /// Whether every row is between two bodies and gives way to nothing: what rows() says is then all
  /// that there is to the equations.
  bool plain() const { return plain_; }
  /// How many rows there are.
  size_t size() const { return held_.size(); }
  size_t joints() const { return joints_.size(); }
  /// The rows of one joint begin here; of joints(): where all end, and those of couplings begin.
  size_t first_row(size_t joint) const { return first_row_[joint]; }
  /// How many rows depended on others at the last update().
  size_t dependent_rows() const { return trees_.dependent() + factor_.dependent(); }
  /// Whether a row did: it gets no force, since those before it hold it too.
  bool depends(size_t row) const {
    return core_row_[row] == no_row ? trees_.depends(row) : factor_.depends(core_row_[row]);
  }
  /// Greatest |C| beyond what is accepted [m, rad].
  double error() const;
  /// Joints and couplings that are off by more than so much are held, from here on, where they are
  /// off by that much less: the errors that rows() has are what is left. Lengths of the vectors of
  /// their errors [m, rad]. Gives whether there are such.
  bool accept_errors(std::span<const RigidBody> bodies, double t, double worked_off);

  /// Changes accelerations of the blocks, in the place of velocities, so that d2C/dt2 = 0 of every
  /// row, as far as rows that depend on each other allow; adds the forces by row to those that
  /// acted already.
  void hold_accelerations(std::span<DofBlock> accelerations, std::span<double> forces) const {
    hold([this](size_t i) { return -rows_[i].bias; }, accelerations, forces);
  }
  /// Likewise velocities, to those that rows hold; impulses since update().
  void hold_velocities(std::span<DofBlock> velocities, std::span<double> impulses) const {
    hold([this](size_t i) { return held_[i].rate; }, velocities, impulses);
  }
  /// Displacements that change no row.
  void hold_displacements(std::span<DofBlock> displacements, std::span<double> pushes) const {
    hold([](size_t) { return 0.0; }, displacements, pushes);
  }
  /// Displacements that take the errors of rows back.
  void close(std::span<DofBlock> displacements, std::span<double> pushes) const {
    hold([this](size_t i) { return -rows_[i].error; }, displacements, pushes);
  }

  /// From the Delassus matrix of rows of free bodies to that of jointed ones, J W J^T. Rows that
  /// joints lock keep their entry on the diagonal and are coupled to nothing.
  void reduce(std::span<const Row> rows, Eigen::MatrixXd& delassus) const;

 private:
  /// A share in a body of what has rows: joints, then couplings.
  struct End {
    uint32_t block;
    uint32_t owner;
    uint8_t side;  ///< A and B of a joint; of a coupling those of both joints
  };
  /// M'^-1 times a row's Jacobian of one side: what its push does there.
  using Answer = std::array<double, 6>;
  /// What a body adds to the blocks of the factor for two of its ends.
  struct Term {
    uint32_t p, q;  ///< ends
    BlockLdl::Place to;
  };
  /// How a body answers to pushes.
  enum class Answering : uint8_t {
    stays,
    moves,  ///< and does not turn, or about one axis so easily that its tensor tells little of it
    turns,
  };
  static constexpr uint32_t no_row = ~uint32_t{0};
  struct Coupled {
    JointCoupling coupling;
    Joint a, b;
    std::array<uint32_t, 4> block_of;
    FollowedCoordinate x, y;
    Row of_y;  ///< the other half of its row
  };
  /// Changes velocities so that J v of every row is what `target(row)` says, less what it gives.
  template <class Target>
  void hold(const Target& target, std::span<DofBlock> blocks, std::span<double> pushes) const {
    // The second time takes what rounding left, where it left more than the last digits, and what
    // rows of a little later do. Trees have their changes by the way in which motion goes outwards.
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
  /// That of the body on a side of a joint.
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
  /// change := (G M^-1 G^T + C)^+ change, which leaves in the trees how their bodies go.
  void solve(std::span<double> change) const;
  JointRow update_coupling(Coupled& c, std::span<const RigidBody> bodies, double t);

  std::vector<Joint> joints_;
  std::vector<Coupled> couplings_;
  std::vector<uint32_t> block_of_;    ///< two by joint
  std::vector<Answering> answering_;  ///< likewise
  std::vector<size_t> first_row_;     ///< by owner
  std::vector<End> ends_;             ///< by block that moves, then by owner
  std::vector<uint32_t> first_end_;   ///< by block
  FoldedTrees trees_;
  std::vector<uint32_t> tree_blocks_;
  std::vector<uint32_t> core_ends_;  ///< those of what is not folded
  std::vector<uint32_t> core_row_;   ///< by row: in the factor
  std::vector<Answer> answers_;      ///< two by row, then two more of couplings; of the core
  std::vector<Term> terms_;
  std::vector<std::pair<uint32_t, size_t>> core_gives_;  ///< rows that give, and where they do
  std::vector<BodyMass> masses_;                         ///< by block
  std::vector<double> gives_;                            ///< by row
  std::vector<JointRow> rows_;
  std::vector<double> accepted_;  ///< by row: the error that it is held at; empty: none
  std::vector<HeldRow> held_;     ///< by row
  bool plain_ = true, parts_only_ = true;
  std::vector<uint8_t> stands_;  ///< by row
  BlockLdl factor_;              ///< of the core
  bool fresh_ = false;           ///< the rows are those of the last factor()
  std::vector<Pose> seen_;       ///< two by joint: of the bodies, where the rows are; else none
  // One thread at a time.
  mutable std::vector<double> change_, core_change_;
  mutable std::vector<std::pair<double, double>> speeds_;  ///< by block: of v and omega
};

/// The halves of the blocks of bodies: velocities; masses, of those that are dynamic.
void put_velocities(std::span<const RigidBody> bodies, std::span<const uint32_t> slots,
                    std::span<DofBlock> out);
void put_masses(std::span<const RigidBody> bodies, std::span<const uint32_t> slots,
                std::span<DofBlock> out);
/// The blocks of bodies, with their velocities.
std::vector<DofBlock> blocks_of(std::span<const RigidBody> bodies, std::span<const uint32_t> slots);

}  // namespace tumble
