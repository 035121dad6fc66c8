#pragma once
#include "engine/dynamics/joints/folded_link.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace tumble {

/// A joint at which the child, with everything that hangs on it, can be folded into the parent.
struct FoldedJoint {
  uint32_t child, parent;  ///< blocks; no_block: immovable
  uint32_t first_row;
  uint8_t side;  ///< of the child: 0 for A, 1 for B
  /// Rows of the joint's parts: linear ones along different axes, and purely rotational ones.
  uint8_t parts;
  uint8_t drives;  ///< rows along its coordinates, behind those
};

/// Trees of jointed bodies, eliminated from the leaves inwards: the articulated-body method
/// (Featherstone 1983; 2008, chapter 7), with any change of velocity across each joint prescribed.
/// A body with its joint and everything that hangs on it acts on its parent as one tensor of
/// inertia and one push; for the free directions of a joint there is one small equation each, and
/// the rows of a joint are satisfied by the way in which motion is propagated outwards. What
/// remains is the root of each tree, by itself or as part of what is not folded.
class FoldedTrees {
 public:
  using Six = folding::Six;
  using Tensor = folding::Tensor;

  FoldedTrees() = default;
  /// Joints are sorted with every joint before that of its parent; `blocks` and `rows` are those of
  /// the whole Articulation.
  FoldedTrees(std::span<const FoldedJoint> joints, size_t blocks, size_t rows);

  bool empty() const { return joints_.empty(); }
  /// Whether a block is a node of a tree.
  bool has(uint32_t block) const { return !empty() && node_of_[block] != none; }
  /// `give` is the compliance by row (rows of drives only); `inertias` are, by block, the inverses
  /// of those of the blocks, computed if not given.
  void factor(std::span<const JointRow> rows, std::span<const double> give,
              std::span<const DofBlock> blocks, std::span<const Mat3> inertias);
  /// Response of a root, with everything that hangs on it, to a push.
  Six answer(uint32_t root, const RowSide& push) const;

  /// Inward pass: for the wanted changes of rows, without external pushes on bodies.
  void gather(std::span<const double> change) const;
  /// Motion of a root after gather(); motion from elsewhere can be added to it.
  Six& motion(uint32_t block) const { return motions_[node_of_[block]]; }
  /// Outward pass, from the motions of the roots: replaces the changes by forces, by row.
  void spread(std::span<double> change) const;

  /// As of the last factor(). Rows that depend on others of their joint get no force.
  size_t dependent() const { return dependent_; }
  bool depends(size_t row) const { return depends_[row] != 0; }

 private:
  using Link = FoldedLink;
  static constexpr uint32_t none = Link::no_parent;
  struct Passing {
    Six across;                    ///< change across the joint, without its free directions
    Six push;                      ///< on the child if the parent stands still
    std::array<double, 6> felt;    ///< along the free axes, by what hangs on the child
    std::array<double, 6> slack;   ///< motion along them if the parent stands still
    std::array<double, 6> driven;  ///< remaining changes of the drives' rows
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
  /// Memory of a link's drives: their rows, then the effect of a change of each on the motion along
  /// the free axes and on the drives' forces.
  double* drives_of(const Link& link);
  const double* drives_of(const Link& link) const;

  std::vector<Link> joints_;       ///< node i is the child of joint i; the roots follow
  std::vector<uint32_t> blocks_;   ///< by node
  std::vector<uint32_t> node_of_;  ///< by block
  std::vector<double> free_;
  std::vector<Tensor> tensors_;  ///< by node; the inverses for roots
  std::vector<uint8_t> depends_;
  size_t dependent_ = 0;
  // Results of gather() for spread(): only one thread at a time may solve.
  mutable std::vector<Passing> passing_;
  mutable std::vector<Six> pushes_, motions_;  ///< by node
};

}  // namespace tumble
