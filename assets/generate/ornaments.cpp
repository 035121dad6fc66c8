// A chess rook, a star and a knot.
#include "assets/generate/constructions.hpp"
#include "assets/generate/makers.hpp"
#include "engine/math/det/det.hpp"

#include <cmath>

namespace tumble::assets {

Mesh make_star_prism() {
  Loop2 star;
  for (int i = 0; i < 10; ++i) {
    const double radius = i % 2 == 0 ? 0.26 : 0.125, angle = det::pi / 2 + det::pi * i / 5;
    star.push_back({radius * det::cos(angle), radius * det::sin(angle)});
  }
  Builder builder;
  extrude(builder, star, {}, 0.10, 0.012);
  return builder.mesh(Vec3(0, -0.05, 0));
}

Mesh make_trefoil_knot() {
  Loop3 curve;
  constexpr int segments = 132;
  for (int i = 0; i < segments; ++i) {
    const double t = 2 * det::pi * i / segments;
    curve.push_back(0.1 * Vec3(det::sin(t) + 2 * det::sin(2 * t), -det::sin(3 * t),
                               det::cos(t) - 2 * det::cos(2 * t)));
  }
  Builder builder;
  closed_tube(builder, curve, 0.055, 12, Vec3::UnitY());
  return builder.centred_mesh();
}

Mesh make_rook() {
  // Foot, waist and collar in one profile up to the floor of the battlements; above it, sectors.
  constexpr int segments = 48, sector = 8, wall_share = 5;  // six merlons, five eighths of the ring
  constexpr double low = 0.50, high = 0.57, outer = 0.135, inner = 0.09, dish = 0.47;
  Loop2 body = {{0, 0},         {0.165, 0},     {0.175, 0.01},  {0.175, 0.045}, {0.165, 0.06},
                {0.145, 0.07},  {0.138, 0.09},  {0.120, 0.12},  {0.106, 0.16},  {0.097, 0.21},
                {0.092, 0.27},  {0.090, 0.33},  {0.092, 0.37},  {0.118, 0.385}, {0.118, 0.40},
                {0.100, 0.415}, {0.120, 0.435}, {outer, 0.445}, {outer, low}};
  Builder builder;
  for (int i = 0; i < segments; ++i) {
    const auto at = [&](int k, double r, double y) {
      const double angle = 2 * det::pi * ((k + segments) % segments) / segments;
      return Vec3(r * det::cos(angle), y, -r * det::sin(angle));
    };
    const auto strip = [&](double r0, double y0, double r1, double y1) {
      builder.quad(at(i, r0, y0), at(i + 1, r0, y0), at(i + 1, r1, y1), at(i, r1, y1));
    };
    for (size_t j = 0; j + 1 < body.size(); ++j) {
      strip(body[j].u, body[j].w, body[j + 1].u, body[j + 1].w);
    }
    const bool merlon = i % sector < wall_share;
    const bool merlon_before = (i + segments - 1) % segments % sector < wall_share;
    if (merlon) {
      strip(outer, low, outer, high);
      strip(outer, high, inner, high);
      strip(inner, high, inner, low);
    } else {
      strip(outer, low, inner, low);
    }
    if (merlon && !merlon_before) {
      builder.quad(at(i, inner, low), at(i, outer, low), at(i, outer, high), at(i, inner, high));
    } else if (!merlon && merlon_before) {
      builder.quad(at(i, outer, low), at(i, inner, low), at(i, inner, high), at(i, outer, high));
    }
    strip(inner, low, inner, dish);
    strip(inner, dish, 0, dish);
  }
  return builder.mesh();
}

}  // namespace tumble::assets
