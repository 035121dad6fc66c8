// Rings, fasteners, profiles and the parts of the feeder: things that are turned, milled or bent.
#include "assets/generate/constructions.hpp"
#include "assets/generate/makers.hpp"
#include "engine/math/det/det.hpp"

#include <algorithm>
#include <cmath>

namespace tumble::assets {
namespace {

using det::pi;

/// Corner radius of a hexagon from the width across its flats.
double hexagon_radius(double across_flats) {
  return across_flats / 2 / det::cos(pi / 6);
}

/// A rectangle of a profile with its four corners chamfered, counter-clockwise.
Loop2 chamfered_box(double u0, double u1, double w0, double w1, double c) {
  return {{u0 + c, w0}, {u1 - c, w0}, {u1, w0 + c}, {u1, w1 - c},
          {u1 - c, w1}, {u0 + c, w1}, {u0, w1 - c}, {u0, w0 + c}};
}

Mesh turned(const Loop2& profile, int segments) {
  Builder builder;
  revolve(builder, profile, segments);
  return builder.centred_mesh();
}

Mesh milled(const Loop2& outer, const std::vector<Loop2>& holes, double height, double bevel) {
  Builder builder;
  extrude(builder, outer, holes, height, bevel);
  return builder.centred_mesh();
}

/// tan(a) - a, the involute function.
double involute(double a) {
  return det::sin(a) / det::cos(a) - a;
}

/// Outline of an involute spur gear: module m [m], z teeth, pressure angle 20 degrees, addendum m,
/// dedendum 1.25 m, flanks thinned by 1 % of the pitch for play.
Loop2 gear_outline(double m, int teeth) {
  const double pressure = 20 * pi / 180;
  const double pitch = m * teeth / 2, base = pitch * det::cos(pressure);
  const double root = pitch - 1.25 * m, tip = pitch + m;
  const double half_at_pitch = pi / (2 * teeth) - 0.01 * pi / teeth;
  constexpr int flank_points = 5;
  const auto half_angle = [&](double radius) {
    return half_at_pitch + involute(pressure) - involute(det::acos(base / radius));
  };
  Loop2 flank = {{root, half_angle(base) + 0.02}};  // (radius, angle from the tooth's middle)
  for (int k = 0; k < flank_points; ++k) {
    const double radius = base + (tip - base) * k / (flank_points - 1);
    flank.push_back({radius, half_angle(radius)});
  }
  Loop2 outline;
  for (int i = 0; i < teeth; ++i) {
    const double middle = 2 * pi * i / teeth;
    for (const Point2& p : flank) {
      outline.push_back({p.u * det::cos(middle - p.w), p.u * det::sin(middle - p.w)});
    }
    for (auto p = flank.rbegin(); p != flank.rend(); ++p) {
      outline.push_back({p->u * det::cos(middle + p->w), p->u * det::sin(middle + p->w)});
    }
  }
  return outline;
}

/// Wall of a drilled hole: circles at two depths, seen from inside the hole.
void drill(Builder& builder, const Loop3& from, const Loop3& to) {
  for (size_t i = 0; i < from.size(); ++i) {
    const size_t k = (i + 1) % from.size();
    builder.quad(from[i], to[i], to[k], from[k]);
  }
}

}  // namespace

Mesh make_ring() {
  return turned(chamfered_box(0.20, 0.26, 0, 0.10, 0.012), 56);
}

Mesh make_washer() {
  return turned(chamfered_box(0.065, 0.13, 0, 0.024, 0.004), 40);
}

Mesh make_torus_link() {
  Loop2 section = regular_polygon(0.045, 14);
  for (Point2& p : section) p.u += 0.20;
  return turned(section, 32);
}

Mesh make_chain_link() {
  Loop3 curve;
  constexpr double radius = 0.14, straight = 0.12;
  constexpr int segments = 16, straight_segments = 3;
  for (int side : {1, -1}) {
    for (const Point2& p : arc(0, straight, radius, 0, pi, segments)) {
      curve.emplace_back(side * p.u, side * p.w, 0);
    }
    for (int i = 1; i < straight_segments; ++i) {
      const double y = straight - 2 * straight * i / straight_segments;
      curve.emplace_back(-side * radius, side * y, 0);
    }
  }
  Builder builder;
  closed_tube(builder, curve, 0.045, 14, Vec3::UnitZ());
  return builder.centred_mesh();
}

Mesh make_gear() {
  return milled(gear_outline(0.03, 16), {regular_polygon(0.07, 36)}, 0.09, 0.005);
}

Mesh make_hex_nut() {
  return milled(regular_polygon(hexagon_radius(0.20), 6), {regular_polygon(0.065, 32)}, 0.09, 0.01);
}

Mesh make_hex_bolt() {
  constexpr double shank = 0.06, length = 0.27, head = 0.10, bevel = 0.012;
  const Loop2 hexagon = regular_polygon(hexagon_radius(0.20), 6);
  const Loop2 circle = regular_polygon(shank, 32), tip = regular_polygon(shank - bevel, 32);
  Builder builder;
  skin(builder,
       {at_height(tip, -length), at_height(circle, -length + bevel), at_height(circle, -length / 2),
        at_height(circle, 0)},
       false);
  skin(builder,
       {at_height(hexagon, 0), at_height(hexagon, head - bevel),
        at_height(inset(hexagon, bevel), head)},
       false);
  builder.polygon(at_height(inset(hexagon, bevel), head));
  Loop3 under = at_height(hexagon, 0), end = at_height(tip, -length);
  std::reverse(under.begin(), under.end());
  std::reverse(end.begin(), end.end());
  builder.polygon(under, {at_height(circle, 0)});
  builder.polygon(end);
  return builder.centred_mesh();
}

Mesh make_l_bracket() {
  constexpr double leg = 0.36, thick = 0.05, half_width = 0.17, hole = 0.065;
  constexpr double hole_at = 0.215, hole_z = 0.085;
  Builder builder;
  // One leg lies along x; the other is its mirror image in the plane x = y, which turns faces over.
  for (const bool mirrored : {false, true}) {
    const auto place = [&](const Loop3& loop) {
      Loop3 result = loop;
      if (mirrored) {
        std::reverse(result.begin(), result.end());
        for (Vec3& p : result) std::swap(p.x(), p.y());
      }
      return result;
    };
    const auto circle = [&](double y, double z) {
      Loop3 loop = at_height(regular_polygon(hole, 24), y);
      for (Vec3& p : loop) p += Vec3(hole_at, 0, z);
      return place(loop);
    };
    const auto rectangle = [&](double x, double y) {  // from x to the leg's end, facing up
      return Loop3{
          {x, y, half_width}, {leg, y, half_width}, {leg, y, -half_width}, {x, y, -half_width}};
    };
    Loop3 outside = rectangle(0, 0);
    std::reverse(outside.begin(), outside.end());
    builder.polygon(place(outside), {circle(0, hole_z), circle(0, -hole_z)});
    builder.polygon(place(rectangle(thick, thick)),
                    {circle(thick, hole_z), circle(thick, -hole_z)});
    builder.polygon(place({{leg, 0, half_width},
                           {leg, 0, -half_width},
                           {leg, thick, -half_width},
                           {leg, thick, half_width}}));
    for (const double z : {hole_z, -hole_z}) {
      drill(builder, circle(0, z), circle(thick, z));
    }
  }
  for (const double side : {1.0, -1.0}) {
    const double z = side * half_width;
    Loop3 cap = {{0, 0, z},         {leg, 0, z},     {leg, thick, z},
                 {thick, thick, z}, {thick, leg, z}, {0, leg, z}};
    if (side < 0) std::reverse(cap.begin(), cap.end());
    builder.polygon(cap);
  }
  return builder.centred_mesh();
}

Mesh make_i_beam() {
  // Flanges 0.30 x 0.04, web 0.03, height 0.40, with a fillet between web and flange.
  constexpr double half_width = 0.15, half_height = 0.20, flange = 0.04, web = 0.015, fillet = 0.03;
  constexpr double half_length = 2.0;
  Loop2 quarter = {{half_width, half_height - flange}, {half_width, half_height}};
  Loop2 root = arc(web + fillet, half_height - flange - fillet, fillet, pi, pi / 2, 4);
  root.insert(root.end(), quarter.begin(), quarter.end());
  Loop2 section;  // right upper quarter upwards, then its three mirror images
  const auto add = [&](double su, double sw) {
    Loop2 part = root;
    if (su * sw < 0) std::reverse(part.begin(), part.end());
    for (const Point2& p : part) section.push_back({su * p.u, sw * p.w});
  };
  add(1, 1);
  add(-1, 1);
  add(-1, -1);
  add(1, -1);
  Builder builder;
  std::vector<Station> path;
  for (int i = 0; i <= 8; ++i) {
    const double x = half_length * (i - 4) / 4;
    path.push_back({Vec3(x, 0, 0), -Vec3::UnitZ(), Vec3::UnitY()});
  }
  sweep(builder, section, path, false);
  return builder.mesh();
}

Mesh make_t_part() {
  return milled({{-0.04, -0.12},
                 {0.04, -0.12},
                 {0.04, 0.04},
                 {0.13, 0.04},
                 {0.13, 0.12},
                 {-0.13, 0.12},
                 {-0.13, 0.04},
                 {-0.04, 0.04}},
                {regular_polygon(0.022, 20)}, 0.07, 0.008);
}

Mesh make_l_part() {
  Loop2 hole = regular_polygon(0.025, 20);
  for (Point2& p : hole) p = {p.u + 0.045, p.w + 0.045};
  return milled({{0, 0}, {0.20, 0}, {0.20, 0.09}, {0.09, 0.09}, {0.09, 0.26}, {0, 0.26}}, {hole},
                0.07, 0.008);
}

Mesh make_stepped_shaft() {
  return turned({{0, 0},
                 {0.032, 0},
                 {0.040, 0.008},
                 {0.040, 0.12},
                 {0.085, 0.12},
                 {0.090, 0.125},
                 {0.090, 0.175},
                 {0.085, 0.18},
                 {0.060, 0.18},
                 {0.060, 0.29},
                 {0.045, 0.30},
                 {0.045, 0.36},
                 {0.038, 0.367},
                 {0, 0.367}},
                36);
}

}  // namespace tumble::assets
