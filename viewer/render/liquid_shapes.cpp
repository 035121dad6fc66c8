#include "viewer/render/liquid_shapes.hpp"

#include "engine/geometry/mass_properties/principal_axes.hpp"
#include "engine/math/det/det.hpp"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

/// Number of neighbours in the interior: that of cubes with an edge of one spacing in a ball of
/// radius `reach`.
constexpr double all_neighbours =
    4 * det::pi / 3 * LiquidNeighbours::reach * LiquidNeighbours::reach * LiquidNeighbours::reach;
/// A particle with less than this share of the neighbours of the interior is near a surface or a
/// wall. Half a spacing from a plane the share is 0.68, one and a half spacings from it 0.96 [-].
constexpr double skin_share = 0.85;
/// For a cubic lattice with a plane surface: distance from a particle of the outermost layer to the
/// mean of its neighbours, weighted by 1 - u^3, and the change of that distance per displacement of
/// the particle out of the layer. Sums over the lattice, lengths in units of the reach [-].
constexpr double mean_of_outermost = 0.2221, mean_by_offset = 0.636;
/// Share of a particle's distance from the estimated surface that is removed, lambda in Yu and Turk
/// [-].
constexpr double smoothing = 0.8;
/// Least ratio of the shortest half axis to the longest [-].
constexpr double most_flat = 0.35;

struct Spread {
  Vec3 mean = Vec3::Zero();        ///< of the neighbours, from the particle [m]
  Mat3 covariance = Mat3::Zero();  ///< [m2]
  double weights = 0;
};

Spread spread_about(const LiquidNeighbours& neighbours, size_t place) {
  const Vec3& x = neighbours.x()[neighbours.particle(place)];
  Spread s;
  neighbours.over(place, [&](uint32_t j, double u) {
    const double w = 1 - u * u * u;
    const Vec3 d = neighbours.x()[j] - x;
    s.weights += w;
    s.mean += w * d;
    s.covariance += w * d * d.transpose();
  });
  if (!(s.weights > 0)) return s;
  s.mean /= s.weights;
  s.covariance = s.covariance / s.weights - s.mean * s.mean.transpose();
  return s;
}

LiquidShape shape_of(const Spread& s, const Vec3& x, double reach, double whole) {
  LiquidShape out{x};
  const double far = s.mean.norm() / reach;
  // Particles that lie deeper than the outermost stay where they are.
  const double outermost = std::clamp(4 * far / mean_of_outermost - 1, 0.0, 1.0);
  if (outermost > 0)
    out.centre +=
        (whole * smoothing * outermost * (1 - mean_of_outermost / far) / mean_by_offset) * s.mean;
  const PrincipalAxes axes = principal_axes(s.covariance);
  if (!(axes.moments[2] > 0)) return out;
  Vec3 stretch;
  for (int k = 0; k < 3; ++k) {
    const double axis = std::sqrt(std::max(axes.moments[k] / axes.moments[2], 0.0));
    stretch[k] = 1 / (1 + whole * (std::max(axis, most_flat) - 1));
  }
  out.to_ball = axes.axes * stretch.asDiagonal() * axes.axes.transpose();
  return out;
}

}  // namespace

std::vector<LiquidShape> liquid_shapes(const LiquidNeighbours& neighbours,
                                       std::span<const double> whole) {
  std::vector<LiquidShape> out(neighbours.size());
  for (size_t i = 0; i < out.size(); ++i) out[i].centre = neighbours.x()[i];
  if (!neighbours.known()) return out;
  const double reach = LiquidNeighbours::reach * neighbours.spacing();
  for (size_t place = 0; place < neighbours.size(); ++place) {
    const uint32_t i = neighbours.particle(place);
    if (neighbours.count(place) > skin_share * all_neighbours || !(whole[i] > 0)) continue;
    const Spread s = spread_about(neighbours, place);
    if (s.weights > 0) out[i] = shape_of(s, neighbours.x()[i], reach, whole[i]);
  }
  return out;
}

}  // namespace tumble
