#pragma once
#include "engine/dynamics/forces/net_rows.hpp"
#include "engine/math/float4.hpp"
#include "engine/math/rotation.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace tumble {

/// Which blocks of the matrix of a net are not zero, and where its rows add to them. Kept as long
/// as the same nodes hang together.
class NetPattern {
 public:
  static constexpr uint32_t none = ~uint32_t{0};

  /// The blocks of an end: that of its node's velocity, and that of its turning.
  struct Blocks {
    uint32_t moves = none, turns = none;
  };

  /// By node; `blocks` in all.
  void number(const SpringNet& net);
  /// Makes `rows` and `columns`, or keeps them.
  void find(const SpringNet& net);

  Blocks blocks_of(const SpringNet::End& end) const {
    return end.node == SpringNet::fixed ? Blocks{} : of_node[end.node];
  }

  std::vector<Blocks> of_node;
  uint32_t blocks = 0;
  std::vector<uint32_t> row_start;  ///< off the diagonal
  std::vector<uint32_t> columns;
  /// Places among `columns` of what the ties and then the stencils add, each pair of its blocks in
  /// either order.
  std::vector<uint32_t> places;

 private:
  std::vector<uint32_t> key_, known_;  ///< the ends of all rows
};

/// A block that a row acts on, J^T E J with J = `jacobian`, or `weight` times the unit matrix.
struct NetPart {
  uint32_t block = NetPattern::none;
  double weight = 0;
  bool plain = true;
  Mat3 jacobian = Mat3::Zero();

  Mat3 full() const { return plain ? Mat3(weight * Mat3::Identity()) : jacobian; }
};

/// The blocks of one row, each once.
struct NetParts {
  std::array<NetPart, 8> at;
  uint32_t count = 0;

  void add(const NetPattern& pattern, const SpringNet::End& end, double weight) {
    const NetPattern::Blocks blocks = pattern.blocks_of(end);
    if (blocks.moves == NetPattern::none) return;
    NetPart& moves = find(blocks.moves);
    moves.weight += weight;
    if (blocks.turns == NetPattern::none) return;
    NetPart& turns = find(blocks.turns);
    turns.plain = false;
    turns.jacobian -= weight * skew(end.arm);
  }

 private:
  NetPart& find(uint32_t block) {
    for (uint32_t i = 0; i < count; ++i)
      if (at[i].block == block) return at[i];
    at[count] = {block, 0, true, Mat3::Zero()};
    return at[count++];
  }
};

/// The system of SpringNet for nets with meshes. The matrix is put together in 3 x 3 blocks, two to
/// a body that turns. It is solved by conjugate gradients with the inverted blocks of its diagonal
/// as preconditioner, in single precision; what is left is found in double precision from the rows
/// and solved for again, until it is small. Nodes that contacts hold move in the part of space that
/// is left to them; a hold that would have to pull, or to rub more than friction does, is let go.
class NetSystem {
 public:
  void solve(const SpringNet& net, SpringNet::Answer& out);

 private:
  void put_together();
  const uint32_t* put(const NetParts& parts, const Mat3& E, const uint32_t* place);
  const uint32_t* put_tie(size_t i, const uint32_t* place);
  const uint32_t* put_bow(size_t i, const uint32_t* place);
  void add_turning(const SpringNet::End& end, double turn);
  void invert_diagonal();
  void start_holds();
  bool let_go(std::span<const Vec3> residual);
  void residual(std::vector<Vec3>& out) const;
  double size(std::span<const Vec3> r) const;
  void project(std::vector<Vec3>& r) const;
  int correct(std::span<const Vec3> r, double target);
  void apply(std::span<const Float4> x, std::span<Float4> y) const;
  void precondition(std::span<const Float4> r, std::span<Float4> y) const;
  void answer(SpringNet::Answer& out) const;
  void rest(std::vector<Vec3>& force, std::vector<Vec3>& torque) const;
  Vec3 moves_apart(const SpringNet::Tie& tie, const std::vector<Vec3>& x) const;
  Vec3 velocity(const SpringNet::End& end, const std::vector<Vec3>& x) const;
  void push(const SpringNet::End& end, const Vec3& impulse, std::vector<Vec3>& out) const;

  const SpringNet* net_ = nullptr;
  std::vector<NetRow> rows_;
  std::vector<NetBow> bows_;
  std::vector<double> stiffness_;
  NetPattern pattern_;
  std::vector<Rows3> off_;        ///< by place, transposed: combine() multiplies
  std::vector<Mat3> diagonal_;    ///< by block
  std::vector<Rows3> diagonal4_;  ///< the same in single precision
  std::vector<Rows3> inverse_;
  std::vector<Mat3> free_;                 ///< by node: projects onto what holds leave
  std::vector<uint32_t> held_;             ///< nodes that are held
  std::vector<uint8_t> presses_, sticks_;  ///< by node, as taken now
  std::vector<Vec3> change_;               ///< of the velocities, by block
  std::vector<Vec3> r_;
  std::vector<Float4> residual_, y_, p_, product_, correction_;
};

}  // namespace tumble
