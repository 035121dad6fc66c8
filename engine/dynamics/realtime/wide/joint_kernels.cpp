// Sweeps over joints, a bundle at a time; the same in scalars: realtime/solve_joints.cpp.
#include "engine/dynamics/realtime/wide/wide_kernels.hpp"

// Compiles this file once per instruction set, with the includes that each time needs.
// clang-format off
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "engine/dynamics/realtime/wide/joint_kernels.cpp"
#include <hwy/foreach_target.h>
#include "engine/dynamics/realtime/wide/joint_rows-inl.hpp"
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace tumble::HWY_NAMESPACE {

/// The two bodies of some lanes of a bundle of joints.
struct Ends {
  Moving a, b;
  F mass_a, mass_b;
  Sym inertia_a, inertia_b;
  V ra, rb;

  HWY_INLINE Ends(WideRows& rows, const WideJoint& j, size_t lane)
      : a(rows.bodies.data(), j.a.data() + lane),
        b(rows.bodies.data(), j.b.data() + lane),
        mass_a(load(j.mass_a, lane)),
        mass_b(load(j.mass_b, lane)),
        inertia_a(load(j.inertia_a, lane)),
        inertia_b(load(j.inertia_b, lane)),
        ra(load(j.ra, lane)),
        rb(load(j.rb, lane)) {}
  HWY_INLINE V slip() const { return b.v - a.v + cross(b.w, rb) - cross(a.w, ra); }
  /// Applies an impulse P on B and -P on A at the anchors, and likewise an impulsive torque T.
  HWY_INLINE void push(const V& P, const V* T) {
    V on_a = cross(ra, P), on_b = cross(rb, P);
    if (T) {
      on_a = on_a + *T;
      on_b = on_b + *T;
    }
    a.v = a.v - mass_a * P;
    a.w = a.w - inertia_a * on_a;
    b.v = b.v + mass_b * P;
    b.w = b.w + inertia_b * on_b;
  }
  HWY_INLINE void write(const WideJoint& j, size_t lane) const {
    a.write(uint32_t(j.writes_a) >> lane);
    b.write(uint32_t(j.writes_b) >> lane);
  }
};

template <size_t n>
HWY_INLINE void solve_factored(WideJoint& j, WideHinge* h, size_t lane, Column<n>& c) {
  const auto at = [&](size_t row, size_t column)
                      HWY_ATTR { return load(entry<n>(j, h, row, column), lane); };
  for (size_t i = 0; i < n; ++i)
    for (size_t m = 0; m < i; ++m) c.x[i] = c.x[i] - at(i, m) * c.x[m];
  for (size_t i = 0; i < n; ++i) c.x[i] = c.x[i] * at(i, i);
  for (size_t i = n; i-- > 0;)
    for (size_t m = i + 1; m < n; ++m) c.x[i] = c.x[i] - at(m, i) * c.x[m];
}

HWY_INLINE V moment(const WideHinge& h, size_t lane, F first, F second) {
  return first * load(h.turn[0], lane) + second * load(h.turn[1], lane);
}

HWY_INLINE void push_stored(Ends& ends, WideJoint& j, WideHinge* h, size_t lane, JointPass pass) {
  const V P = load(impulses(j, pass), lane);
  if (h) {
    const std::array<LaneFloats, 2>& twist = impulses(*h, pass);
    const V T = moment(*h, lane, load(twist[0], lane), load(twist[1], lane));
    ends.push(P, &T);
  } else {
    ends.push(P, nullptr);
  }
}

HWY_INLINE void forget_stored(WideJoint& j, WideHinge* h, size_t lane, JointPass pass, M lost) {
  const auto forget = [&](LaneFloats& x)
                          HWY_ATTR { store(hn::IfThenZeroElse(lost, load(x, lane)), x, lane); };
  for (LaneFloats& x : impulses(j, pass)) forget(x);
  if (!h) return;
  for (LaneFloats& x : impulses(*h, pass)) forget(x);
}

HWY_INLINE void start_correcting(WideJoint& j, WideHinge* h, size_t lane) {
  for (LaneFloats& x : j.correcting) store(all(0), x, lane);
  if (!h) return;
  for (LaneFloats& x : h->correcting) store(all(0), x, lane);
}

HWY_INLINE M turns_away(const V& w, const V& pushed, F most) {
  const V change = pushed - w;
  return hn::And(hn::Gt(dot(w, w), most), hn::Gt(dot(change, change), most));
}

void WarmStartJoints(WideRows& rows, WideRange range, const WideStep& step, JointPass pass) {
  const F most = all(float(tolerances::max_turn_per_substep * tolerances::max_turn_per_substep) /
                     (step.hs * step.hs));
  for (uint32_t i = range.begin; i < range.end; ++i) {
    WideJoint& j = rows.joints[i];
    WideHinge* h = hinge_of(rows, j);
    for (size_t lane = 0; lane < j.lanes; lane += step_lanes) {
      if (pass == JointPass::moving) start_correcting(j, h, lane);
      const Ends before(rows, j, lane);
      Ends ends = before;
      push_stored(ends, j, h, lane, pass);
      const M lost =
          hn::Or(turns_away(before.a.w, ends.a.w, most), turns_away(before.b.w, ends.b.w, most));
      if (!hn::AllFalse(Lanes(), lost)) {
        forget_stored(j, h, lane, pass, lost);
        ends = before;
        push_stored(ends, j, h, lane, pass);
      }
      ends.write(j, lane);
    }
  }
}

HWY_INLINE void add(const V& v, LaneVec& to, size_t lane) {
  store(load(to, lane) + v, to, lane);
}

/// Adds an impulse to the sums; T is null without a hinge.
HWY_INLINE void add_push(WideJoint& j, size_t lane, const V& P, const V* T) {
  V on_a = cross(P, load(j.ra, lane)), on_b = cross(load(j.rb, lane), P);
  if (T) {
    on_a = on_a - *T;
    on_b = on_b + *T;
  }
  add(P, j.impulse, lane);
  add(on_a, j.moment_a, lane);
  add(on_b, j.moment_b, lane);
}

void SumJoints(WideRows& rows, WideRange range, JointPass pass) {
  const bool moving = pass == JointPass::moving;
  for (uint32_t i = range.begin; i < range.end; ++i) {
    WideJoint& j = rows.joints[i];
    WideHinge* h = hinge_of(rows, j);
    for (size_t lane = 0; lane < j.lanes; lane += step_lanes) {
      const V P = moving ? load(j.moving, lane) + load(j.correcting, lane) : load(j.relaxing, lane);
      if (h) {
        const auto twist = [&](size_t k) HWY_ATTR {
          return moving ? load(h->moving[k], lane) + load(h->correcting[k], lane)
                        : load(h->relaxing[k], lane);
        };
        const V T = moment(*h, lane, twist(0), twist(1));
        add_push(j, lane, P, &T);
        add(T, h->twist, lane);
      } else {
        add_push(j, lane, P, nullptr);
      }
    }
  }
}

/// Velocities of the rows.
template <size_t n>
HWY_INLINE Column<n> velocities(const Ends& ends, const WideHinge* h, size_t lane) {
  const V slip = ends.slip();
  Column<n> c;
  c.x[0] = slip.x;
  c.x[1] = slip.y;
  c.x[2] = slip.z;
  if constexpr (n == 5) {
    const V spin = ends.b.w - ends.a.w;
    c.x[3] = dot(load(h->turn[0], lane), spin);
    c.x[4] = dot(load(h->turn[1], lane), spin);
  }
  return c;
}

/// Which joints of a bundle a sweep solves.
enum class Swept { all, struck };

template <size_t n, JointPass pass, Swept swept>
HWY_INLINE void solve_lanes(WideRows& rows, WideJoint& j, WideHinge* h, size_t lane) {
  Ends ends(rows, j, lane);
  Column<n> c = velocities<n>(ends, h, lane);
  if constexpr (pass != JointPass::relaxing) {
    for (size_t k = 0; k < 3; ++k) c.x[k] = c.x[k] + load(j.target[k], lane);
    for (size_t k = 3; k < n; ++k) c.x[k] = c.x[k] + load(h->target[k - 3], lane);
  }
  if constexpr (pass == JointPass::correcting) {
    for (size_t k = 0; k < 3; ++k) c.x[k] = c.x[k] + load(j.correction[k], lane);
    for (size_t k = 3; k < n; ++k) c.x[k] = c.x[k] + load(h->correction[k - 3], lane);
  }
  solve_factored<n>(j, h, lane, c);
  for (size_t k = 0; k < n; ++k) {
    LaneFloats& impulse = k < 3 ? impulses(j, pass)[k] : impulses(*h, pass)[k < 3 ? 0 : k - 3];
    c.x[k] = all(0) - c.x[k];
    if constexpr (swept == Swept::struck)
      c.x[k] = hn::IfThenElseZero(hn::Gt(load(j.struck, lane), all(0)), c.x[k]);
    store(load(impulse, lane) + c.x[k], impulse, lane);
  }
  const V P{c.x[0], c.x[1], c.x[2]};
  if constexpr (n == 5) {
    const V T = moment(*h, lane, c.x[3], c.x[4]);
    ends.push(P, &T);
  } else {
    ends.push(P, nullptr);
  }
  ends.write(j, lane);
}

template <JointPass pass, Swept swept>
HWY_INLINE void sweep_joints(WideRows& rows, WideRange range) {
  for (uint32_t i = range.begin; i < range.end; ++i) {
    WideJoint& j = rows.joints[i];
    if (swept == Swept::struck && !j.any_struck) continue;
    WideHinge* const h = hinge_of(rows, j);
    for (size_t lane = 0; lane < j.lanes; lane += step_lanes) {
      if (h) {
        solve_lanes<5, pass, swept>(rows, j, h, lane);
      } else {
        solve_lanes<3, pass, swept>(rows, j, nullptr, lane);
      }
    }
  }
}

void SolveJoints(WideRows& rows, WideRange range, JointPass pass) {
  if (pass == JointPass::moving) {
    sweep_joints<JointPass::moving, Swept::all>(rows, range);
  } else if (pass == JointPass::correcting) {
    sweep_joints<JointPass::correcting, Swept::all>(rows, range);
  } else {
    sweep_joints<JointPass::relaxing, Swept::all>(rows, range);
  }
}

/// Not for the correcting pass, whose sweeps are over all joints.
void SolveStruckJoints(WideRows& rows, WideRange range, JointPass pass) {
  if (pass == JointPass::moving) {
    sweep_joints<JointPass::moving, Swept::struck>(rows, range);
  } else {
    sweep_joints<JointPass::relaxing, Swept::struck>(rows, range);
  }
}

float JointResidual(WideRows& rows, WideRange range) {
  F most = all(0);
  for (uint32_t i = range.begin; i < range.end; ++i) {
    const WideJoint& j = rows.joints[i];
    const WideHinge* const h = hinge_of(rows, j);
    for (size_t lane = 0; lane < j.lanes; lane += step_lanes) {
      const Ends ends(rows, j, lane);
      const Column<3> c = velocities<3>(ends, nullptr, lane);
      for (const F& x : c.x) most = hn::Max(most, hn::Abs(x));
      if (!h) continue;
      const V spin = ends.b.w - ends.a.w;
      for (const LaneVec& turn : h->turn)
        most = hn::Max(most, hn::Abs(dot(load(turn, lane), spin)));
    }
  }
  return greatest_lane(most);
}

}  // namespace tumble::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tumble {

HWY_EXPORT(WarmStartJoints);
HWY_EXPORT(SolveJoints);
HWY_EXPORT(SolveStruckJoints);
HWY_EXPORT(SumJoints);
HWY_EXPORT(JointResidual);

void wide_warm_start_joints(WideRows& rows, WideRange joints, const WideStep& step,
                            JointPass pass) {
  HWY_DYNAMIC_DISPATCH(WarmStartJoints)(rows, joints, step, pass);
}
void wide_solve_joints(WideRows& rows, WideRange joints, JointPass pass) {
  HWY_DYNAMIC_DISPATCH(SolveJoints)(rows, joints, pass);
}
void wide_solve_struck_joints(WideRows& rows, WideRange joints, JointPass pass) {
  HWY_DYNAMIC_DISPATCH(SolveStruckJoints)(rows, joints, pass);
}
void wide_sum_joints(WideRows& rows, WideRange joints, JointPass pass) {
  HWY_DYNAMIC_DISPATCH(SumJoints)(rows, joints, pass);
}
float wide_joint_residual(WideRows& rows, WideRange joints) {
  return HWY_DYNAMIC_DISPATCH(JointResidual)(rows, joints);
}

}  // namespace tumble
#endif
