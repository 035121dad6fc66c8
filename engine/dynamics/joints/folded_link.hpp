#pragma once
#include "engine/dynamics/joints/body_tensor.hpp"

#include <array>
#include <cstdint>
#include <span>

namespace tumble {

/// One joint of a folded tree: what its rows mean for its child, the body that is folded into the
/// parent.
struct FoldedLink {
  static constexpr uint32_t no_parent = ~uint32_t{0};

  uint32_t first_row = 0, parent = no_parent;  ///< parent: index of a node
  uint8_t side = 0, parts = 0, drives = 0;     ///< as in FoldedJoint
  uint8_t lines = 0, turns = 0;  ///< independent rows, of translation and of rotation only
  uint8_t freedoms = 0;
  std::array<uint8_t, 3> line_row{}, turn_row{};
  std::array<Vec3, 3> line, arm;  ///< of linear rows: axis, and its effect on rotation
  std::array<Vec3, 3> dual;       ///< of rotational rows: the dual basis of their axes
  Vec3 to_parent = Vec3::Zero();  ///< a point fixed to the parent moves by v - this x omega
  size_t free = 0;         ///< index in the tree's memory: free axes S, U = M S, H, and drives
  folding::Tensor passed;  ///< the tensor that the joint transmits to the parent: M - U H U^T

  const RowSide& of_child(const JointRow& row) const { return side == 0 ? row.row.a : row.row.b; }
  /// Reads the rows of its joint at the present poses; marks those that depend on others.
  void look(std::span<const JointRow> rows, std::span<uint8_t> depends);
  /// Writes a basis of the child's motions that change no row, and completes the dual basis of the
  /// rotational rows.
  void free_axes(double* out);
};

}  // namespace tumble
