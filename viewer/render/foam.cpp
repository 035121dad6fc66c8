#include "viewer/render/foam.hpp"

#include <algorithm>
#include <cmath>

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

/// Points by the cell that they are in.
class Cells {
 public:
  Cells(std::span<const Vec3> x, double side) : side_(side) {
    Vec3 low = Vec3::Constant(1e300), high = -low;
    for (const Vec3& p : x)
      if (p.allFinite()) low = low.cwiseMin(p), high = high.cwiseMax(p);
    low_ = low;
    // Where few are far apart cells grow, so that there are not more cells than points by much.
    for (;;) {
      double cells = 1;
      for (int k = 0; k < 3; ++k) {
        count_[k] = std::max(1.0, std::floor((high[k] - low[k]) / side_) + 1);
        cells *= count_[k];
      }
      if (cells <= 8 * double(x.size()) + 64) break;
      side_ *= 1.5;
    }
    first_.assign(size_t(count_[0] * count_[1] * count_[2]) + 1, 0);
    for (const Vec3& p : x)
      if (p.allFinite()) ++first_[cell(p) + 1];
    for (size_t c = 1; c < first_.size(); ++c) first_[c] += first_[c - 1];
    order_.resize(first_.back());
    std::vector<uint32_t> next = first_;
    for (uint32_t i = 0; i < x.size(); ++i)
      if (x[i].allFinite()) order_[next[cell(x[i])]++] = i;
  }

  template <class F>
  void near(const Vec3& p, const F& f) const {
    int low[3], high[3];
    for (int k = 0; k < 3; ++k) {
      const int c = place(p, k);
      low[k] = std::max(c - 1, 0);
      high[k] = std::min(c + 1, int(count_[k]) - 1);
    }
    for (int z = low[2]; z <= high[2]; ++z)
      for (int y = low[1]; y <= high[1]; ++y) {
        const size_t row = (size_t(z) * size_t(count_[1]) + size_t(y)) * size_t(count_[0]);
        const uint32_t last = first_[row + size_t(high[0]) + 1];
        for (uint32_t k = first_[row + size_t(low[0])]; k < last; ++k) f(order_[k]);
      }
  }

 private:
  int place(const Vec3& p, int k) const {
    return std::clamp(int((p[k] - low_[k]) / side_), 0, int(count_[k]) - 1);
  }
  size_t cell(const Vec3& p) const {
    return (size_t(place(p, 2)) * size_t(count_[1]) + size_t(place(p, 1))) * size_t(count_[0]) +
           size_t(place(p, 0));
  }
  double side_;
  Vec3 low_;
  double count_[3];
  std::vector<uint32_t> first_, order_;
};

/// Calls f(j, weight) for the neighbours of a particle, which weigh less the farther they are.
template <class F>
void over_neighbours(const FoamInput& in, const Cells& cells, size_t i, double reach, const F& f) {
  cells.near(in.x[i], [&](uint32_t j) {
    const double r2 = (in.x[i] - in.x[j]).squaredNorm();
    if (j != i && r2 < reach * reach && r2 > 0) f(j, 1 - std::sqrt(r2) / reach);
  });
}

/// Mean speed at which neighbours come nearer [m/s].
double approach(const FoamInput& in, const Cells& cells, size_t i, double reach) {
  double sum = 0, weights = 0;
  over_neighbours(in, cells, i, reach, [&](uint32_t j, double weight) {
    const Vec3 v = (in.v[i] - in.v[j]).cast<double>();
    const Vec3 apart = (in.x[i] - in.x[j]).normalized();
    weights += weight;
    // |v| (1 - cos) / 2: nothing of what moves apart, all of what meets.
    sum += weight * 0.5 * (v.norm() - v.dot(apart));
  });
  return weights > 0 ? sum / weights : 0;
}

bool near_surface(const FoamInput& in, size_t i) {
  return in.share[i] <= inner_share && in.x[i].allFinite();
}

}  // namespace

std::vector<float> foam_of(const FoamInput& in) {
  std::vector<float> foam(in.x.size(), 0);
  if (in.x.empty() || in.v.size() != in.x.size() || in.share.size() != in.x.size() ||
      !(in.spacing > 0))
    return foam;
  const double reach = foam_reach * in.spacing;
  const Cells cells(in.x, reach);
  const double wave = std::sqrt(gravity * 10 * in.spacing / (2 * M_PI));
  std::vector<float> broken(in.x.size(), 0);
  for (size_t i = 0; i < in.x.size(); ++i) {
    if (!near_surface(in, i)) continue;
    const double speed = approach(in, cells, i, reach) / wave;
    broken[i] = float(std::clamp((speed - first_break) / (all_broken - first_break), 0.0, 1.0));
  }
  for (size_t i = 0; i < in.x.size(); ++i) {
    if (!near_surface(in, i)) continue;
    double sum = double(broken[i]), weights = 1;
    over_neighbours(in, cells, i, reach, [&](uint32_t j, double weight) {
      sum += weight * double(broken[j]);
      weights += weight;
    });
    const double alone = (clear_drop - double(in.share[i])) / (clear_drop - white_drop);
    foam[i] = float(std::clamp(std::max(sum / weights, alone), 0.0, 1.0));
  }
  return foam;
}

}  // namespace tumble
