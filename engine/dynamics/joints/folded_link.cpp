#include "engine/dynamics/joints/folded_link.hpp"

#include "engine/dynamics/joints/tolerances.hpp"
#include "engine/math/rotation.hpp"

namespace tumble {
namespace {

/// Whether an axis is linearly independent of at most two others.
bool adds_to(std::span<const Vec3> others, const Vec3& axis) {
  constexpr double least = tolerances::parallel_axes * tolerances::parallel_axes;
  if (others.empty()) return axis.squaredNorm() > least;
  if (others.size() == 1) return others[0].cross(axis).squaredNorm() > least;
  const double volume = others[0].cross(others[1]).dot(axis);
  return volume * volume > least;
}

bool is_linear(const RowSide& s) {
  return s.linear[0] != 0 || s.linear[1] != 0 || s.linear[2] != 0;
}

}  // namespace

void FoldedLink::look(std::span<const JointRow> rows, std::span<uint8_t> depends) {
  // Local counters: the compiler must assume that writes through byte members may alias anything.
  const bool at_a = side == 0;
  const auto of_child = [at_a](const JointRow& row) -> const RowSide& {
    return at_a ? row.row.a : row.row.b;
  };
  const size_t of_parts = parts;
  size_t linear = 0, turning = 0;
  std::array<uint8_t, 3> of_lines{}, of_turns{};
  uint32_t left_out = 0;  // a bit for each row
  for (size_t i = 0; i < of_parts; ++i) {
    const RowSide& s = of_child(rows[i]);
    if (is_linear(s)) {
      of_lines[linear] = uint8_t(i);
      line[linear] = s.linear;
      arm[linear++] = s.angular;
    } else if (adds_to(std::span(dual).first(turning), s.angular)) {
      of_turns[turning] = uint8_t(i);
      dual[turning++] = s.angular;
    } else {
      left_out |= 1u << i;
    }
  }
  lines = uint8_t(linear), turns = uint8_t(turning);
  line_row = of_lines, turn_row = of_turns;
  for (size_t i = 0; i < of_parts; ++i) depends[i] = uint8_t(left_out >> i & 1);
  if (parent == no_parent) return;
  // Both sides of a linear row together give the velocity of a point of the parent: two such rows
  // determine r, one as far as it matters.
  Vec3 to = Vec3::Zero();
  const Vec3* first = nullptr;
  for (const JointRow& row : rows) {
    const RowSide& s = of_child(row);
    if (!is_linear(s)) continue;
    const Vec3 across = (row.row.a.angular + row.row.b.angular).cross(s.linear);
    if (first) {
      to += first->dot(across) * *first;
      break;
    }
    first = &s.linear;
    to = across;
  }
  to_parent = to;
}

void FoldedLink::free_axes(double* out) {
  const size_t linear = lines, turning = turns;
  const auto slide = [&](const Vec3& axis) {
    folding::put(out, axis, Vec3::Zero());
    out += 6;
  };
  const auto turn = [&](const Vec3& axis) {
    Vec3 moved = Vec3::Zero();
    for (size_t i = 0; i < linear; ++i) moved -= arm[i].dot(axis) * line[i];
    folding::put(out, moved, axis);
    out += 6;
  };
  const auto frame_of = [](const Vec3& axis, const auto& use) {
    Vec3 t1, t2;
    tangent_frame(axis, t1, t2);
    use(t1);
    use(t2);
  };
  if (linear == 0)
    for (int i = 0; i < 3; ++i) slide(Vec3::Unit(i));
  if (linear == 1) frame_of(line[0], slide);
  if (linear == 2) slide(line[0].cross(line[1]));
  std::array<Vec3, 3>& t = dual;
  if (turning == 0) {
    for (int i = 0; i < 3; ++i) turn(Vec3::Unit(i));
  } else if (turning == 1) {
    frame_of(t[0].normalized(), turn);
    t[0] /= t[0].squaredNorm();
  } else if (turning == 2) {
    const Vec3 axis = t[0].cross(t[1]);
    turn(axis);
    const double f = 1 / axis.squaredNorm();
    const Vec3 first = f * t[1].cross(axis);
    t[1] = f * axis.cross(t[0]);
    t[0] = first;
  } else {
    const std::array<Vec3, 3> u = t;
    const double f = 1 / u[0].dot(u[1].cross(u[2]));
    for (size_t i = 0; i < 3; ++i) t[i] = f * u[(i + 1) % 3].cross(u[(i + 2) % 3]);
  }
  freedoms = uint8_t(6 - linear - turning);
}

}  // namespace tumble
