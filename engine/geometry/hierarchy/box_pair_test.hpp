#pragma once
#include "engine/math/float4.hpp"

/// Separating axes of two boxes (Gottschalk, Lin & Manocha, "OBBTree", 1996), four lanes at a time.
/// Single precision: the margin has to allow for rounding.
namespace tumble {

/// Rotation of box B relative to the axes of box A, by rows (row i: A's axis i in B's axes) and by
/// columns.
struct BoxTurn {
  Rows3 rows, columns, abs_rows, abs_columns;

  static BoxTurn from_rows(const Rows3& rows) {
    const Rows3 columns = rows.transposed();
    return {rows, columns, rows.absolute(), columns.absolute()};
  }
};

/// Two boxes seen from A: `offset` from A's centre to B's in A's axes, half extents in their own
/// axes, and half of the segment that B is swept along, in A's axes. Fourth lanes are 0.
struct BoxPair {
  Float4 offset, half_a, half_b, half_sweep;
};

/// Whether one of the products of A's edge i with B's edges separates the boxes by more than
/// `margin`. The product is no longer than 1, so that this asks for at least that gap.
template <int i, bool swept>
bool edges_part(const BoxTurn& turn, const BoxPair& p, Float4 margin) {
  constexpr int j = (i + 1) % 3, k = (i + 2) % 3;
  const auto shadow = [&](Float4 x) {
    return abs(x.spread<k>() * turn.rows.row[j] - x.spread<j>() * turn.rows.row[k]);
  };
  const Float4 reach_a =
      p.half_a.spread<j>() * turn.abs_rows.row[k] + p.half_a.spread<k>() * turn.abs_rows.row[j];
  const Float4 r = turn.abs_rows.row[i];
  const Float4 reach_b = p.half_b.shuffled<1, 2, 0, 3>() * r.shuffled<2, 0, 1, 3>() +
                         p.half_b.shuffled<2, 0, 1, 3>() * r.shuffled<1, 2, 0, 3>();
  Float4 reach = reach_a + reach_b + margin;
  if constexpr (swept) reach = reach + shadow(p.half_sweep);
  return (greater(shadow(p.offset), reach) & 7) != 0;
}

/// Whether a face axis of either box separates them, B swept along its segment, by more than
/// `margin`.
template <bool swept>
bool box_faces_apart(const BoxTurn& turn, const BoxPair& p, Float4 margin) {
  Float4 reach = p.half_a + turn.abs_columns.combine(p.half_b) + margin;
  if constexpr (swept) reach = reach + abs(p.half_sweep);
  if (greater(abs(p.offset), reach) & 7) return true;
  reach = p.half_b + turn.abs_rows.combine(p.half_a) + margin;
  if constexpr (swept) reach = reach + abs(turn.rows.combine(p.half_sweep));
  return (greater(abs(turn.rows.combine(p.offset)), reach) & 7) != 0;
}

/// True only if the boxes, B swept along its segment, are more than `margin` apart.
template <bool swept>
bool boxes_apart(const BoxTurn& turn, const BoxPair& p, Float4 margin) {
  if (box_faces_apart<swept>(turn, p, margin)) return true;
  return edges_part<0, swept>(turn, p, margin) || edges_part<1, swept>(turn, p, margin) ||
         edges_part<2, swept>(turn, p, margin);
}

/// Square of a lower bound of the distance of the boxes: the distance of each from the other's box
/// in that one's axes, less `slack`.
inline float box_squared_distance(const BoxTurn& turn, const BoxPair& p, Float4 slack) {
  const auto square = [&](Float4 gap) {
    const Float4 g = max(gap - slack, Float4()).xyz();
    const Float4 s = g * g, t = s + s.shuffled<1, 0, 3, 2>();
    return (t + t.shuffled<2, 3, 0, 1>()).first();
  };
  const float a = square(abs(p.offset) - p.half_a - turn.abs_columns.combine(p.half_b));
  const float b =
      square(abs(turn.rows.combine(p.offset)) - p.half_b - turn.abs_rows.combine(p.half_a));
  return a > b ? a : b;
}

}  // namespace tumble
