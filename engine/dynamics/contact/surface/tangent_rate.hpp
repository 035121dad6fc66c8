#pragma once
#include "engine/math/types.hpp"

namespace tumble {

/// Two unit tangents of a contact, t1 x t2 = n, and their rates [1/s]; world axes (Coutinho 2013,
/// 10.4). For the fixed frame of every normal see tangent_frame_rate() of math/rotation_rates.hpp.
struct TangentRate {
  Vec3 t1 = Vec3::UnitX(), t2 = Vec3::UnitZ();
  Vec3 t1_rate = Vec3::Zero(), t2_rate = Vec3::Zero();
};

/// The rate of a tangent that follows the normal by the shortest turn, without spinning about it:
/// what a contact that keeps its frame from step to step has.
Vec3 follow_normal_rate(const Vec3& n, const Vec3& n_rate, const Vec3& tangent);

/// The tangents along and across the slip: t1 is the direction of the part of `velocity` [m/s] in
/// the tangent plane, where the velocity changes by `acceleration` [m/s2]. False where nothing
/// slips.
[[nodiscard]] bool slip_tangent_rate(const Vec3& n, const Vec3& n_rate, const Vec3& velocity,
                                     const Vec3& acceleration, TangentRate& out);

}  // namespace tumble
