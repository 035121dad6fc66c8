#include "viewer/interact/handles.hpp"

#include "engine/math/rotation.hpp"
#include "viewer/render/render_scene.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace tumble {
namespace {

using Part = Handles::Part;
using View = Handles::View;

constexpr double arm_pixels = 84;   ///< length of arms and radius of rings
constexpr double catch_pixels = 8;  ///< within this distance the pointer is on the handle
/// Range of the squares, in lengths of an arm.
constexpr double square_begin = 0.25, square_end = 0.45;
constexpr int ring_pieces = 48;
/// Dragging the centre of the scaling handles by this many pixels doubles the size.
constexpr double doubling_pixels = 120;
/// What is nearer than this to the place of the press is at that place [px].
constexpr double least_pixels = 1e-6;
/// A ray whose angle to a plane, or to an arm, is below this gives no usable point (sine).
constexpr double least_sine = 0.05;
/// Rings seen at a flatter angle than this are rotated by dragging along their tangent (sine).
constexpr double flat_ring = 0.2;

int axis_of(Part part) {
  switch (part) {
    case Part::x:
    case Part::across_x:
      return 0;
    case Part::y:
    case Part::across_y:
      return 1;
    default:
      return 2;
  }
}
bool is_square(Part part) {
  return part == Part::across_x || part == Part::across_y || part == Part::across_z;
}
/// Whether dragging an arm, a square or the centre moves along this axis.
bool goes_along(Part part, int axis) {
  if (part == Part::middle) return true;
  return is_square(part) != (axis == axis_of(part));
}
Vec3 unit(int axis) {
  return Vec3::Unit(axis);
}

Vec3 looking_along(const Camera& camera) {
  return (camera.target - camera.eye).normalized();
}

/// The length that appears `pixels` high at the frame's distance [m].
double length_of_pixels(const View& view, const Vec3& at, double pixels) {
  const double depth = std::max((at - view.camera.eye).dot(looking_along(view.camera)), 1e-3);
  const double half = std::tan(0.5 * view.camera.fov_deg * std::numbers::pi / 180);
  return pixels * 2 * half * depth / view.height;
}

std::optional<Vec3> on_plane(const Ray& ray, const Vec3& point, const Vec3& normal) {
  const double slope = ray.direction.normalized().dot(normal);
  if (std::abs(slope) < least_sine) return std::nullopt;
  return ray.at((point - ray.origin).dot(normal) / ray.direction.dot(normal));
}

/// The point nearest to the ray on the line through `point` along the unit vector `axis`, as a
/// distance from `point` [m].
std::optional<double> along_line(const Ray& ray, const Vec3& point, const Vec3& axis) {
  const Vec3 d = ray.direction.normalized(), across = d.cross(axis);
  if (across.norm() < least_sine) return std::nullopt;
  return (ray.origin - point).cross(d).dot(axis.cross(d)) / across.squaredNorm();
}

/// Distance of a point of the picture from a projected segment [px]; very large if that is behind
/// the eye.
double pixels_from(const View& view, const Vec3& a, const Vec3& b, double x, double y) {
  const Vec3 p = project(view.camera, a, view.width, view.height);
  const Vec3 q = project(view.camera, b, view.width, view.height);
  if (!(p.z() > 0 && q.z() > 0)) return 1e9;
  const Vec2 from = p.head<2>(), way = q.head<2>() - from, at(x, y);
  const double length2 = way.squaredNorm();
  const double t = length2 > 0 ? std::clamp((at - from).dot(way) / length2, 0.0, 1.0) : 0;
  return (from + t * way - at).norm();
}

Vec3 ring_point(const Pose& frame, int axis, double radius, int piece) {
  const double angle = 2 * std::numbers::pi * piece / ring_pieces;
  return frame.point(
      radius * (std::cos(angle) * unit((axis + 1) % 3) + std::sin(angle) * unit((axis + 2) % 3)));
}

std::array<Vec3, 4> square(const Pose& frame, int axis, double arm) {
  const Vec3 u = arm * unit((axis + 1) % 3), v = arm * unit((axis + 2) % 3);
  return {frame.point(square_begin * (u + v)), frame.point(square_end * u + square_begin * v),
          frame.point(square_end * (u + v)), frame.point(square_begin * u + square_end * v)};
}

double snapped(double value, double step) {
  return step > 0 ? step * std::round(value / step) : value;
}

}  // namespace

bool Displacement::is_null() const {
  return shift == Vec3::Zero() && !turns() && scale == 1;
}

bool Displacement::turns() const {
  return turn.vec() != Vec3::Zero();
}

Pose Displacement::moved(const Pose& pose) const {
  // What is not changed keeps all its bits.
  if (!turns() && scale == 1) return {pose.x + shift, pose.q};
  Vec3 from_pivot = pose.x - pivot;
  if (scale_axis)
    from_pivot += (scale - 1) * scale_axis->dot(from_pivot) * *scale_axis;
  else
    from_pivot *= scale;
  return {pivot + turn * from_pivot + shift, turns() ? (turn * pose.q).normalized() : pose.q};
}

Part Handles::hit(HandleKind kind, const Pose& frame, const View& view, double x, double y) {
  if (kind == HandleKind::none) return Part::none;
  const double arm = length_of_pixels(view, frame.x, arm_pixels);
  Part best = Part::none;
  double nearest = catch_pixels;
  const auto offer = [&](Part part, double distance) {
    if (distance < nearest) {
      nearest = distance;
      best = part;
    }
  };
  for (int axis = 0; axis < 3; ++axis) {
    const Part part = std::array{Part::x, Part::y, Part::z}[size_t(axis)];
    if (kind == HandleKind::turn) {
      for (int i = 0; i < ring_pieces; ++i)
        offer(part, pixels_from(view, ring_point(frame, axis, arm, i),
                                ring_point(frame, axis, arm, i + 1), x, y));
      continue;
    }
    // An arm does not start at the centre, which is a handle of its own.
    offer(part, pixels_from(view, frame.point(0.15 * arm * unit(axis)),
                            frame.point(arm * unit(axis)), x, y));
    if (kind != HandleKind::move) continue;
    const Ray ray = pixel_ray(view.camera, x, y, view.width, view.height);
    if (const auto at = on_plane(ray, frame.x, frame.direction(unit(axis)))) {
      const Vec3 local = frame.inverse_point(*at) / arm;
      const double u = local[(axis + 1) % 3], v = local[(axis + 2) % 3];
      if (std::min(u, v) > square_begin && std::max(u, v) < square_end)
        offer(std::array{Part::across_x, Part::across_y, Part::across_z}[size_t(axis)], 0);
    }
  }
  if (kind != HandleKind::turn)
    offer(Part::middle, pixels_from(view, frame.x, frame.x, x, y) - catch_pixels);
  return best;
}

Vec3 Handles::grip(HandleKind kind, const Pose& frame, Part part, const View& view) {
  const double arm = length_of_pixels(view, frame.x, arm_pixels);
  const int axis = axis_of(part);
  if (part == Part::middle || part == Part::none) return frame.x;
  if (kind == HandleKind::turn) return ring_point(frame, axis, arm, ring_pieces / 8);
  if (!is_square(part)) return frame.point(0.8 * arm * unit(axis));
  const auto corners = square(frame, axis, arm);
  return 0.5 * (corners[0] + corners[2]);
}

void Handles::begin(const HandleSettings& settings, const Pose& frame, Part part, const View& view,
                    double x, double y) {
  settings_ = settings;
  frame_ = frame;
  part_ = part;
  arm_ = length_of_pixels(view, frame.x, arm_pixels);
  x_ = x;
  y_ = y;
  const Ray ray = pixel_ray(view.camera, x, y, view.width, view.height);
  const Vec3 axis = frame.direction(unit(axis_of(part)));
  begin_ = frame.x;
  if (part == Part::middle) {
    begin_ = on_plane(ray, frame.x, looking_along(view.camera)).value_or(frame.x);
  } else if (is_square(part)) {
    begin_ = on_plane(ray, frame.x, axis).value_or(frame.x);
  } else if (settings.kind == HandleKind::turn) {
    double nearest = 1e9;
    for (int i = 0; i < ring_pieces; ++i) {
      const Vec3 at = ring_point(frame, axis_of(part), arm_, i);
      const double distance = pixels_from(view, at, at, x, y);
      if (distance >= nearest) continue;
      nearest = distance;
      begin_ = at;
    }
  } else {
    begin_ = frame.x + along_line(ray, frame.x, axis).value_or(0) * axis;
  }
}

std::optional<Displacement> Handles::drag(const View& view, double x, double y, bool snap) const {
  // Where it was pressed, rounding must not displace anything.
  if (std::abs(x - x_) + std::abs(y - y_) < least_pixels) return Displacement{.pivot = frame_.x};
  switch (settings_.kind) {
    case HandleKind::move:
      return move(view, x, y, snap);
    case HandleKind::turn:
      return turn(view, x, y, snap);
    case HandleKind::scale:
      return scale(view, x, y, snap);
    case HandleKind::none:
      break;
  }
  return std::nullopt;
}

std::optional<Displacement> Handles::move(const View& view, double x, double y, bool snap) const {
  const Ray ray = pixel_ray(view.camera, x, y, view.width, view.height);
  const Vec3 axis = frame_.direction(unit(axis_of(part_)));
  Vec3 shift = Vec3::Zero();
  if (part_ == Part::middle || is_square(part_)) {
    const auto at =
        on_plane(ray, begin_, part_ == Part::middle ? looking_along(view.camera) : axis);
    if (!at) return std::nullopt;
    shift = *at - begin_;
  } else {
    const auto at = along_line(ray, begin_, axis);
    if (!at) return std::nullopt;
    shift = *at * axis;
  }
  if (snap) {
    Vec3 local = frame_.q.conjugate() * shift;
    // The world's axes have a grid, on which bodies come to stand; those of a body have steps.
    const Vec3 from = settings_.own_axes ? Vec3::Zero() : frame_.x;
    for (int i = 0; i < 3; ++i)
      if (goes_along(part_, i)) local[i] = snapped(from[i] + local[i], settings_.step) - from[i];
    shift = frame_.q * local;
  }
  return Displacement{.pivot = frame_.x, .shift = shift};
}

/// A ring seen from the side gives no angle: there the drag along its tangent is converted to one,
/// as if rolling.
std::optional<Displacement> Handles::turn(const View& view, double x, double y, bool snap) const {
  const Ray ray = pixel_ray(view.camera, x, y, view.width, view.height);
  const Vec3 axis = frame_.direction(unit(axis_of(part_)));
  const Vec3 from = begin_ - frame_.x, tangent = axis.cross(from).normalized();
  double angle = 0;
  if (std::abs(axis.dot((frame_.x - view.camera.eye).normalized())) > flat_ring) {
    const auto at = on_plane(ray, frame_.x, axis);
    if (!at) return std::nullopt;
    const Vec3 to = *at - frame_.x;
    angle = std::atan2(tangent.dot(to), from.normalized().dot(to));
  } else {
    const auto way = along_line(ray, begin_, tangent);
    if (!way) return std::nullopt;
    angle = *way / from.norm();
  }
  if (snap) angle = snapped(angle, settings_.step_deg * std::numbers::pi / 180);
  return Displacement{.pivot = frame_.x, .turn = axis_angle(axis, angle)};
}

std::optional<Displacement> Handles::scale(const View& view, double x, double y, bool snap) const {
  constexpr double least = 0.01;  // of the initial size
  Displacement out{.pivot = frame_.x};
  if (part_ == Part::middle) {
    out.scale = std::exp2(((x - x_) - (y - y_)) / doubling_pixels);
  } else {
    const Vec3 axis = frame_.direction(unit(axis_of(part_)));
    const double before = (begin_ - frame_.x).dot(axis);
    const auto now =
        along_line(pixel_ray(view.camera, x, y, view.width, view.height), frame_.x, axis);
    if (!now || !(std::abs(before) > 0)) return std::nullopt;
    out.scale = *now / before;
    out.scale_axis = axis;
  }
  if (snap) out.scale = snapped(out.scale, settings_.step_scale);
  out.scale = std::max(out.scale, snap ? settings_.step_scale : least);
  return out;
}

void Handles::draw(HandleKind kind, const Pose& frame, Part lit, const View& view,
                   RenderScene& out) {
  if (kind == HandleKind::none) return;
  const double arm = length_of_pixels(view, frame.x, arm_pixels);
  const Vec4f colours[] = {
      {0.95f, 0.16f, 0.13f, 1}, {0.30f, 0.78f, 0.12f, 1}, {0.16f, 0.40f, 1.0f, 1}};
  const Vec4f bright(1, 0.85f, 0.1f, 1), white(0.92f, 0.92f, 0.95f, 1);
  const auto line = [&](const Vec3& a, const Vec3& b, const Vec4f& colour, float width) {
    out.lines.push_back({a.cast<float>(), b.cast<float>(), colour, width, Occlusion::none});
  };
  const auto point = [&](const Vec3& at, const Vec4f& colour, float size) {
    out.points.push_back({at.cast<float>(), colour, size, Occlusion::none});
  };
  for (int axis = 0; axis < 3; ++axis) {
    const Part part = std::array{Part::x, Part::y, Part::z}[size_t(axis)];
    const Vec4f& colour = part == lit ? bright : colours[axis];
    const float width = part == lit ? 4.5f : 3.0f;
    if (kind == HandleKind::turn) {
      for (int i = 0; i < ring_pieces; ++i)
        line(ring_point(frame, axis, arm, i), ring_point(frame, axis, arm, i + 1), colour, width);
      continue;
    }
    const Vec3 tip = frame.point(arm * unit(axis));
    line(frame.point(0.15 * arm * unit(axis)), tip, colour, width);
    if (kind == HandleKind::scale) {
      point(tip, colour, 13);
      continue;
    }
    // An arrowhead of four strokes, visible from every side.
    for (const double side : {-0.06, 0.06})
      for (const int across : {1, 2})
        line(tip, frame.point(arm * (0.84 * unit(axis) + side * unit((axis + across) % 3))), colour,
             width);
    const auto corners = square(frame, axis, arm);
    const Part across = std::array{Part::across_x, Part::across_y, Part::across_z}[size_t(axis)];
    for (size_t i = 0; i < corners.size(); ++i)
      line(corners[i], corners[(i + 1) % corners.size()], across == lit ? bright : colours[axis],
           across == lit ? 4.0f : 2.0f);
  }
  if (kind != HandleKind::turn) point(frame.x, lit == Part::middle ? bright : white, 12);
}

}  // namespace tumble
