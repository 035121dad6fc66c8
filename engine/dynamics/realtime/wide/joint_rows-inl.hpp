// The rows of joints over the lanes of a machine. Included once per target.
#if defined(TUMBLE_WIDE_JOINT_ROWS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef TUMBLE_WIDE_JOINT_ROWS_INL
#undef TUMBLE_WIDE_JOINT_ROWS_INL
#else
#define TUMBLE_WIDE_JOINT_ROWS_INL
#endif

#include "engine/dynamics/realtime/wide/lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace tumble::HWY_NAMESPACE {

/// Rows of a joint: three of a ball joint, and two more of a hinge.
template <size_t n>
struct Column {
  F x[n];
};

/// An entry of the triangle that WideJoint::factor and WideHinge::factor hold.
template <size_t n>
HWY_INLINE LaneFloats& entry(WideJoint& j, WideHinge* h, size_t row, size_t column) {
  const size_t k = row * (row + 1) / 2 + column;
  if constexpr (n > 3) {
    if (k >= 6) return h->factor[k - 6];
  }
  return j.factor[k];
}

HWY_INLINE WideHinge* hinge_of(WideRows& rows, const WideJoint& j) {
  return j.hinge == WideJoint::no_hinge ? nullptr : &rows.hinges[j.hinge];
}

}  // namespace tumble::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
