// Thick-walled surfaces of revolution that stand on y = 0 and hold things.
#include "assets/generate/constructions.hpp"
#include "assets/generate/makers.hpp"
#include "engine/math/det/det.hpp"

#include <algorithm>
#include <cmath>

namespace tumble::assets {
namespace {

/// Catmull-Rom curve through the points, `steps` pieces between neighbours.
Loop2 smooth(const Loop2& through, int steps) {
  Loop2 curve;
  const auto at = [&](long i) {
    return through[size_t(std::min(std::max(i, 0L), long(through.size()) - 1))];
  };
  for (long i = 0; i + 1 < long(through.size()); ++i) {
    const Point2 a = at(i - 1), b = at(i), c = at(i + 1), d = at(i + 2);
    for (int k = 0; k < steps; ++k) {
      const double t = double(k) / steps;
      const double wa = -0.5 * t + t * t - 0.5 * t * t * t, wb = 1 - 2.5 * t * t + 1.5 * t * t * t;
      const double wc = 0.5 * t + 2 * t * t - 1.5 * t * t * t, wd = -0.5 * t * t + 0.5 * t * t * t;
      curve.push_back(
          {wa * a.u + wb * b.u + wc * c.u + wd * d.u, wa * a.w + wb * b.w + wc * c.w + wd * d.w});
    }
  }
  curve.push_back(through.back());
  return curve;
}

/// Closed profile of a vessel from its outer curve (foot to rim), its wall and the height of its
/// floor: axis, foot, outer curve, a rounded rim, the inner curve back down, floor, axis.
Loop2 vessel(const Loop2& outer, double wall, double floor) {
  Loop2 profile = {{0, 0}};
  profile.insert(profile.end(), outer.begin(), outer.end());
  const size_t n = outer.size();
  Loop2 inner;
  Point2 along{0, 1};
  for (size_t i = 0; i < n; ++i) {
    const Point2 &a = outer[i == 0 ? 0 : i - 1], &b = outer[std::min(i + 1, n - 1)];
    const double length = std::sqrt((b.u - a.u) * (b.u - a.u) + (b.w - a.w) * (b.w - a.w));
    along = {(b.u - a.u) / length, (b.w - a.w) / length};
    inner.push_back({outer[i].u - wall * along.w, outer[i].w + wall * along.u});
  }
  for (int i = 1; i < 6; ++i) {  // half circle from the outer to the inner rim
    const double c = det::cos(det::pi * i / 6), s = det::sin(det::pi * i / 6);
    const Point2 middle{(outer.back().u + inner.back().u) / 2,
                        (outer.back().w + inner.back().w) / 2};
    profile.push_back({middle.u + wall / 2 * (c * along.w + s * along.u),
                       middle.w + wall / 2 * (-c * along.u + s * along.w)});
  }
  for (size_t i = n; i-- > 0 && inner[i].w > floor + 0.004;) profile.push_back(inner[i]);
  profile.push_back({profile.back().u * 0.93, floor});
  profile.push_back({0, floor});
  return profile;
}

Mesh stand(const Loop2& profile, int segments) {
  Builder builder;
  revolve(builder, profile, segments);
  return builder.mesh();
}

}  // namespace

Mesh make_bowl() {
  // A foot ring, then an arc of a sphere of radius 0.45 about (0, 0.47).
  Loop2 outer = {{0.16, 0}, {0.165, 0.02}};
  for (const Point2& p : arc(0, 0.47, 0.45, -1.15, -0.12, 11)) outer.push_back(p);
  return stand(vessel(outer, 0.03, 0.06), 48);
}

Mesh make_cup() {
  const Loop2 outer =
      smooth({{0.085, 0}, {0.098, 0.02}, {0.115, 0.09}, {0.128, 0.17}, {0.14, 0.28}}, 4);
  return stand(vessel(outer, 0.014, 0.025), 40);
}

Mesh make_hourglass() {
  // Half of the inside, from the lower end to the waist; the rest is its mirror image.
  Loop2 inner =
      smooth({{0.235, 0}, {0.25, 0.08}, {0.245, 0.19}, {0.19, 0.32}, {0.1, 0.43}, {0.06, 0.5}}, 3);
  for (size_t i = inner.size() - 1; i-- > 0;) inner.push_back({inner[i].u, 1 - inner[i].w});
  constexpr double wall = 0.016;
  Loop2 profile;
  for (const Point2& p : inner) profile.push_back({p.u + wall, p.w});
  profile.insert(profile.end(), inner.rbegin(), inner.rend());
  return stand(profile, 40);
}

Mesh make_vase() {
  const Loop2 outer = smooth({{0.11, 0},
                              {0.125, 0.02},
                              {0.17, 0.12},
                              {0.195, 0.24},
                              {0.165, 0.38},
                              {0.095, 0.49},
                              {0.075, 0.56},
                              {0.09, 0.62},
                              {0.125, 0.66}},
                             2);
  return stand(vessel(outer, 0.018, 0.03), 44);
}

}  // namespace tumble::assets
