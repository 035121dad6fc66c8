#pragma once
#include "engine/math/types.hpp"

#include <array>

#include <ode/ode.h>

/// Our values as ODE's, and back.
namespace tumble::test {

/// Once per process; its messages are dropped, of which its direct solver has many.
inline void start_ode() {
  static const bool started = [] {
    dInitODE2(0);
    dAllocateODEDataForThread(dAllocateMaskAll);
    dSetMessageHandler([](int, const char*, va_list) {});
    return true;
  }();
  (void)started;
}

inline Vec3 from_ode(const dReal* v) {
  return {v[0], v[1], v[2]};
}
inline Quat quat_from_ode(const dReal* q) {
  return {q[0], q[1], q[2], q[3]};
}
inline std::array<dReal, 4> to_ode(const Quat& q) {
  return {q.w(), q.x(), q.y(), q.z()};
}

}  // namespace tumble::test
