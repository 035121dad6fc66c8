#include "engine/geometry/decomposition/exact_space.hpp"

#include "engine/geometry/triangle_mesh.hpp"

namespace tumble {
namespace {

/// Rounding errors in double precision: of values computed from exact numbers, such as a plane's
/// value at a point, and of coordinates. Each counts the operations and rounds up [-].
constexpr double value_error = 64 * 0x1p-53, coordinate_error = 16 * 0x1p-53;

template <class T, class U>
auto cross(const std::array<T, 3>& a, const std::array<U, 3>& b) {
  return std::array{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
                    a[0] * b[1] - a[1] * b[0]};
}
template <class T, class U>
auto dot(const std::array<T, 3>& a, const std::array<U, 3>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

}  // namespace

ExactSpace::ExactSpace(std::span<const Vec3> corners) {
  double largest = 0;
  for (const Vec3& c : corners) largest = std::max(largest, c.cwiseAbs().maxCoeff());
  std::frexp(largest, &exponent_);
  exponent_ -= bits - 3;
  points_.reserve(corners.size());
  for (const Vec3& c : corners) {
    ExactPoint& p = points_.emplace_back();
    for (int k = 0; k < 3; ++k)
      p.x[size_t(k)] = Numerator::fitted(Coordinate::from(c[k], exponent_));
    p.weight = Weight::fitted(Coordinate::from(1, 0));
    p.planes.fill(no_index);
  }
  near_.assign(corners.begin(), corners.end());
}

uint32_t ExactSpace::add_plane(const Vec3& a, const Vec3& b, const Vec3& c) {
  using Corner = std::array<Coordinate, 3>;
  std::array<Corner, 3> p;
  const std::array<Vec3, 3> through{a, b, c};
  for (size_t i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k) p[i][size_t(k)] = Coordinate::from(through[i][k], exponent_);
  const auto difference = [](const Corner& x, const Corner& y) {
    return std::array{x[0] - y[0], x[1] - y[1], x[2] - y[2]};
  };
  ExactPlane out;
  out.normal = cross(difference(p[1], p[0]), difference(p[2], p[0]));
  const Vec3 n(out.normal[0].estimate(), out.normal[1].estimate(), out.normal[2].estimate());
  const double length = n.norm();
  if (length == 0) return no_index;
  out.offset = Offset::fitted(dot(out.normal, p[0]));
  out.near = {n / length, std::ldexp(out.offset.estimate() / length, exponent_)};
  out.through = through;
  planes_.push_back(out);
  return uint32_t(planes_.size()) - 1;
}

uint32_t ExactSpace::add_point(uint32_t p, uint32_t q, uint32_t r) {
  const ExactPlane &a = planes_[p], &b = planes_[q], &c = planes_[r];
  const auto bc = cross(b.normal, c.normal), ca = cross(c.normal, a.normal),
             ab = cross(a.normal, b.normal);
  const auto weight = dot(a.normal, bc);
  const bool turned = weight.sign() < 0;
  ExactPoint out;
  Vec3 near;
  out.weight = Weight::fitted(turned ? -weight : weight);
  const double scale = out.weight.estimate();
  for (size_t k = 0; k < 3; ++k) {
    const auto x = a.offset * bc[k] + b.offset * ca[k] + c.offset * ab[k];
    out.x[k] = Numerator::fitted(turned ? -x : x);
    near[int(k)] = std::ldexp(out.x[k].estimate() / scale, exponent_);
  }
  out.planes = {p, q, r};
  points_.push_back(out);
  near_.push_back(near);
  return uint32_t(points_.size()) - 1;
}

int ExactSpace::side(uint32_t plane, uint32_t point) const {
  const ExactPlane& p = planes_[plane];
  const Vec3& near = near_[point];
  const double value = p.near.distance(near);
  const double size = p.near.normal.cwiseAbs().dot(near.cwiseAbs()) + std::fabs(p.near.offset);
  if (std::fabs(value) > value_error * size) return value > 0 ? 1 : -1;
  const ExactPoint& x = points_[point];
  for (const uint32_t through : x.planes)
    if (through == plane) return 0;
  return (dot(p.normal, x.x) - p.offset * x.weight).sign();
}

ExactSpace::Along ExactSpace::along(uint32_t first, uint32_t second) const {
  const auto line = cross(planes_[first].normal, planes_[second].normal);
  Along out;
  double most = 0;
  for (int k = 0; k < 3; ++k) {
    const double x = line[size_t(k)].estimate();
    if (!(std::fabs(x) > most)) continue;
    most = std::fabs(x);
    out = {k, x > 0 ? 1 : -1};
  }
  return out;
}

int ExactSpace::order(const Along& line, uint32_t p, uint32_t q) const {
  if (p == q) return 0;
  const double x = near_[p][line.axis], y = near_[q][line.axis];
  if (std::fabs(x - y) > coordinate_error * (std::fabs(x) + std::fabs(y)))
    return x > y ? line.sign : -line.sign;
  const ExactPoint &a = points_[p], &b = points_[q];
  const auto k = size_t(line.axis);
  return line.sign * (a.x[k] * b.weight - b.x[k] * a.weight).sign();
}

}  // namespace tumble
