#pragma once
#include "engine/dynamics/forces/spring_net.hpp"
#include "engine/math/rotation.hpp"

#include <array>
#include <cstdint>
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

/// The blocks that a tie or a stencil acts on, with their signs or weights.
NetParts parts_of(const NetPattern& pattern, const SpringNet::Tie& tie);
NetParts parts_of(const NetPattern& pattern, const SpringNet::Stencil& stencil);

}  // namespace tumble
