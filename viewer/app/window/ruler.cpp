#include "viewer/app/window/ruler.hpp"

#include "viewer/ui/widgets.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

namespace tumble {
namespace {

const Vec4f ruler_ink(0.01f, 0.01f, 0.012f, 0.85f), ruler_colour(1, 0.80f, 0.08f, 1);
constexpr int arc_pieces = 24;
constexpr double arc_share = 0.4;  ///< radius of the arc over the shorter arm

/// A line with a dark border, visible on any background.
void add_stroke(const Vec3& a, const Vec3& b, RenderScene& picture) {
  LineSegment line;
  line.a = a.cast<float>();
  line.b = b.cast<float>();
  line.occlusion = Occlusion::none;
  for (const auto& [width, colour] : {std::pair(4.5f, ruler_ink), std::pair(2.2f, ruler_colour)}) {
    line.width = width;
    line.colour = colour;
    picture.lines.push_back(line);
  }
}

void add_spot(const Vec3& x, RenderScene& picture) {
  PointMark mark;
  mark.x = x.cast<float>();
  mark.occlusion = Occlusion::none;
  for (const auto& [size, colour] : {std::pair(12.0f, ruler_ink), std::pair(8.0f, ruler_colour)}) {
    mark.size = size;
    mark.colour = colour;
    picture.points.push_back(mark);
  }
}

void add_words(const Vec3& x, std::string text, RenderScene& picture) {
  TextLabel label;
  label.text = std::move(text);
  label.x = x.cast<float>();
  label.colour = ruler_colour;
  label.size = 16;
  label.anchor = Vec3f(0.5f, 1.25f, 0);
  label.plate = 0.7f;  // the line it belongs to may pass behind it
  picture.texts.push_back(std::move(label));
}

/// Draws the arc from one arm to the other about the vertex; returns where its label goes.
Vec3 add_arc(const Vec3& corner, const Vec3& u, const Vec3& v, RenderScene& picture) {
  const double angle = angle_between(u, v);
  const double radius = arc_share * std::min(u.norm(), v.norm());
  if (!(radius > 0)) return corner;
  const Vec3 along = u.normalized();
  Vec3 across = v - v.dot(along) * along;
  // Parallel arms span no plane: any plane through them will do.
  if (!(across.norm() > 1e-9 * v.norm())) across = along.unitOrthogonal();
  across.normalize();
  const auto at = [&](double part) -> Vec3 {
    const double a = part * angle;
    return corner + radius * (std::cos(a) * along + std::sin(a) * across);
  };
  for (int i = 0; i < arc_pieces; ++i)
    add_stroke(at(double(i) / arc_pieces), at(double(i + 1) / arc_pieces), picture);
  return at(0.5);
}

std::string degrees_text(double angle) {
  return fmt::format("{:.2f}°", angle * 180 / std::numbers::pi);
}

void draw_ruler(const std::vector<Vec3>& x, RenderScene& picture) {
  for (size_t i = 0; i + 1 < x.size(); ++i) add_stroke(x[i], x[i + 1], picture);
  for (const Vec3& point : x) add_spot(point, picture);
  if (x.size() == 2)
    add_words(0.5 * (x[0] + x[1]), quantity_text((x[1] - x[0]).norm(), "m"), picture);
  if (x.size() == 3) {
    const Vec3 u = x[0] - x[1], v = x[2] - x[1];
    add_words(add_arc(x[1], u, v, picture), degrees_text(angle_between(u, v)), picture);
  }
}

}  // namespace

double angle_between(const Vec3& u, const Vec3& v) {
  return std::atan2(u.cross(v).norm(), u.dot(v));
}

std::optional<std::vector<Vec3>> Ruler::places(const Points& points, const Frame& frame) {
  std::vector<Vec3> out;
  for (const Point& p : points) {
    const auto slot = find_slot(frame, p.body);
    if (!slot) return std::nullopt;
    out.push_back(frame.body(*slot).pose.point(p.x_body));
  }
  return out;
}

std::optional<double> Ruler::read(const Points& points, const Frame& frame) {
  const auto x = places(points, frame);
  if (!x) return std::nullopt;
  if (x->size() == 2) return ((*x)[1] - (*x)[0]).norm();
  return angle_between((*x)[0] - (*x)[1], (*x)[2] - (*x)[1]);
}

RulerReading Ruler::reading(const Points& points) {
  RulerReading out;
  out.angle = points.size() == 3;
  std::string names;
  for (const Point& p : points) names += (names.empty() ? "" : " - ") + p.name;
  out.quantity.name = fmt::format("{} {}: {}", out.angle ? "angle" : "ruler", ++made_, names);
  out.quantity.unit = out.angle ? "rad" : "m";
  out.quantity.read = [points](const Frame& frame) { return read(points, frame); };
  return out;
}

bool Ruler::click(const SessionView& shown, const Pick& hit, bool angle) {
  if (full()) return false;
  const auto slot = find_slot(*shown.to, hit.body);
  if (!slot) return false;
  const std::string& name = shown.to->info(*slot).name;
  const Pose pose = interpolated_pose(*shown.from, *shown.to, *slot, shown.s);
  const size_t need = angle ? 3 : 2;
  // Left over from an angle that was given up for a distance.
  if (picked_.size() >= need) picked_.clear();
  picked_.push_back({hit.body, pose.inverse_point(hit.x_world),
                     name.empty() ? fmt::format("body {}", hit.body.index) : name});
  const bool complete = picked_.size() == need;
  if (complete) {
    view_.readings.push_back(reading(picked_));
    all_.push_back(std::move(picked_));
    picked_.clear();
  }
  update(*shown.to);
  return complete;
}

void Ruler::cancel() {
  picked_.clear();
  view_.picked = 0;
}

void Ruler::remove(size_t index) {
  if (index >= all_.size()) return;
  all_.erase(all_.begin() + std::ptrdiff_t(index));
  view_.readings.erase(view_.readings.begin() + std::ptrdiff_t(index));
}

void Ruler::update(const Frame& frame) {
  if (!places(picked_, frame)) picked_.clear();
  view_.picked = picked_.size();
  for (size_t i = 0; i < all_.size(); ++i) {
    const auto x = places(all_[i], frame);
    RulerReading& r = view_.readings[i];
    r.there = x.has_value();
    if (!x) continue;
    r.value = read(all_[i], frame).value_or(0);
    if (!r.angle) r.apart = (*x)[1] - (*x)[0];
  }
}

void Ruler::draw(const SessionView& shown, RenderScene& picture) const {
  const auto seen_at = [&](const Points& points) {
    std::vector<Vec3> x;
    for (const Point& p : points)
      if (const auto slot = find_slot(*shown.to, p.body))
        x.push_back(interpolated_pose(*shown.from, *shown.to, *slot, shown.s).point(p.x_body));
    return x;
  };
  for (const Points& points : all_)
    if (const auto x = seen_at(points); x.size() == points.size()) draw_ruler(x, picture);
  // Two points of a protractor give no reading; only three do.
  const std::vector<Vec3> x = seen_at(picked_);
  for (size_t i = 0; i + 1 < x.size(); ++i) add_stroke(x[i], x[i + 1], picture);
  for (const Vec3& point : x) add_spot(point, picture);
}

}  // namespace tumble
