#include "engine/collision/shapes/convex_shape.hpp"
#include "engine/collision/shapes/outlines.hpp"
#include "engine/collision/shapes/parameters.hpp"
#include "engine/collision/shapes/round_side.hpp"
#include "engine/collision/shapes/validation.hpp"

#include <array>
#include <cmath>

#include <fmt/format.h>

namespace tumble {
namespace {

constexpr uint32_t cone_rim_points = 8;  ///< of the base, for contacts
constexpr double cone_half_root = 0.70710678118654752440;
/// Directions of the rim points, counter-clockwise seen from below (x, z).
constexpr std::array<std::array<double, 2>, cone_rim_points> cone_rim{
    {{1, 0},
     {cone_half_root, cone_half_root},
     {0, 1},
     {-cone_half_root, cone_half_root},
     {-1, 0},
     {-cone_half_root, -cone_half_root},
     {0, -1},
     {cone_half_root, -cone_half_root}}};
/// Ids of the rim point that follows the tilt and of the tip; the fixed ones are 0 .. 7.
constexpr uint32_t cone_tilt_id = 8, cone_line_id = 9, cone_tip_id = 10;

/// Solid cone along y, its base at -height / 2 and its tip at +height / 2. Its centre of mass lies
/// a quarter of the height above the base. Distances are exact; contacts on the base take points
/// of its rim, on the side the ends of a line.
class ConeShape final : public ConvexShape {
 public:
  static Result<std::shared_ptr<const Shape>> make(const ShapeDef& def) {
    if (auto s = require_positive("radius", def.radius); !s) return s.error();
    if (auto s = require_positive("height", def.height); !s) return s.error();
    return std::shared_ptr<const Shape>(new ConeShape(def));
  }

  double bounding_radius() const override { return std::sqrt(r_ * r_ + half_ * half_); }
  /// Of the ball that touches base and side.
  double inner_radius() const override { return 2 * r_ * half_ / (r_ + slant_); }
  Result<MassProperties> mass_properties() const override { return cone_mass(half_, r_); }
  std::optional<RayHit> ray_cast(const Vec3& origin, const Vec3& direction,
                                 double t_max) const override;
  Vec3 support(const Vec3& d) const override;
  /// The base as a polygon of fixed rim points, plus the furthest rim point when it is tilted; or
  /// a line of the side.
  void supporting_face(const Vec3& direction, SupportingFace& face) const override;
  std::optional<SurfacePoint> nearest(const Vec3& p) const override;
  SurfaceElement element_at(const Vec3& p, const Vec3& n) const override;
  bool has_point(const SurfaceElement& element) const override {
    return (element.origin - tip()).norm() <= near();
  }
  double rounding_along(const Vec3& n) const override;
  PolyhedronFeature feature_at(const Vec3& p, uint32_t) const override;
  std::string words() const override {
    return fmt::format("cone, {:.4g} × {:.4g} m", r_, 2 * half_);
  }
  void outline(DebugDraw& out, const Vec4f& colour) const override;
  DrawnSurface drawn_surface() const override;

 private:
  explicit ConeShape(const ShapeDef& def)
      : ConvexShape(def, {}, ShapeSymmetry::axis), r_(def.radius), half_(0.5 * def.height) {
    slant_ = std::sqrt(r_ * r_ + def.height * def.height);
    view_ = CoreView::of_reach(ConeShape::bounding_radius());
  }
  Vec3 tip() const { return {0, half_, 0}; }
  double near() const { return element_close_by * bounding_radius(); }
  /// Components of the side's normal: up, and out.
  double side_up() const { return r_ / slant_; }
  double side_out() const { return 2 * half_ / slant_; }

  double r_, half_, slant_;
};

std::optional<RayHit> ConeShape::ray_cast(const Vec3& origin, const Vec3& direction,
                                          double t_max) const {
  const Ray ray{origin, direction};
  if (nearest(origin)->distance < 0) return hit_from_inside(ray);
  auto hit = ray_cone_side({-half_, r_, half_, 0}, ray, t_max);
  if (!(direction.y() > 0)) return hit;
  const double t = (-half_ - origin.y()) / direction.y();
  if (!(t >= 0 && t <= t_max) || (hit && hit->t <= t)) return hit;
  const double x = origin.x() + t * direction.x(), z = origin.z() + t * direction.z();
  if (x * x + z * z <= r_ * r_) return RayHit{t, -Vec3::UnitY()};
  return hit;
}

Vec3 ConeShape::support(const Vec3& d) const {
  const double lateral = std::sqrt(d.x() * d.x() + d.z() * d.z());
  if (d.y() * 2 * half_ >= r_ * lateral) {
    if (d.y() > 0) return tip();
    if (lateral == 0) return {0, -half_, 0};
  }
  if (lateral == 0) return {0, -half_, 0};
  const double f = r_ / lateral;
  return {f * d.x(), -half_, f * d.z()};
}

void ConeShape::supporting_face(const Vec3& direction, SupportingFace& face) const {
  const double lateral = std::sqrt(direction.x() * direction.x() + direction.z() * direction.z());
  const double ex = lateral > 0 ? direction.x() / lateral : 0;
  const double ez = lateral > 0 ? direction.z() / lateral : 0;
  face.count = 0;
  const double along_side = side_out() * lateral + side_up() * direction.y();
  if (along_side > -direction.y()) {
    if (lateral > 0) face.add({r_ * ex, -half_, r_ * ez}, cone_line_id);
    face.add(tip(), cone_tip_id);
    return;
  }
  // The rim point that a tilt puts furthest out keeps one id all the way round, as with cylinders.
  const bool tilted = lateral > 1e-4;
  for (uint32_t k = 0; k < cone_rim_points; ++k) {
    const auto &here = cone_rim[k], &next = cone_rim[(k + 1) % cone_rim_points];
    face.add({r_ * here[0], -half_, r_ * here[1]}, k);
    if (!tilted) continue;
    const double from = here[0] * ez - here[1] * ex, to = ex * next[1] - ez * next[0];
    if (here[0] * ex + here[1] * ez > 0 && from > 1e-6 && to > 1e-6)
      face.add({r_ * ex, -half_, r_ * ez}, cone_tilt_id);
  }
}

/// In the half plane of the axis and the point: of the base, the side, the rim or the tip.
std::optional<SurfacePoint> ConeShape::nearest(const Vec3& p) const {
  const double x = std::sqrt(p.x() * p.x() + p.z() * p.z());
  const Vec3 out = x > 0 ? Vec3(p.x() / x, 0, p.z() / x) : Vec3(Vec3::UnitX());
  const Vec3 up = Vec3::UnitY();
  const double below = -half_ - p.y();
  const double beside = side_out() * (x - r_) + side_up() * (p.y() + half_);
  const double climb = -side_up() * (x - r_) + side_out() * (p.y() + half_);  // from the rim
  const Vec3 side_normal = side_out() * out + side_up() * up;
  const auto on_side = [&] { return SurfacePoint{p - beside * side_normal, side_normal, beside}; };
  const auto on_base = [&] { return SurfacePoint{x * out - half_ * up, -up, below}; };
  const auto at = [&](const Vec3& corner) {
    const Vec3 way = p - corner;
    const double distance = way.norm();
    return SurfacePoint{corner, distance > 0 ? Vec3(way / distance) : side_normal, distance};
  };
  if (below <= 0 && beside <= 0) return beside > below ? on_side() : on_base();
  if (below > 0 && x <= r_) return on_base();
  if (beside > 0 && climb >= 0 && climb <= slant_) return on_side();
  return climb > slant_ ? at(tip()) : at(r_ * out - half_ * up);
}

SurfaceElement ConeShape::element_at(const Vec3& p, const Vec3& n) const {
  const Vec3 down = -Vec3::UnitY(), base(0, -half_, 0);
  const SurfaceElement face{ElementKind::plane, base, down, 0};
  if (element_along(n, down)) return face;
  if ((p - tip()).norm() <= near()) return material_point(tip());
  if (p.y() > -half_ + near()) {
    SurfaceElement side{ElementKind::cone, tip(), Vec3::UnitY(), 0};
    side.taper = -side_up();
    return side;
  }
  if (p.x() * p.x() + p.z() * p.z() < r_ * r_ * (1 - element_close_by)) return face;
  // Only the point of the rim that is furthest out travels along it; of a rim that lies nearly flat
  // it is anywhere, but not lower.
  const Vec3 furthest = r_ * Vec3(n.x(), 0, n.z()).normalized() + base;
  const double size = bounding_radius();
  if ((furthest - p).norm() > near() && n.dot(furthest - p) > 1e-12 * size)
    return material_point(p);
  return {ElementKind::circle, base, Vec3::UnitY(), r_};
}

/// On its side half of what it is at the rim: the line that touches begins at the tip.
double ConeShape::rounding_along(const Vec3& n) const {
  const double lateral = std::sqrt(n.x() * n.x() + n.z() * n.z());
  const double sine =
      side_up() * lateral - side_out() * n.y();  // of the angle to the side's normal
  return lateral > 0 && std::fabs(sine) < 0.05 ? 0.5 * r_ / side_out() : 0;
}

/// Vertex 0, the tip; edge 0, the rim; face 0, the base, and 1 around.
PolyhedronFeature ConeShape::feature_at(const Vec3& p, uint32_t) const {
  constexpr double on_feature = 1e-9;
  const double within = on_feature * (r_ + 2 * half_);
  if ((p - tip()).norm() <= within) return {FeatureKind::vertex, 0};
  if (p.y() > -half_ + within) return {FeatureKind::face, 1};
  if (std::hypot(p.x(), p.z()) >= r_ - within) return {FeatureKind::edge, 0};
  return {FeatureKind::face, 0};
}

void ConeShape::outline(DebugDraw& out, const Vec4f& colour) const {
  const Vec3 x(r_, 0, 0), z(0, 0, r_), base(0, -half_, 0);
  draw_ring(out, colour, base, x, z);
  for (const Vec3& side : {x, z, Vec3(-x), Vec3(-z)}) out.line(base + side, tip(), colour);
}

DrawnSurface ConeShape::drawn_surface() const {
  // Rings towards the tip, where light changes fast around.
  const std::array<ProfilePoint, 5> profile{{{-half_, 0, -1, 0},
                                             {-half_, r_, -1, 0},
                                             {-half_, r_, side_up(), side_out()},
                                             {0.5 * half_, 0.25 * r_, side_up(), side_out()},
                                             {half_, 0, side_up(), side_out()}}};
  return turned_surface(profile, 48);
}

constexpr std::array cone_parameters{
    ShapeParameter{length_parameter("radius", "of the base"), &ShapeDef::radius},
    ShapeParameter{length_parameter("height", "from the base to the tip, along y"),
                   &ShapeDef::height}};

}  // namespace

extern const ShapeEntry cone_entry;
constinit const ShapeEntry cone_entry{"cone", ShapeType::cone, ShapeFamily::convex,
                                      false,  ConeShape::make, cone_parameters};

}  // namespace tumble
