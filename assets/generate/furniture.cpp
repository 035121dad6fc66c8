// Things of a household that are hollow or have limbs: what a hull does not do justice to.
#include "assets/generate/constructions.hpp"
#include "assets/generate/makers.hpp"
#include "engine/math/det/det.hpp"

#include <algorithm>
#include <cmath>

namespace tumble::assets {
namespace {

/// The surface of all cells of an uneven grid that `filled` says yes to. No two of them may meet in
/// an edge or a corner alone.
template <class Filled>
void cells_of_grid(Builder& builder, const std::array<std::vector<double>, 3>& lines,
                   const Filled& filled) {
  const auto inside = [&](const std::array<int, 3>& c) {
    for (size_t k = 0; k < 3; ++k)
      if (c[k] < 0 || c[k] + 1 >= int(lines[k].size())) return false;
    return filled(c[0], c[1], c[2]);
  };
  const auto at = [&](const std::array<int, 3>& c) {
    return Vec3(lines[0][size_t(c[0])], lines[1][size_t(c[1])], lines[2][size_t(c[2])]);
  };
  std::array<int, 3> c;
  for (c[0] = 0; c[0] + 1 < int(lines[0].size()); ++c[0])
    for (c[1] = 0; c[1] + 1 < int(lines[1].size()); ++c[1])
      for (c[2] = 0; c[2] + 1 < int(lines[2].size()); ++c[2]) {
        if (!inside(c)) continue;
        for (size_t k = 0; k < 3; ++k)
          for (const int side : {0, 1}) {
            std::array<int, 3> next = c, corner = c;
            next[k] += side ? 1 : -1;
            if (inside(next)) continue;
            corner[k] += side;
            std::array<std::array<int, 3>, 4> face{corner, corner, corner, corner};
            const size_t a = (k + 1) % 3, b = (k + 2) % 3;
            ++face[1][a], ++face[2][a], ++face[2][b], ++face[3][b];
            if (!side) std::swap(face[1], face[3]);
            builder.quad(at(face[0]), at(face[1]), at(face[2]), at(face[3]));
          }
      }
}

/// A surface of revolution as a grid of its profile's points (rows) and of angles (columns), with
/// openings that tubes begin at.
class OpenRevolution {
 public:
  OpenRevolution(Loop2 profile, int segments) : profile_(std::move(profile)), segments_(segments) {}

  struct Opening {
    int low, high;    ///< rows
    int left, right;  ///< columns, which may be negative
  };
  /// Its border, counter-clockwise from outside.
  Loop3 open(const Opening& o) {
    openings_.push_back(o);
    Loop3 out;
    for (int j = o.low; j < o.high; ++j) out.push_back(at(o.left, j));
    for (int i = o.left; i < o.right; ++i) out.push_back(at(i, o.high));
    for (int j = o.high; j > o.low; --j) out.push_back(at(o.right, j));
    for (int i = o.right; i > o.left; --i) out.push_back(at(i, o.low));
    return out;
  }
  void build(Builder& builder) const {
    const int rows = int(profile_.size());
    for (int i = 0; i < segments_; ++i)
      for (int j = 0; j < rows; ++j)
        if (!is_open(i, j))
          builder.quad(at(i, j), at(i, (j + 1) % rows), at(i + 1, (j + 1) % rows), at(i + 1, j));
  }

 private:
  Vec3 at(int column, int row) const {
    const double a = 2 * det::pi * ((column % segments_ + segments_) % segments_) / segments_;
    const Point2& p = profile_[size_t(row)];
    return {p.u * det::cos(a), p.w, p.u * det::sin(a)};
  }
  bool is_open(int column, int row) const {
    return std::any_of(openings_.begin(), openings_.end(), [&](const Opening& o) {
      const int from_left = ((column - o.left) % segments_ + segments_) % segments_;
      return row >= o.low && row < o.high && from_left < o.right - o.left;
    });
  }

  Loop2 profile_;
  int segments_;
  std::vector<Opening> openings_;
};

/// A tube in the plane of x and y: where it is, where it goes, how thick it is there.
struct Knot {
  Vec3 x;
  Vec3 along;
  double radius;
};

double angle_in(const Vec3& from, const Knot& knot) {
  const Vec3 u = Vec3::UnitZ(), w = knot.along.cross(u);
  return det::atan2(from.dot(w), from.dot(u));
}

/// `count` points of its circle from an angle on, counter-clockwise about its way.
Loop3 circle(const Knot& knot, size_t count, double first_angle) {
  const Vec3 u = Vec3::UnitZ(), w = knot.along.cross(u);
  Loop3 out;
  for (size_t k = 0; k < count; ++k) {
    const double a = first_angle + 2 * det::pi * double(k) / double(count);
    out.push_back(knot.x + knot.radius * (det::cos(a) * u + det::sin(a) * w));
  }
  return out;
}

Vec3 middle_of(const Loop3& loop) {
  Vec3 out = Vec3::Zero();
  for (const Vec3& p : loop) out += p / double(loop.size());
  return out;
}

/// From one border over circles to another, which is entered, or to a flat end.
void tube(Builder& builder, const Loop3& from, const std::vector<Knot>& way, const Loop3* into) {
  const double first = angle_in(from[0] - middle_of(from), way.front());
  std::vector<Loop3> sections{from};
  for (const Knot& knot : way) sections.push_back(circle(knot, from.size(), first));
  if (into) {
    Loop3 end(into->rbegin(), into->rend());
    const Vec3 middle = middle_of(end), ahead = sections.back()[0] - way.back().x;
    const auto towards = [&](const Vec3& p) { return (p - middle).normalized().dot(ahead); };
    const auto nearest =
        std::max_element(end.begin(), end.end(),
                         [&](const Vec3& a, const Vec3& b) { return towards(a) < towards(b); });
    std::rotate(end.begin(), nearest, end.end());
    sections.push_back(end);
  } else {
    builder.polygon(sections.back());
  }
  skin(builder, sections, false);
}

/// Knots along a curve through points, `steps` from one to the next.
std::vector<Knot> way_through(const std::vector<Vec3>& points, const std::vector<double>& radii,
                              int steps) {
  const auto at = [&](long i) {
    return points[size_t(std::clamp(i, 0L, long(points.size()) - 1))];
  };
  std::vector<Knot> out;
  for (long i = 0; i + 1 < long(points.size()); ++i)
    for (int k = 0; k < steps + (i + 2 == long(points.size())); ++k) {
      const double t = double(k) / steps;
      const Vec3 a = at(i - 1), b = at(i), c = at(i + 1), d = at(i + 2);
      const Vec3 x =
          b + 0.5 * t * (c - a + t * (2 * a - 5 * b + 4 * c - d + t * (3 * (b - c) + d - a)));
      const Vec3 v =
          0.5 * (c - a) + t * (2 * a - 5 * b + 4 * c - d) + 1.5 * t * t * (3 * (b - c) + d - a);
      out.push_back({x, v.normalized(), (1 - t) * radii[size_t(i)] + t * radii[size_t(i) + 1]});
    }
  return out;
}

}  // namespace

Mesh make_chair() {
  const std::array<std::vector<double>, 3> lines{
      std::vector{-0.22, -0.17, 0.17, 0.22},          // leg, between, leg
      std::vector{0.0, 0.43, 0.47, 0.62, 0.90},       // legs, seat, posts, rest
      std::vector{-0.22, -0.18, -0.17, 0.17, 0.22}};  // rest, post, between, leg
  Builder builder;
  cells_of_grid(builder, lines, [](int x, int y, int z) {
    const bool side = x != 1;
    if (y == 0) return side && z != 2;  // legs
    if (y == 1) return true;            // seat
    if (y == 2) return side && z <= 1;  // posts
    return z == 0 || (side && z == 1);  // rest between them
  });
  return builder.centred_mesh();
}

Mesh make_teapot() {
  // Foot, belly, shoulder, a rounded rim, and down again inside at 15 mm from the outside.
  const Loop2 profile = {
      {0, 0},         {0.11, 0},       {0.125, 0.012}, {0.158, 0.045},  {0.182, 0.085},
      {0.19, 0.12},   {0.185, 0.155},  {0.168, 0.19},  {0.14, 0.218},   {0.112, 0.237},
      {0.1, 0.252},   {0.0985, 0.264}, {0.092, 0.269}, {0.0855, 0.264}, {0.086, 0.25},
      {0.104, 0.225}, {0.13, 0.206},   {0.155, 0.18},  {0.17, 0.152},   {0.1745, 0.12},
      {0.167, 0.09},  {0.145, 0.055},  {0.115, 0.028}, {0.1, 0.02},     {0, 0.02}};
  OpenRevolution body(profile, 28);
  const Loop3 spout = body.open({3, 6, -1, 1});
  const Loop3 handle_top = body.open({6, 8, 13, 15}), handle_end = body.open({3, 5, 13, 15});
  Builder builder;
  body.build(builder);
  tube(builder, spout,
       way_through({{0.215, 0.1, 0}, {0.265, 0.125, 0}, {0.3, 0.185, 0}, {0.345, 0.25, 0}},
                   {0.035, 0.031, 0.025, 0.02}, 3),
       nullptr);
  tube(builder, handle_top,
       way_through({{-0.185, 0.21, 0},
                    {-0.235, 0.228, 0},
                    {-0.285, 0.2, 0},
                    {-0.295, 0.14, 0},
                    {-0.255, 0.085, 0},
                    {-0.2, 0.065, 0}},
                   {0.016, 0.015, 0.015, 0.015, 0.015, 0.016}, 3),
       &handle_end);
  return builder.mesh();
}

}  // namespace tumble::assets
