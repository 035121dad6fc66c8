#pragma once
#include "engine/math/types.hpp"

namespace tumble {

/// Two unit tangents of a contact, t1 x t2 = n, and their rates [1/s]; world axes (Coutinho 2013,
/// 10.4). For the frame that is a function of the normal alone see tangent_frame_rate() in
/// math/rotation_rates.hpp.
struct TangentRate {
  Vec3 t1 = Vec3::UnitX(), t2 = Vec3::UnitZ();
  Vec3 t1_rate = Vec3::Zero(), t2_rate = Vec3::Zero();
};

/// Rate of a tangent that follows the normal by the rotation without spin about it, as in a contact
/// that carries its frame along from step to step.
Vec3 follow_normal_rate(const Vec3& n, const Vec3& n_rate, const Vec3& tangent);

/// Tangents along and across the slip: t1 is the direction of the tangential part of `velocity`
/// [m/s], whose rate of change is `acceleration` [m/s2]. False where nothing slips.
[[nodiscard]] bool slip_tangent_rate(const Vec3& n, const Vec3& n_rate, const Vec3& velocity,
                                     const Vec3& acceleration, TangentRate& out);

}  // namespace tumble
