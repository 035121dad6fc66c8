#include "viewer/render/scene_scales.hpp"

#include "engine/collision/shape.hpp"

#include <algorithm>
#include <limits>
#include <vector>

namespace tumble {

double typical_size(const Frame& frame) {
  constexpr double without_bodies = 0.5;
  std::vector<double> sizes;
  for (size_t slot = 0; slot < frame.body_slots(); ++slot) {
    const BodyInfo& info = frame.info(slot);
    if (frame.body(slot).id.is_null() || info.type != BodyType::dynamic) continue;
    double size = 0;
    info.for_seen([&size](const BodyShape& part, const Vec3f&) {
      size = std::max(size, part.pose.x.norm() + part.shape->bounding_radius());
    });
    sizes.push_back(size);
  }
  if (sizes.empty()) return without_bodies;
  const auto middle = sizes.begin() + std::ptrdiff_t((sizes.size() - 1) / 2);
  std::nth_element(sizes.begin(), middle, sizes.end());
  return *middle;
}

namespace {

/// From a point to the farthest corner, at most [m].
double reach_of(const Vec3& from, const Aabb& box) {
  return (box.centre() - from).norm() + 0.5 * box.extent().norm();
}

/// Median distance of the boxes from a point [m].
double typical_reach(const Vec3& from, std::span<const Aabb> boxes, std::vector<double>& reaches) {
  reaches.clear();
  for (const Aabb& box : boxes) reaches.push_back(reach_of(from, box));
  const auto middle = reaches.begin() + std::ptrdiff_t((reaches.size() - 1) / 2);
  std::nth_element(reaches.begin(), middle, reaches.end());
  return *middle;
}

}  // namespace

// The box with the least median distance to the others, of a few that are tried, is in the midst of
// most of them, no matter how far the rest is away; the mean position would not be.
Aabb bounds_of_most(std::span<const Aabb> boxes) {
  constexpr size_t tried = 32;
  std::vector<Aabb> finite;
  for (const Aabb& box : boxes)
    if (box.min.allFinite() && box.max.allFinite() && !box.empty()) finite.push_back(box);
  Aabb most;
  if (finite.empty()) return most;
  std::vector<double> reaches;
  double least = std::numeric_limits<double>::infinity();
  Vec3 middle = finite.front().centre();
  for (size_t k = 0; k < std::min(tried, finite.size()); ++k) {
    const Vec3 from = finite[k * finite.size() / std::min(tried, finite.size())].centre();
    const double reach = typical_reach(from, finite, reaches);
    if (!(reach < least)) continue;
    least = reach;
    middle = from;
  }
  for (const Aabb& box : finite)
    if (!(reach_of(middle, box) > flown_away * std::max(least, 1e-3))) most.include(box);
  return most.empty() ? finite.front() : most;
}

}  // namespace tumble
