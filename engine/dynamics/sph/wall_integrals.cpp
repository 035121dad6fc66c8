#include "engine/dynamics/sph/wall_integrals.hpp"

#include "engine/collision/shape_near.hpp"
#include "engine/collision/shapes/box.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace tumble {
namespace {

/// Integrals of a kernel of reach 1 over octants x < a, y < b, z < c, and their derivatives by a,
/// in tables over [-1, 1]: a box is eight octants, added and taken away.
class OctantTable {
 public:
  explicit OctantTable(FluidKernelKind kind) : values_(places * places * places), slopes_(values_) {
    const SmoothingKernel kernel(kind, 1);
    fill_values(kernel);
    fill_slopes(kernel);
  }
  static const OctantTable& of(FluidKernelKind kind) {
    static const OctantTable cubic(FluidKernelKind::cubic_spline),
        wendland(FluidKernelKind::wendland);
    return kind == FluidKernelKind::cubic_spline ? cubic : wendland;
  }
  double value(const Vec3& a) const { return between(values_, a); }
  double slope(double a, double b, double c) const { return between(slopes_, {a, b, c}); }

 private:
  static constexpr int intervals = tolerances::kernel_table;
  static constexpr size_t places = size_t(intervals) + 1;
  static constexpr double width = 2.0 / intervals;

  static size_t at(size_t i, size_t j, size_t k) { return (i * places + j) * places + k; }
  /// Two points by Gauss's rule in interval i.
  static double gauss(size_t i, int n) {
    const double offset = 0.5 / std::numbers::sqrt3;
    return -1 + (double(i) + 0.5 + (n == 0 ? -offset : offset)) * width;
  }

  /// Integrals over cells become integrals over octants, axis by axis; the whole is made 1.
  void fill_values(const SmoothingKernel& kernel) {
    for (size_t i = 0; i + 1 < places; ++i)
      for (size_t j = 0; j + 1 < places; ++j)
        for (size_t k = 0; k + 1 < places; ++k) {
          double sum = 0;
          for (int n = 0; n < 8; ++n)
            sum += kernel.value(
                Vec3(gauss(i, n & 1), gauss(j, (n >> 1) & 1), gauss(k, n >> 2)).norm());
          values_[at(i + 1, j + 1, k + 1)] = sum * width * width * width / 8;
        }
    for (size_t i = 0; i < places; ++i)
      for (size_t j = 0; j < places; ++j)
        for (size_t k = 0; k < places; ++k) {
          if (k > 0) values_[at(i, j, k)] += values_[at(i, j, k - 1)];
        }
    for (size_t i = 0; i < places; ++i)
      for (size_t j = 1; j < places; ++j)
        for (size_t k = 0; k < places; ++k) values_[at(i, j, k)] += values_[at(i, j - 1, k)];
    for (size_t i = 1; i < places; ++i)
      for (size_t j = 0; j < places; ++j)
        for (size_t k = 0; k < places; ++k) values_[at(i, j, k)] += values_[at(i - 1, j, k)];
    const double whole = values_.back();
    for (double& v : values_) v /= whole;
  }
  /// Plane by plane; each plane's whole is known in closed form.
  void fill_slopes(const SmoothingKernel& kernel) {
    for (size_t i = 0; i < places; ++i) {
      const double a = -1 + double(i) * width;
      for (size_t j = 0; j + 1 < places; ++j)
        for (size_t k = 0; k + 1 < places; ++k) {
          double sum = 0;
          for (int n = 0; n < 4; ++n)
            sum += kernel.value(Vec3(a, gauss(j, n & 1), gauss(k, n >> 1)).norm());
          slopes_[at(i, j + 1, k + 1)] = sum * width * width / 4;
        }
      for (size_t j = 1; j < places; ++j)
        for (size_t k = 1; k < places; ++k) slopes_[at(i, j, k)] += slopes_[at(i, j, k - 1)];
      for (size_t j = 1; j < places; ++j)
        for (size_t k = 1; k < places; ++k) slopes_[at(i, j, k)] += slopes_[at(i, j - 1, k)];
      const double whole = slopes_[at(i, places - 1, places - 1)];
      const double factor = whole > 0 ? kernel.plane(a) / whole : 0;
      for (size_t j = 0; j < places; ++j)
        for (size_t k = 0; k < places; ++k) slopes_[at(i, j, k)] *= factor;
    }
  }

  static double between(const std::vector<double>& table, const Vec3& a) {
    std::array<size_t, 3> cell;
    Vec3 t;
    for (int k = 0; k < 3; ++k) {
      const double u = std::clamp((a[k] + 1) / width, 0.0, double(intervals));
      cell[size_t(k)] = std::min(size_t(u), places - 2);
      t[k] = u - double(cell[size_t(k)]);
    }
    double sum = 0;
    for (unsigned n = 0; n < 8; ++n) {
      const unsigned i = n & 1, j = (n >> 1) & 1, k = n >> 2;
      sum += (i ? t[0] : 1 - t[0]) * (j ? t[1] : 1 - t[1]) * (k ? t[2] : 1 - t[2]) *
             table[at(cell[0] + i, cell[1] + j, cell[2] + k)];
    }
    return sum;
  }

  std::vector<double> values_, slopes_;
};

/// Integral over [a, b] by Gauss's rule of five points on each side of `split`.
template <class F>
double gauss_legendre(double a, double b, double split, const F& f) {
  constexpr std::array<double, 5> x{-0.9061798459386640, -0.5384693101056831, 0, 0.5384693101056831,
                                    0.9061798459386640};
  constexpr std::array<double, 5> w{0.2369268850561891, 0.4786286704993665, 0.5688888888888889,
                                    0.4786286704993665, 0.2369268850561891};
  const double middle = std::clamp(split, a, b);
  double sum = 0;
  for (const auto& [low, high] : {std::pair{a, middle}, {middle, b}})
    for (size_t k = 0; k < x.size(); ++k)
      sum += 0.5 * (high - low) * w[k] * f(0.5 * (low + high) + 0.5 * (high - low) * x[k]);
  return sum;
}

/// Where layers of mirrored particles begin: a particle deep in a wall has as many as reach it.
double first_mirrored(const SmoothingKernel& kernel, double spacing, double distance) {
  const double first = 2 * distance, reach = kernel.reach();
  if (first > -reach) return first;
  const double beyond = std::fmod(-reach - first, spacing);
  return beyond > 0 ? spacing - reach - beyond : -reach;
}

bool flat(const SmoothingKernel& kernel, double low, double high) {
  return low <= -kernel.reach() && high >= kernel.reach();
}

}  // namespace

OwnShare box_share(const SmoothingKernel& kernel, const Vec3& e, const Vec3& x) {
  const double reach = kernel.reach();
  const Vec3 low = -e - x, high = e - x;
  if ((low.array() >= reach).any() || (high.array() <= -reach).any()) return {};
  // Beside the middle of a face the box is a half-space or a layer.
  for (int k = 0; k < 3; ++k) {
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    if (!flat(kernel, low[i], high[i]) || !flat(kernel, low[j], high[j])) continue;
    OwnShare out;
    out.share = kernel.half_space(-high[k]) - kernel.half_space(-low[k]);
    out.gradient[k] = kernel.plane(low[k]) - kernel.plane(high[k]);
    return out;
  }
  const OctantTable& table = OctantTable::of(kernel.kind());
  OwnShare out;
  for (unsigned n = 0; n < 8; ++n) {
    Vec3 a;
    double sign = 1;
    for (int k = 0; k < 3; ++k) {
      const bool upper = (n >> k) & 1;
      a[k] = std::clamp((upper ? high[k] : low[k]) / reach, -1.0, 1.0);
      if (!upper) sign = -sign;
    }
    if ((a.array() <= -1).any()) continue;
    out.share += sign * table.value(a);
    for (int k = 0; k < 3; ++k)
      out.gradient[k] -= sign * table.slope(a[k], a[(k + 1) % 3], a[(k + 2) % 3]) / reach;
  }
  return out;
}

OwnShare ball_share(const SmoothingKernel& kernel, double radius, const Vec3& x) {
  const double reach = kernel.reach(), d = x.norm();
  if (d >= radius + reach) return {};
  const double split = 0.5 * reach, around = 4 * std::numbers::pi;
  const double nearest = std::abs(radius - d);
  OwnShare out;
  // Spheres about the particle that are whole in the ball, then those that it cuts.
  if (d < radius)
    out.share = gauss_legendre(0, std::min(nearest, reach), split,
                               [&](double s) { return around * s * s * kernel.value(s); });
  const double last = std::min(radius + d, reach);
  if (last <= nearest || d == 0) return out;
  out.share += gauss_legendre(nearest, last, split, [&](double s) {
    const double cosine = (d * d + s * s - radius * radius) / (2 * d * s);
    return 0.5 * around * s * s * kernel.value(s) * (1 - std::clamp(cosine, -1.0, 1.0));
  });
  const double slope = gauss_legendre(nearest, last, split, [&](double s) {
    return -0.5 * around * s * s * kernel.value(s) * (d * d - s * s + radius * radius) /
           (2 * d * d * s);
  });
  out.gradient = slope / d * x;
  return out;
}

double mirrored_half_space(const SmoothingKernel& kernel, double spacing, double distance) {
  double sum = 0;
  for (double r = first_mirrored(kernel, spacing, distance); r < kernel.reach(); r += spacing)
    sum += spacing * kernel.plane(r);
  return sum;
}

double mirrored_plane(const SmoothingKernel& kernel, double spacing, double distance) {
  double sum = 0;
  for (double r = first_mirrored(kernel, spacing, distance); r < kernel.reach(); r += spacing)
    sum += 4 * std::numbers::pi * spacing * r * kernel.value(std::abs(r));
  return sum;
}

std::optional<WallShare> wall_share(const SmoothingKernel& kernel, double spacing,
                                    const Shape& shape, const Pose& pose, const Vec3& x) {
  const auto near = near_to_touch(shape, pose, x, 0.5 * kernel.reach());
  if (!near) return std::nullopt;
  WallShare out;
  out.distance = near->distance;
  out.normal = near->normal;
  const double d = near->distance;
  const double share = mirrored_half_space(kernel, spacing, d);
  const Vec3 gradient = -mirrored_plane(kernel, spacing, d) * near->normal;
  OwnShare own;
  if (const auto* box = dynamic_cast<const BoxShape*>(&shape))
    own = box_share(kernel, box->half_extents(), pose.inverse_point(x));
  else if (shape.is_ball())
    own = ball_share(kernel, shape.bounding_radius(), pose.inverse_point(x));
  else
    own = {.share = 1, .gradient = Vec3::Zero()};
  const bool flat = own.share == 1;
  // How much of the half-space behind the nearest point the solid is, and how that changes.
  const double half = flat ? 1 : kernel.half_space(d), part = own.share / half;
  const Vec3 change =
      flat ? Vec3(Vec3::Zero())
           : Vec3((pose.direction(own.gradient) + part * kernel.plane(d) * near->normal) / half);
  out.share = part * share;
  out.gradient = part * gradient + share * change;
  return out;
}

}  // namespace tumble
