#include "engine/geometry/distance_field/distance_field.hpp"

#include "engine/core/hash.hpp"
#include "engine/geometry/distance_field/tolerances.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tumble {

/// The fine cell that contains a point, and the point's place in it.
struct DistanceField::FineCell {
  size_t first;             ///< index of its lowest corner among the values
  Vec3 fraction;            ///< coordinates of the point in the cell, each in [0, 1]
  std::array<int, 3> node;  ///< grid coordinates of its lowest corner
};

namespace {

/// Values at the corners of a cube, x varying fastest.
using CubeValues = std::array<double, 8>;

double interpolate(const CubeValues& v, const Vec3& f) {
  const double a = v[0] + f.x() * (v[1] - v[0]), b = v[2] + f.x() * (v[3] - v[2]),
               c = v[4] + f.x() * (v[5] - v[4]), d = v[6] + f.x() * (v[7] - v[6]);
  const double low = a + f.y() * (b - a), high = c + f.y() * (d - c);
  return low + f.z() * (high - low);
}

/// The same with the derivatives by the fractions.
double interpolate(const CubeValues& v, const Vec3& f, Vec3& slope) {
  const double da = v[1] - v[0], db = v[3] - v[2], dc = v[5] - v[4], dd = v[7] - v[6];
  const double a = v[0] + f.x() * da, b = v[2] + f.x() * db, c = v[4] + f.x() * dc,
               d = v[6] + f.x() * dd;
  const double low = a + f.y() * (b - a), high = c + f.y() * (d - c);
  const double dx_low = da + f.y() * (db - da), dx_high = dc + f.y() * (dd - dc);
  slope = {dx_low + f.z() * (dx_high - dx_low), (b - a) + f.z() * ((d - c) - (b - a)), high - low};
  return low + f.z() * (high - low);
}

/// Bounds of the signed distance at a point.
struct DistanceInterval {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();

  /// Narrows the bounds by the distance `d`, known to within `error`, of a point `way` away: the
  /// distance function has Lipschitz constant 1.
  void from(double d, double way, double error) {
    low = std::max(low, d - way - error);
    high = std::min(high, d + way + error);
  }
  /// Narrows the bounds, given that the magnitude is at least `least` at a point `way` away.
  void beyond(bool inside, double least, double way) {
    if (inside) {
      high = std::min(high, way - least);
    } else {
      low = std::max(low, least - way);
    }
  }
};

}  // namespace

bool DistanceField::find_cell(const Vec3& p, FineCell& out) const {
  const Vec3 place = (p - layout_.origin) * inverse_cell_;
  std::array<int, 3> block, inner;
  for (int k = 0; k < 3; ++k) {
    const int cells = FieldLayout::cells_along * layout_.blocks[size_t(k)];
    if (!(place[k] >= 0 && place[k] < cells)) return false;
    const int n = int(place[k]);
    out.node[size_t(k)] = n;
    out.fraction[k] = place[k] - n;
    block[size_t(k)] = n / FieldLayout::cells_along;
    inner[size_t(k)] = n % FieldLayout::cells_along;
  }
  const uint32_t number = block_of_[layout_.block_index(block[0], block[1], block[2])];
  if (number == no_index) return false;
  out.first = number * FieldLayout::nodes_of_block +
              FieldLayout::node_in_block(inner[0], inner[1], inner[2]);
  return true;
}

/// The values at the corners of a cell, in storage steps; false if one is out of range.
template <class Stored>
bool DistanceField::read_corners(const std::vector<Stored>& values, const FineCell& cell,
                                 std::array<double, 8>& out) const {
  constexpr size_t row = FieldLayout::nodes_along, layer = row * row;
  constexpr Stored beyond = std::numeric_limits<Stored>::max();
  const Stored* v = values.data() + cell.first;
  const std::array<Stored, 8> corner{v[0],     v[1],         v[row],         v[row + 1],
                                     v[layer], v[layer + 1], v[layer + row], v[layer + row + 1]};
  bool all = true;
  for (size_t k = 0; k < 8; ++k) {
    all &= corner[k] < beyond && corner[k] > -beyond;
    out[k] = double(corner[k]);
  }
  return all;
}

bool DistanceField::corners_of(const FineCell& cell, std::array<double, 8>& out) const {
  return long_values_.empty() ? read_corners(short_values_, cell, out)
                              : read_corners(long_values_, cell, out);
}

double DistanceField::value(const Vec3& p) const {
  FineCell cell;
  CubeValues corner;
  if (find_cell(p, cell) && corners_of(cell, corner))
    return step_ * interpolate(corner, cell.fraction);
  return far_sample(p).distance;
}

double DistanceField::value(const Vec3& p, Vec3& gradient) const {
  FineCell cell;
  CubeValues corner;
  if (find_cell(p, cell) && corners_of(cell, corner)) {
    const double d = interpolate(corner, cell.fraction, gradient);
    gradient *= step_ * inverse_cell_;
    return step_ * d;
  }
  const DistanceSample far = far_sample(p);
  gradient = far.gradient;
  return far.distance;
}

DistanceSample DistanceField::sample(const Vec3& p) const {
  FineCell cell;
  CubeValues corner;
  if (!find_cell(p, cell) || !corners_of(cell, corner)) return far_sample(p);
  DistanceSample out;
  out.distance = step_ * interpolate(corner, cell.fraction, out.gradient);
  out.gradient *= step_ * inverse_cell_;
  // The weighted mean of the corners' distances is at most the root of the mean square.
  const Vec3 f = cell.fraction;
  out.error = layout_.cell * std::sqrt(f.dot(Vec3::Ones() - f)) + report_.node_error;
  return out;
}

DistanceSample DistanceField::coarse_sample(const Vec3& p) const {
  const double size = layout_.block_size();
  std::array<int, 3> block;
  Vec3 fraction;
  for (int k = 0; k < 3; ++k) {
    const double place = (p[k] - layout_.origin[k]) / size;
    block[size_t(k)] = std::clamp(int(place), 0, layout_.blocks[size_t(k)] - 1);
    fraction[k] = std::clamp(place - block[size_t(k)], 0.0, 1.0);
  }
  CubeValues corner;
  DistanceInterval known;
  const double float_rounding = std::numeric_limits<float>::epsilon();
  for (int n = 0; n < 8; ++n) {
    const int x = n & 1, y = n >> 1 & 1, z = n >> 2;
    const double d = corners_[layout_.corner_index(block[0] + x, block[1] + y, block[2] + z)];
    corner[size_t(n)] = d;
    known.from(d, size * (fraction - Vec3(x, y, z)).norm(), float_rounding * std::fabs(d));
  }
  FineCell cell;
  CubeValues fine;
  if (find_cell(p, cell)) {
    corners_of(cell, fine);
    const double beyond = long_values_.empty() ? std::numeric_limits<int16_t>::max()
                                               : std::numeric_limits<int32_t>::max();
    for (int n = 0; n < 8; ++n) {
      const double v = fine[size_t(n)];
      const double way = layout_.cell * (cell.fraction - Vec3(n & 1, n >> 1 & 1, n >> 2)).norm();
      if (std::fabs(v) < beyond) {
        known.from(step_ * v, way, report_.node_error);
      } else {
        known.beyond(v < 0, node_range_ - report_.node_error, way);
      }
    }
  }
  DistanceSample out;
  out.level = FieldLevel::coarse;
  const double between = interpolate(corner, fraction, out.gradient);
  out.gradient /= size;
  out.distance = std::clamp(between, known.low, std::max(known.low, known.high));
  out.error = std::max({known.high - out.distance, out.distance - known.low, 0.0});
  return out;
}

/// The answer where there is no fine cell.
DistanceSample DistanceField::far_sample(const Vec3& p) const {
  const Aabb box = layout_.box();
  const Vec3 nearest = p.cwiseMax(box.min).cwiseMin(box.max);
  if (nearest == p) return coarse_sample(p);
  // Outside of the field's box: not nearer than the mesh's box, and not farther than through the
  // nearest point of the field's box.
  DistanceSample out = coarse_sample(nearest);
  const Vec3 way = p - nearest;
  const double length = way.norm();
  const double least = (p - p.cwiseMax(mesh_box_.min).cwiseMin(mesh_box_.max)).norm();
  const double most = out.distance + out.error + length;
  out.level = FieldLevel::outside;
  out.distance = std::max(out.distance + length, least);
  out.error = std::max(out.distance - least, most - out.distance);
  if (length > 0) out.gradient = way / length;
  return out;
}

FieldFoot DistanceField::foot(const Vec3& p) const {
  FieldFoot out{p, 0};
  constexpr int most_steps = 8;
  for (int step = 0; step <= most_steps; ++step) {
    Vec3 gradient;
    const double d = value(out.point, gradient);
    out.residual = std::fabs(d);
    const double square = gradient.squaredNorm();
    if (step == most_steps || out.residual <= tolerances::foot_residual * layout_.cell ||
        !(square > 0))
      break;
    // On a ridge (medial axis) the gradient is short; the step is then no longer than the distance.
    out.point -= d / std::max(square, 1.0) * gradient;
  }
  return out;
}

uint64_t DistanceField::hash() const {
  const auto add = [](const auto& values, uint64_t seed) {
    return hash_bytes(values.data(), values.size() * sizeof(values[0]), seed);
  };
  const double numbers[] = {layout_.cell, layout_.origin.x(), layout_.origin.y(),
                            layout_.origin.z(), step_};
  uint64_t out = hash_bytes(numbers, sizeof numbers);
  out = add(block_of_, out);
  out = add(short_values_, out);
  out = add(long_values_, out);
  return add(corners_, out);
}

}  // namespace tumble
