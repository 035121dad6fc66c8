#include "engine/geometry/isosurface/smoothed_balls.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace tumble {
namespace {

constexpr int nodes_along = SparseField::edge;  ///< of a brick
constexpr double reach_of_ball = 4;  ///< in its radii: twice the distance of touching balls [-]

/// A ball that reaches into a brick.
struct Meeting {
  GridIndex brick;
  uint32_t ball;
  auto operator<=>(const Meeting&) const = default;
};

Status check_balls(std::span<const Vec3> centres, std::span<const double> radii, double spacing) {
  Aabb box;
  for (size_t i = 0; i < centres.size(); ++i) {
    if (!centres[i].allFinite() || !std::isfinite(radii[i]))
      return Error{ErrorCode::invalid_argument, fmt::format("ball {} is not finite", i), {}, {}};
    box.include(Aabb{centres[i], centres[i]}.inflated(reach_of_ball * radii[i]));
  }
  return check_spacing(spacing, box);
}

/// First and last of the bricks, or nodes, of a size that an interval touches.
std::pair<int32_t, int32_t> bricks_between(double from, double to, double size) {
  return {int32_t(std::floor(from / size)), int32_t(std::floor(to / size))};
}

/// Which balls reach into which bricks, in the order of both; an error when they are too
/// many.
Result<std::vector<Meeting>> meetings(std::span<const Vec3> centres, std::span<const double> radii,
                                      double spacing) {
  std::vector<Meeting> out;
  const Error crowd{
      ErrorCode::invalid_argument,
      fmt::format("the surface of {} balls needs too many cells of {} m", centres.size(), spacing),
      {},
      "choose larger cells"};
  for (size_t i = 0; i < centres.size(); ++i) {
    if (!(radii[i] > 0)) continue;
    const double r = reach_of_ball * radii[i];
    std::array<std::pair<int32_t, int32_t>, 3> ranges;
    double count = double(out.size());
    double own = 1;
    for (int k = 0; k < 3; ++k) {
      ranges[size_t(k)] =
          bricks_between(centres[i][k] - r, centres[i][k] + r, spacing * nodes_along);
      own *= double(ranges[size_t(k)].second) - ranges[size_t(k)].first + 1;
    }
    // A brick is met by hundreds of balls at most where radii and cells fit each other.
    if ((count += own) > 256.0 * double(most_bricks)) return crowd;
    for (int32_t a = ranges[0].first; a <= ranges[0].second; ++a)
      for (int32_t b = ranges[1].first; b <= ranges[1].second; ++b)
        for (int32_t c = ranges[2].first; c <= ranges[2].second; ++c)
          out.push_back({{a, b, c}, uint32_t(i)});
  }
  std::sort(out.begin(), out.end());
  size_t bricks = 0;
  for (size_t i = 0; i < out.size(); ++i) bricks += i == 0 || out[i].brick != out[i - 1].brick;
  if (bricks > most_bricks) return crowd;
  return out;
}

/// Weighted sums at the nodes of a brick.
class BrickSums {
 public:
  BrickSums(const SparseField& field, const GridIndex& brick) : h_(field.spacing) {
    first_ = {nodes_along * brick[0], nodes_along * brick[1], nodes_along * brick[2]};
    weight_.fill(0);
    radius_.fill(0);
    way_.fill(Vec3::Zero());
  }

  void add(const Vec3& centre, double radius) {
    const double r = reach_of_ball * radius;
    std::array<int, 3> low, high;
    for (size_t k = 0; k < 3; ++k) {
      const double c = centre[int(k)];
      low[k] = std::max(int(std::ceil((c - r) / h_ - first_[k])), 0);
      high[k] = std::min(int(std::floor((c + r) / h_ - first_[k])), nodes_along - 1);
    }
    for (int z = low[2]; z <= high[2]; ++z)
      for (int y = low[1]; y <= high[1]; ++y)
        for (int x = low[0]; x <= high[0]; ++x) {
          const Vec3 node(double(first_[0] + x), double(first_[1] + y), double(first_[2] + z));
          const Vec3 way = centre - h_ * node;
          const double rest = 1 - way.squaredNorm() / (r * r);
          if (rest <= 0) continue;
          const double w = rest * rest * rest;
          const size_t n = size_t((z * nodes_along + y) * nodes_along + x);
          weight_[n] += w;
          radius_[n] += w * radius;
          way_[n] += w * way;
        }
  }
  /// False where no ball reaches a node.
  bool give(SparseField::Brick& out, double outside) const {
    bool any = false;
    for (size_t n = 0; n < weight_.size(); ++n) {
      const bool met = weight_[n] > 0;
      any = any || met;
      out.value[n] = met ? (way_[n].norm() - radius_[n]) / weight_[n] : outside;
    }
    return any;
  }

 private:
  double h_;
  std::array<int, 3> first_;
  std::array<double, nodes_along * nodes_along * nodes_along> weight_, radius_;
  std::array<Vec3, nodes_along * nodes_along * nodes_along> way_;  ///< from the node to the centres
};

}  // namespace

Result<SparseField> smoothed_balls(std::span<const Vec3> centres, std::span<const double> radii,
                                   double spacing) {
  if (Status fine = check_balls(centres, radii, spacing); !fine) return fine.error();
  SparseField out;
  out.spacing = spacing;
  const double largest = radii.empty() ? 0 : *std::max_element(radii.begin(), radii.end());
  if (!(largest > 0)) return out;
  // What the field comes to at the end of the reach of a ball.
  out.outside = (reach_of_ball - 1) * largest;
  const auto met = meetings(centres, radii, spacing);
  if (!met) return met.error();
  for (size_t i = 0; i < met->size();) {
    const GridIndex brick = (*met)[i].brick;
    BrickSums sums(out, brick);
    for (; i < met->size() && (*met)[i].brick == brick; ++i)
      sums.add(centres[(*met)[i].ball], radii[(*met)[i].ball]);
    out.bricks.emplace_back().at = brick;
    if (!sums.give(out.bricks.back(), out.outside)) out.bricks.pop_back();
  }
  return out;
}

}  // namespace tumble
