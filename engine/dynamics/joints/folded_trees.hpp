#pragma once
#include "engine/dynamics/joints/folded_link.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace tumble {

/// A joint that its body and all that hangs on it can be folded into.
struct FoldedJoint {
  uint32_t child, parent;  ///< blocks; no_block: what does not move
  uint32_t first_row;
  uint8_t side;    ///< of the child: 0 for A, 1 for B
  uint8_t parts;   ///< rows of the joint's parts, which are linear ones, each along another axis,
                   ///< and such that only turn
  uint8_t drives;  ///< behind them rows along its coordinates
};

/// Trees of jointed bodies, from their leaves inwards: articulated bodies (Featherstone 1983; 2008,
/// chapter 7), with any change of velocity across each joint prescribed. Body, joint and all that
/// hangs on them together are, to the body before them, a tensor of inertia and a push; of the
/// directions that a joint leaves free there is one small equation each, and rows hold by the way
/// in which motion goes outwards. What is left is the root of every tree: by itself, or as a part
/// of what is not folded.
class FoldedTrees {
 public:
  using Six = folding::Six;
  using Tensor = folding::Tensor;

  FoldedTrees() = default;
  /// Every joint before those of its parent; `blocks` and `rows` of the whole.
  FoldedTrees(std::span<const FoldedJoint> joints, size_t blocks, size_t rows);

  bool empty() const { return joints_.empty(); }
  /// Whether a block has part in a tree.
  bool has(uint32_t block) const { return !empty() && node_of_[block] != none; }
  /// `give` is by row what a force along it leaves of its change (rows of drives only); `inertias`
  /// by block the inverses of those of the blocks, found from these where none are given.
  void factor(std::span<const JointRow> rows, std::span<const double> give,
              std::span<const DofBlock> blocks, std::span<const Mat3> inertias);
  /// How a root, with all that hangs on it, answers to a push.
  Six answer(uint32_t root, const RowSide& push) const;

  /// Inwards: the rows' changes that are asked for, no body pushed from outside.
  void gather(std::span<const double> change) const;
  /// How a root then goes; what more it goes by can be added.
  Six& motion(uint32_t block) const { return motions_[node_of_[block]]; }
  /// Outwards, the roots going as they do: forces by row in the place of changes.
  void spread(std::span<double> change) const;

  /// As of the last factor(). Rows that depend on others of their joint get no force.
  size_t dependent() const { return dependent_; }
  bool depends(size_t row) const { return depends_[row] != 0; }

 private:
  using Link = FoldedLink;
  static constexpr uint32_t none = Link::no_parent;
  struct Passing {
    Six across;                    ///< change across the joint, of its free directions none
    Six push;                      ///< on the child where the parent stands still
    std::array<double, 6> felt;    ///< along the free axes, of what hangs on the child
    std::array<double, 6> slack;   ///< along them, where the parent stands still
    std::array<double, 6> driven;  ///< what is left of the drives' changes
  };
  template <int freedoms>
  void eliminate(Link& link, const Tensor& tensor, std::span<const JointRow> rows,
                 std::span<const double> give);
  void add_drives(Link& link, std::span<const JointRow> rows, std::span<const double> give);
  template <int freedoms>
  void gather(const Link& link, const Six& push, std::span<const double> change,
              Passing& out) const;
  template <int freedoms>
  void spread(const Link& link, const Passing& in, const Six& before, Six& motion,
              std::span<double> change) const;
  void take_drives(const Link& link, const Passing& in, std::span<const double> felt, Six& push,
                   std::span<double> change) const;
  void take_forces(const Link& link, const Six& push, std::span<double> change) const;
  /// Of a link's drives: their rows, then what a change of each makes of the motion along the free
  /// axes and of the drives' forces.
  double* drives_of(const Link& link);
  const double* drives_of(const Link& link) const;

  std::vector<Link> joints_;       ///< node i is the child of joint i; behind them roots
  std::vector<uint32_t> blocks_;   ///< by node
  std::vector<uint32_t> node_of_;  ///< by block
  std::vector<double> free_;
  std::vector<Tensor> tensors_;  ///< by node; of roots the inverses
  std::vector<uint8_t> depends_;
  size_t dependent_ = 0;
  // What gather() leaves for spread(): one thread at a time.
  mutable std::vector<Passing> passing_;
  mutable std::vector<Six> pushes_, motions_;  ///< by node
};

}  // namespace tumble
