#pragma once
#include "engine/dynamics/joints/body_tensor.hpp"

#include <array>
#include <cstdint>
#include <span>

namespace tumble {

/// A joint of a folded tree by itself: what its rows say of the body that hangs on it, its child.
struct FoldedLink {
  static constexpr uint32_t no_parent = ~uint32_t{0};

  uint32_t first_row = 0, parent = no_parent;  ///< parent: a node
  uint8_t side = 0, parts = 0, drives = 0;     ///< as of FoldedJoint
  uint8_t lines = 0, turns = 0;                ///< independent rows
  uint8_t freedoms = 0;
  std::array<uint8_t, 3> line_row{}, turn_row{};
  std::array<Vec3, 3> line, arm;  ///< linear rows: axis, and what turning adds
  std::array<Vec3, 3> dual;       ///< of rows that turn: to each its own, across the others
  Vec3 to_parent = Vec3::Zero();  ///< a point fixed to the parent is moved by v - this x omega
  size_t free = 0;                ///< in memory of the tree: axes S, U = M S, H, and drives
  folding::Tensor passed;         ///< what the joint lets through of the tensor: M - U H U^T

  const RowSide& of_child(const JointRow& row) const { return side == 0 ? row.row.a : row.row.b; }
  /// Takes its rows as they are now, and where it stands; marks those that depend on others.
  void look(std::span<const JointRow> rows, std::span<uint8_t> depends);
  /// Writes the child's motions that change no row, one after the other, and completes the duals of
  /// those that turn.
  void free_axes(double* out);
};

}  // namespace tumble
