#include "engine/collision/shapes/convex_shape.hpp"
#include "engine/collision/shapes/outlines.hpp"
#include "engine/collision/shapes/parameters.hpp"
#include "engine/collision/shapes/round_side.hpp"
#include "engine/collision/shapes/validation.hpp"
#include "engine/geometry/constructions/ray_casts.hpp"
#include "engine/math/det/det.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <fmt/format.h>

namespace tumble {
namespace {

/// The convex hull of two balls on y, one of `radius` at -height / 2 and one of `top_radius` at
/// +height / 2: the volume swept by a ball whose radius changes linearly. The core is the same
/// solid with both radii reduced by the smaller one, which is the rounding.
class TaperedCapsuleShape final : public ConvexShape {
 public:
  static Result<std::shared_ptr<const Shape>> make(const ShapeDef& def);

  double bounding_radius() const override { return half_ + std::max(r_[0], r_[1]); }
  double inner_radius() const override { return rounding(); }
  Result<MassProperties> mass_properties() const override;
  std::optional<RayHit> ray_cast(const Vec3& origin, const Vec3& direction,
                                 double t_max) const override;
  Vec3 support(const Vec3& d) const override;
  /// The furthest points of both balls.
  void supporting_face(const Vec3& direction, SupportingFace& face) const override;
  std::optional<SurfacePoint> nearest(const Vec3& p) const override;
  SurfaceElement element_at(const Vec3& p, const Vec3& n) const override;
  SurfaceElement border_at(const Vec3& p, const Vec3& n) const override;
  bool has_point(const SurfaceElement& element) const override {
    return std::fabs(element.origin.y()) >= half_ * (1 - element_close_by);
  }
  double rounding_along(const Vec3& n) const override;
  PolyhedronFeature feature_at(const Vec3& p, uint32_t) const override;
  std::string words() const override {
    return fmt::format("tapered capsule, {:.4g} and {:.4g} × {:.4g} m", r_[0], r_[1], 2 * half_);
  }
  void outline(DebugDraw& out, const Vec4f& colour) const override;
  DrawnSurface drawn_surface() const override;

 private:
  explicit TaperedCapsuleShape(const ShapeDef& def)
      : ConvexShape(def, {}, ShapeSymmetry::axis),
        r_{def.radius, def.top_radius},
        half_(0.5 * def.height),
        taper_((def.top_radius - def.radius) / def.height),
        out_(std::sqrt((1 - taper_) * (1 + taper_))) {
    rounding_ = std::min(r_[0], r_[1]);
    view_ = CoreView::of_reach(half_ + std::max(r_[0], r_[1]) - rounding_);
  }
  double end(int i) const { return i == 0 ? -half_ : half_; }
  /// Radius of the swept ball with its centre at y.
  double radius_at(double y) const { return 0.5 * (r_[0] + r_[1]) + taper_ * y; }
  /// The y of the centre of the swept ball whose surface has point p with normal n.
  double centre_at(const Vec3& p, const Vec3& n) const {
    return (p.y() - radius_at(0) * n.y()) / (1 + taper_ * n.y());
  }
  /// The y at which a ball meets the side, whose normal has the component -taper along y.
  double seam_y(int i) const { return end(i) - r_[size_t(i)] * taper_; }
  double seam_radius(int i) const { return r_[size_t(i)] * out_; }

  std::array<double, 2> r_;  ///< below, above
  double half_;
  double taper_;  ///< change of the radius per length along y
  double out_;    ///< component of the side's normal perpendicular to the axis
};

Result<std::shared_ptr<const Shape>> TaperedCapsuleShape::make(const ShapeDef& def) {
  if (auto s = require_positive("radius", def.radius); !s) return s.error();
  if (auto s = require_positive("top_radius", def.top_radius); !s) return s.error();
  if (auto s = require_positive("height", def.height); !s) return s.error();
  const double difference = std::fabs(def.top_radius - def.radius);
  if (!(def.height > difference * (1 + 1e-6)))
    return Error{ErrorCode::invalid_argument,
                 fmt::format("height must be greater than the difference of the radii, {:.6g} m, "
                             "got {:.6g} m: one ball would hold the other",
                             difference, def.height),
                 {},
                 "make it higher, its radii more alike, or take a sphere"};
  return std::shared_ptr<const Shape>(new TaperedCapsuleShape(def));
}

/// A solid of revolution of three pieces in each of which the squared radius is a quadratic
/// polynomial q(y): the integrals of q, y q, y^2 q and q^2 are exact by three-point Gauss
/// quadrature.
Result<MassProperties> TaperedCapsuleShape::mass_properties() const {
  struct Piece {
    double from, to;
    int ball;  ///< which, or none
  };
  const double a = seam_y(0), b = seam_y(1);
  const std::array<Piece, 3> pieces{{{-half_ - r_[0], a, 0}, {a, b, -1}, {b, half_ + r_[1], 1}}};
  const auto square = [&](const Piece& piece, double y) {
    if (piece.ball < 0) {
      const double radius = seam_radius(0) + (seam_radius(1) - seam_radius(0)) * (y - a) / (b - a);
      return radius * radius;
    }
    const double r = r_[size_t(piece.ball)], off = y - end(piece.ball);
    return (r - off) * (r + off);
  };
  constexpr double node = 0.77459666924148337704;  // sqrt(3 / 5)
  constexpr std::array<std::array<double, 2>, 3> rule{
      {{-node, 5.0 / 9}, {0, 8.0 / 9}, {node, 5.0 / 9}}};
  const auto integral = [&](const auto& f) {
    double sum = 0;
    for (const Piece& p : pieces)
      for (const auto& [x, weight] : rule) {
        const double y = 0.5 * (p.from + p.to) + 0.5 * (p.to - p.from) * x;
        sum += 0.5 * (p.to - p.from) * weight * f(y, square(p, y));
      }
    return det::pi * sum;
  };
  MassProperties m;
  m.mass = integral([](double, double q) { return q; });
  const double y = integral([](double at, double q) { return at * q; }) / m.mass;
  m.centre = {0, y, 0};
  const double along = integral([](double, double q) { return 0.5 * q * q; });
  const double across =
      0.5 * along + integral([y](double at, double q) { return (at - y) * (at - y) * q; });
  m.inertia = Vec3(across, along, across).asDiagonal();
  return m;
}

std::optional<RayHit> TaperedCapsuleShape::ray_cast(const Vec3& origin, const Vec3& direction,
                                                    double t_max) const {
  const Ray ray{origin, direction};
  if (nearest(origin)->distance < 0) return hit_from_inside(ray);
  auto best = ray_cone_side({seam_y(0), seam_radius(0), seam_y(1), seam_radius(1)}, ray, t_max);
  for (const int i : {0, 1}) {
    const auto hit = ray_sphere(ray, Vec3(0, end(i), 0), r_[size_t(i)], t_max);
    if (hit && (!best || hit->t < best->t)) best = hit;
  }
  return best;
}

Vec3 TaperedCapsuleShape::support(const Vec3& d) const {
  const double length = d.norm();
  const bool top = 2 * half_ * d.y() + (r_[1] - r_[0]) * length > 0;
  const double radius = r_[top] - rounding();
  const Vec3 centre(0, end(top), 0);
  return length > 0 ? Vec3(centre + radius / length * d) : centre;
}

void TaperedCapsuleShape::supporting_face(const Vec3& direction, SupportingFace& face) const {
  face.count = 0;
  for (const int i : {0, 1})
    face.add(Vec3(0, end(i), 0) + (r_[size_t(i)] - rounding()) * direction, uint32_t(i));
}

/// The nearest ball of the sweep has its centre where the direction to the point is normal to the
/// side, clamped to the ends. The same holds inside: there the greatest ball about the point
/// touches the surface where this ball does.
std::optional<SurfacePoint> TaperedCapsuleShape::nearest(const Vec3& p) const {
  const double x = std::sqrt(p.x() * p.x() + p.z() * p.z());
  const double y = std::clamp(p.y() + taper_ * x / out_, -half_, half_);
  const Vec3 centre(0, y, 0), way = p - centre;
  const double length = way.norm();
  SurfacePoint s;
  s.normal = length > 0 ? Vec3(way / length) : Vec3(out_, -taper_, 0);
  s.distance = length - radius_at(y);
  s.x = centre + radius_at(y) * s.normal;
  return s;
}

SurfaceElement TaperedCapsuleShape::element_at(const Vec3& p, const Vec3& n) const {
  const double y = centre_at(p, n);
  if (std::fabs(y) >= half_ - element_close_by * bounding_radius()) {
    const int i = y > 0;
    return {ElementKind::point, {0, end(i), 0}, Vec3::UnitY(), r_[size_t(i)]};
  }
  SurfaceElement side{ElementKind::cone, Vec3::Zero(), Vec3::UnitY(), radius_at(0)};
  side.taper = taper_;
  return side;
}

SurfaceElement TaperedCapsuleShape::border_at(const Vec3& p, const Vec3& n) const {
  const double r = radius_at(std::clamp(centre_at(p, n), -half_, half_));
  return {ElementKind::point, p - r * n, Vec3::UnitY(), r};
}

double TaperedCapsuleShape::rounding_along(const Vec3& n) const {
  const double beyond = n.y() + taper_;  // past the normal of the side
  if (std::fabs(beyond) < 0.05) return radius_at(0);
  return r_[beyond > 0];
}

/// Vertex 0 below and 1 above, or edge 0 between them.
PolyhedronFeature TaperedCapsuleShape::feature_at(const Vec3& p, uint32_t) const {
  constexpr double on_feature = 1e-9;
  const double within = on_feature * bounding_radius();
  if (p.y() > seam_y(0) + within && p.y() < seam_y(1) - within) return {FeatureKind::edge, 0};
  return {FeatureKind::vertex, 2 * p.y() > seam_y(0) + seam_y(1) ? 1u : 0u};
}

void TaperedCapsuleShape::outline(DebugDraw& out, const Vec4f& colour) const {
  const Vec3 x = Vec3::UnitX(), z = Vec3::UnitZ();
  for (const int i : {0, 1})
    draw_ring(out, colour, {0, seam_y(i), 0}, seam_radius(i) * x, seam_radius(i) * z);
  const double lean = det::asin(taper_);
  for (const Vec3& side : {x, z, Vec3(-x), Vec3(-z)}) {
    out.line(Vec3(0, seam_y(0), 0) + seam_radius(0) * side,
             Vec3(0, seam_y(1), 0) + seam_radius(1) * side, colour);
    // From the seams to the poles.
    for (const int i : {0, 1}) {
      const double r = r_[size_t(i)], sign = i ? 1 : -1;
      const Vec3 pole(0, sign, 0), normal = out_ * side - taper_ * Vec3::UnitY();
      const Vec3 across = (pole - pole.dot(normal) * normal).normalized();
      draw_arc(out, colour, {0, end(i), 0}, r * normal, r * across, 0.5 * det::pi + sign * lean);
    }
  }
}

DrawnSurface TaperedCapsuleShape::drawn_surface() const {
  constexpr int steps = 10;
  const double seam = -det::asin(taper_);  // how far the side's normal leans up
  std::vector<ProfilePoint> profile;
  for (const int i : {0, 1})
    for (int k = 0; k <= steps; ++k) {
      const double share = double(k) / steps, right = 0.5 * det::pi;
      const double lean = i == 0 ? -right + share * (right + seam) : seam + share * (right - seam);
      const double s = det::sin(lean), c = k == (i ? steps : 0) ? 0 : det::cos(lean);
      profile.push_back({end(i) + r_[size_t(i)] * s, r_[size_t(i)] * c, s, c});
    }
  return turned_surface(profile, 40);
}

constexpr std::array tapered_capsule_parameters{
    ShapeParameter{length_parameter("radius", "of the lower end"), &ShapeDef::radius},
    ShapeParameter{length_parameter("top_radius", "of the upper end"), &ShapeDef::top_radius},
    ShapeParameter{length_parameter("height",
                                    "between the centres of the two ends, along y; more "
                                    "than the difference of the radii"),
                   &ShapeDef::height}};

}  // namespace

extern const ShapeEntry tapered_capsule_entry;
constinit const ShapeEntry tapered_capsule_entry{
    "tapered_capsule",         ShapeType::tapered_capsule, ShapeFamily::convex, false,
    TaperedCapsuleShape::make, tapered_capsule_parameters};

}  // namespace tumble
