#include "engine/geometry/isosurface/smoothed_balls.hpp"

#include "engine/core/chunks.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace tumble {
namespace {

constexpr int nodes_along = SparseField::edge;  ///< of a brick
constexpr double reach_of_ball = 4;  ///< in radii: twice the distance of touching balls [-]

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

/// First and last index of the bricks, or nodes, of a size that an interval touches.
std::pair<int32_t, int32_t> bricks_between(double from, double to, double size) {
  return {int32_t(std::floor(from / size)), int32_t(std::floor(to / size))};
}

/// Distance from a point to the nodes of a brick, or a lower bound of it [m].
double distance_to(const GridIndex& brick, double spacing, const Vec3& x) {
  Vec3 apart;
  for (int k = 0; k < 3; ++k) {
    const double low = spacing * nodes_along * brick[size_t(k)];
    apart[k] = std::max({low - x[k], x[k] - (low + spacing * (nodes_along - 1)), 0.0});
  }
  return apart.norm();
}

/// All pairs of balls and bricks into which they reach, ordered by brick, then ball; an error if
/// there are too many.
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
    // If radii and cells fit each other, at most some hundred balls reach into a brick.
    if ((count += own) > 256.0 * double(most_bricks)) return crowd;
    for (int32_t a = ranges[0].first; a <= ranges[0].second; ++a)
      for (int32_t b = ranges[1].first; b <= ranges[1].second; ++b)
        for (int32_t c = ranges[2].first; c <= ranges[2].second; ++c)
          if (const GridIndex brick = {a, b, c}; distance_to(brick, spacing, centres[i]) < r)
            out.push_back({brick, uint32_t(i)});
  }
  std::sort(out.begin(), out.end());
  size_t bricks = 0;
  for (size_t i = 0; i < out.size(); ++i) bricks += i == 0 || out[i].brick != out[i - 1].brick;
  if (bricks > most_bricks) return crowd;
  return out;
}

/// Weighted sums at the nodes of a brick, computed one row along x at a time.
class BrickSums {
 public:
  BrickSums(const SparseField& field, const GridIndex& brick) : h_(field.spacing) {
    for (size_t k = 0; k < 3; ++k) first_[k] = nodes_along * brick[k];
    for (Nodes* sum : {&weight_, &radius_, &x_, &y_, &z_}) sum->fill(0);
  }

  void add(const Vec3& centre, double radius) {
    const double r = reach_of_ball * radius, scale = 1 / (r * r);
    Row dx;
    for (int x = 0; x < nodes_along; ++x) dx[size_t(x)] = centre[0] - h_ * (first_[0] + x);
    for (int z = 0; z < nodes_along; ++z) {
      const double dz = centre[2] - h_ * (first_[2] + z);
      for (int y = 0; y < nodes_along; ++y) {
        const double dy = centre[1] - h_ * (first_[1] + y);
        const double rest = 1 - scale * (dy * dy + dz * dz);
        if (rest > 0)
          add_row(size_t((z * nodes_along + y) * nodes_along), dx, dy, dz, rest, scale, radius);
      }
    }
  }
  /// Writes the values; false if no ball reaches any node.
  bool give(SparseField::Brick& out, double outside) const {
    bool any = false;
    for (size_t n = 0; n < weight_.size(); ++n) {
      const bool met = weight_[n] > 0;
      any = any || met;
      out.value[n] = met ? (Vec3(x_[n], y_[n], z_[n]).norm() - radius_[n]) / weight_[n] : outside;
    }
    return any;
  }

 private:
  using Row = std::array<double, nodes_along>;
  using Nodes = std::array<double, nodes_along * nodes_along * nodes_along>;

  /// `rest` is 1 minus the part of (d/R)^2 that is common to the row.
  void add_row(size_t at, const Row& dx, double dy, double dz, double rest, double scale,
               double radius) {
    for (size_t k = 0; k < dx.size(); ++k) {
      const double s = std::max(rest - scale * (dx[k] * dx[k]), 0.0);
      const double w = s * s * s;
      weight_[at + k] += w;
      radius_[at + k] += w * radius;
      x_[at + k] += w * dx[k];
      y_[at + k] += w * dy;
      z_[at + k] += w * dz;
    }
  }

  double h_;
  std::array<int, 3> first_;
  Nodes weight_, radius_;
  Nodes x_, y_, z_;  ///< displacements from the node to the weighted centres
};

}  // namespace

Result<SparseField> smoothed_balls(std::span<const Vec3> centres, std::span<const double> radii,
                                   double spacing, Crew* crew) {
  if (Status fine = check_balls(centres, radii, spacing); !fine) return fine.error();
  SparseField out;
  out.spacing = spacing;
  const double largest = radii.empty() ? 0 : *std::max_element(radii.begin(), radii.end());
  if (!(largest > 0)) return out;
  // The value that the field has at the limit of a ball's reach.
  out.outside = (reach_of_ball - 1) * largest;
  const auto met = meetings(centres, radii, spacing);
  if (!met) return met.error();
  std::vector<size_t> starts;  // first ball of each brick
  for (size_t i = 0; i < met->size(); ++i)
    if (i == 0 || (*met)[i].brick != (*met)[i - 1].brick) starts.push_back(i);
  out.bricks.resize(starts.size());
  std::vector<uint8_t> reached(starts.size());
  starts.push_back(met->size());
  const auto fill = [&](size_t, size_t first, size_t last) {
    for (size_t b = first; b < last; ++b) {
      SparseField::Brick& brick = out.bricks[b];
      brick.at = (*met)[starts[b]].brick;
      BrickSums sums(out, brick.at);
      for (size_t i = starts[b]; i < starts[b + 1]; ++i)
        sums.add(centres[(*met)[i].ball], radii[(*met)[i].ball]);
      reached[b] = sums.give(brick, out.outside);
    }
  };
  constexpr size_t least_bricks = 16;  // fewest bricks worth another thread
  for_chunks(crew, out.bricks.size(), fill, least_bricks);
  size_t kept = 0;
  for (size_t b = 0; b < out.bricks.size(); ++b) {
    if (!reached[b]) continue;
    if (kept != b) out.bricks[kept] = out.bricks[b];
    ++kept;
  }
  out.bricks.resize(kept);
  return out;
}

}  // namespace tumble
