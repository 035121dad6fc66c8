#pragma once
#include "engine/math/types.hpp"

#include <LinearMath/btTransform.h>

/// Our values as Bullet's, and back.
namespace tumble::test {

inline btVector3 to_bullet(const Vec3& v) {
  return {btScalar(v.x()), btScalar(v.y()), btScalar(v.z())};
}
inline btTransform to_bullet(const Pose& p) {
  const btQuaternion q(btScalar(p.q.x()), btScalar(p.q.y()), btScalar(p.q.z()), btScalar(p.q.w()));
  return btTransform(q, to_bullet(p.x));
}
inline Vec3 from_bullet(const btVector3& v) {
  return {double(v.x()), double(v.y()), double(v.z())};
}
inline Pose from_bullet(const btTransform& t) {
  const btQuaternion q = t.getRotation();
  return {from_bullet(t.getOrigin()),
          Quat(double(q.w()), double(q.x()), double(q.y()), double(q.z()))};
}

}  // namespace tumble::test
