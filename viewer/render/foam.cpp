#include "viewer/render/foam.hpp"

#include "engine/dynamics/particles/neighbours/neighbour_lists.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tumble {
namespace {

/// Neighbours are within so many spacings.
constexpr double foam_reach = 2;
/// Only near the surface is there air to take in: particles denser than this are inside [-].
constexpr float inner_share = 0.97f;
/// Speeds of approach at which liquid begins to break and is all white, in units of the speed of
/// waves as long as ten spacings.
constexpr double first_break = 0.15, all_broken = 0.6;
/// Shares of the density at rest at which a drop is as white as can be, and not white [-].
constexpr double white_drop = 0.35, clear_drop = 0.6;
constexpr double gravity = 9.81;  ///< that of waves on Earth [m/s2]

/// The neighbours of all particles, by place: see NeighbourLists.
class FoamNeighbours {
 public:
  FoamNeighbours(const FoamInput& in, double reach) : in_(in), reach_(reach) {
    known_ = lists_.update(in.x, {.reach = reach, .skin = 0, .box = {}}, nullptr).ok();
  }
  /// Not where a particle is nowhere.
  bool known() const { return known_; }
  size_t size() const { return lists_.size(); }
  uint32_t particle(size_t place) const { return lists_.order()[place]; }

  /// Calls f(j, weight) for the neighbours of a particle, which weigh less the farther they are.
  template <class F>
  void over(size_t place, const F& f) const {
    for (const uint32_t other : lists_.of(place).first(lists_.count(place))) {
      const uint32_t j = particle(other);
      const double r = (in_.x[particle(place)] - in_.x[j]).norm();
      if (r < reach_ && r > 0) f(j, 1 - r / reach_);
    }
  }

 private:
  const FoamInput& in_;
  double reach_;
  NeighbourLists lists_;
  bool known_ = false;
};

/// Mean speed at which neighbours come nearer [m/s].
double approach(const FoamInput& in, const FoamNeighbours& neighbours, size_t place) {
  double sum = 0, weights = 0;
  const uint32_t i = neighbours.particle(place);
  neighbours.over(place, [&](uint32_t j, double weight) {
    const Vec3 v = (in.v[i] - in.v[j]).cast<double>();
    const Vec3 apart = (in.x[i] - in.x[j]).normalized();
    weights += weight;
    // |v| (1 - cos) / 2: nothing of what moves apart, all of what meets.
    sum += weight * 0.5 * (v.norm() - v.dot(apart));
  });
  return weights > 0 ? sum / weights : 0;
}

bool near_surface(const FoamInput& in, size_t i) {
  return in.share[i] <= inner_share;
}

}  // namespace

std::vector<float> foam_of(const FoamInput& in) {
  std::vector<float> foam(in.x.size(), 0);
  if (in.x.empty() || in.v.size() != in.x.size() || in.share.size() != in.x.size() ||
      !(in.spacing > 0))
    return foam;
  const FoamNeighbours neighbours(in, foam_reach * in.spacing);
  if (!neighbours.known()) return foam;
  const double wave = std::sqrt(gravity * 10 * in.spacing / (2 * std::numbers::pi));
  std::vector<float> broken(in.x.size(), 0);
  for (size_t place = 0; place < neighbours.size(); ++place) {
    const uint32_t i = neighbours.particle(place);
    if (!near_surface(in, i)) continue;
    const double speed = approach(in, neighbours, place) / wave;
    broken[i] = float(std::clamp((speed - first_break) / (all_broken - first_break), 0.0, 1.0));
  }
  for (size_t place = 0; place < neighbours.size(); ++place) {
    const uint32_t i = neighbours.particle(place);
    if (!near_surface(in, i)) continue;
    double sum = double(broken[i]), weights = 1;
    neighbours.over(place, [&](uint32_t j, double weight) {
      sum += weight * double(broken[j]);
      weights += weight;
    });
    const double alone = (clear_drop - double(in.share[i])) / (clear_drop - white_drop);
    foam[i] = float(std::clamp(std::max(sum / weights, alone), 0.0, 1.0));
  }
  return foam;
}

}  // namespace tumble
