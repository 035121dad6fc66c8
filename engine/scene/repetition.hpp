#pragma once
#include "engine/core/result.hpp"
#include "engine/scene/description/body.hpp"

#include <string>
#include <vector>

namespace tumble {

struct SceneDescription;

/// The number of copies that the nested repetitions of a body make; 1 without any. A double, so
/// that absurdly large counts do not overflow before they are rejected.
double copy_count(const BodyDescription& body);

/// The pose of every copy in order, the first repetition outermost. Copies differ from the body's
/// own pose P by frames F: P.x + F.x, F.q P.q for one repetition; inner frames are turned along
/// with outer ones. `warnings` receives what could not be done as asked.
/// Errors: a formula with an unknown name or without a finite value.
Result<std::vector<Pose>> copy_poses(const SceneDescription& scene, const std::string& body_name,
                                     const BodyDescription& body,
                                     std::vector<std::string>& warnings);

/// The name of a body in which the expression in brackets is evaluated for copy `i`: "link[i+1]"
/// becomes "link[4]". Errors: an invalid expression, or one whose value is not an integer.
Result<std::string> counted_name(const std::string& name, int i);

/// Seed of everything random about one named thing: does not change when others come or go.
uint64_t named_seed(uint64_t scene_seed, std::string_view name);

/// Whether a point of the unit cube about the origin is inside the region inscribed in it; `room`
/// is the share of its squared radius by which the point may be outside. The axis of a cylinder is
/// y.
bool in_region(const Vec3& p, ScatterRegion region, double room = 0);
/// A uniformly random point of the box or the ball of the given full extents about the origin.
class Random;
Vec3 random_point(Random& random, ScatterRegion region, const Vec3& size);
/// A uniformly random rotation (Shoemake 1992).
Quat random_rotation(Random& random);

}  // namespace tumble
