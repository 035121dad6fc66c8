// Channels for marbles of radius 0.05 m: half pipes of inner radius 0.08 m carried along a path.
#include "assets/generate/constructions.hpp"
#include "assets/generate/makers.hpp"
#include "engine/math/det/det.hpp"

#include <algorithm>
#include <cmath>

namespace tumble::assets {
namespace {

using det::pi;

constexpr double groove = 0.08, wall = 0.02;  // [m]

/// Half pipe with upright walls to `height` above the bottom of the groove, which is the origin.
Loop2 channel(double height) {
  constexpr double chamfer = 0.005;
  Loop2 section = arc(0, groove, groove + wall, pi, 2 * pi, 10);
  const double out = groove + wall;
  for (const Point2& p : {Point2{out, height - chamfer}, Point2{out - chamfer, height},
                          Point2{groove + chamfer, height}, Point2{groove, height - chamfer}}) {
    section.push_back(p);
  }
  for (const Point2& p : arc(0, groove, groove, 0, -pi, 12)) section.push_back(p);
  for (const Point2& p : {Point2{-groove, height - chamfer}, Point2{-groove - chamfer, height},
                          Point2{chamfer - out, height}, Point2{-out, height - chamfer}}) {
    section.push_back(p);
  }
  return section;
}

/// A run of a path in plan: curvature > 0 turns left, and banks by `bank` towards the inside.
struct Run {
  double length;     ///< [m]
  double curvature;  ///< [1/m]
  double bank;       ///< [rad]
  int steps;
};

/// Bank at arc length s: the runs' banks averaged over +-0.15 m, and level at both ends of the
/// path.
double bank_at(const std::vector<Run>& runs, double total, double s) {
  constexpr int samples = 15;
  const double reach = std::min({0.15, s, total - s});
  double sum = 0;
  for (int k = -samples; k <= samples; ++k) {
    double at = s + reach * k / samples;
    for (const Run& run : runs) {
      if (at <= run.length || &run == &runs.back()) {
        sum += run.bank * (run.curvature > 0 ? 1 : -1);
        break;
      }
      at -= run.length;
    }
  }
  const double ease = std::min({1.0, s / 0.15, (total - s) / 0.15});
  return sum / (2 * samples + 1) * ease;
}

/// Stations of a path that starts heading along x at `plan` (its x and z) and falls by `slope`
/// metres per metre of plan length to y = 0 at its end. Sections stand in vertical planes; banking
/// turns them about the axis of the groove.
std::vector<Station> falling_path(const Vec3& plan, double slope, const std::vector<Run>& runs) {
  double total = 0;
  for (const Run& run : runs) total += run.length;
  std::vector<Station> path;
  double heading = 0, s = 0;
  Vec3 at = plan;
  const auto add = [&] {
    const double bank = bank_at(runs, total, s);
    const Vec3 left(-det::sin(heading), 0, -det::cos(heading));
    const double c = det::cos(bank), d = det::sin(bank);
    const Vec3 u = c * left - d * Vec3::UnitY(), w = d * left + c * Vec3::UnitY();
    const Vec3 bottom = at + slope * (total - s) * Vec3::UnitY();
    path.push_back({bottom + groove * (Vec3::UnitY() - w), u, w});
  };
  add();
  for (const Run& run : runs) {
    const Vec3 start = at;
    const double heading_0 = heading, s_0 = s;
    for (int i = 1; i <= run.steps; ++i) {
      const double along = run.length * i / run.steps;
      const Vec3 forward(det::cos(heading_0), 0, -det::sin(heading_0));
      const Vec3 left(-det::sin(heading_0), 0, -det::cos(heading_0));
      s = s_0 + along;
      heading = heading_0 + run.curvature * along;
      if (run.curvature == 0) {
        at = start + along * forward;
      } else {
        const double turned = run.curvature * along;
        at = start + (det::sin(turned) * forward + (1 - det::cos(turned)) * left) / run.curvature;
      }
      add();
    }
  }
  return path;
}

Mesh channel_along(const std::vector<Station>& path, double height) {
  Builder builder;
  sweep(builder, channel(height), path, false);
  return builder.mesh();
}

/// A quarter turn of radius 0.3, entered at the origin heading along x; `side` 1 is left.
Mesh quarter_turn(double side) {
  return channel_along(falling_path(Vec3::Zero(), 0.1, {{0.3 * pi / 2, side / 0.3, 0.35, 14}}),
                       0.12);
}

/// Station of a path in the plane z = const: `angle` is the direction of travel above the x axis.
Station upright_station(double x, double y, double z, double angle) {
  return {Vec3(x, y, z), -Vec3::UnitZ(), Vec3(-det::sin(angle), det::cos(angle), 0)};
}

}  // namespace

Mesh make_marble_straight() {
  return channel_along(falling_path(Vec3(-0.5, 0, 0), 0.1, {{1.0, 0, 0, 6}}), 0.12);
}

Mesh make_marble_curve_left() {
  return quarter_turn(1);
}

Mesh make_marble_curve_right() {
  return quarter_turn(-1);
}

Mesh make_marble_spiral() {
  constexpr double radius = 0.6, turns = 3, lead = 0.3;
  const double length = 2 * pi * radius * turns;
  return channel_along(
      falling_path(Vec3(-lead, 0, radius), 1.6 / (length + 2 * lead),
                   {{lead, 0, 0, 6}, {length, 1 / radius, 0.7, int(turns) * 40}, {lead, 0, 0, 6}}),
      0.13);
}

Mesh make_marble_zigzag() {
  constexpr double run = 1.0, radius = 0.25, slope = 0.08, bank = 0.6;
  const double turn = pi * radius;
  return channel_along(falling_path(Vec3(-run / 2, 0, 3 * radius), slope,
                                    {{run, 0, 0, 10},
                                     {turn, 1 / radius, bank, 20},
                                     {run, 0, 0, 10},
                                     {turn, -1 / radius, bank, 20},
                                     {run, 0, 0, 10},
                                     {turn, 1 / radius, bank, 20},
                                     {run, 0, 0, 10}}),
                       0.13);
}

Mesh make_marble_ramp() {
  // Down the catching wall, round the scoop, then along the slope; sections square to the path.
  constexpr double length = 1.2, bend = 0.2, catch_height = 0.12;
  constexpr int bend_steps = 16, straight_steps = 6;
  const double down = det::atan(0.1);  // the slope, as an angle
  const double end_x = length / 2;
  // The straight runs from `knee` to (end_x, 0); the bend before it has its centre above the knee.
  const double knee_x = end_x - length + bend, knee_y = 0.1 * (end_x - knee_x);
  const Vec3 centre = Vec3(knee_x + bend * det::sin(down), knee_y + bend * det::cos(down), 0);
  std::vector<Station> path = {
      upright_station(centre.x() - bend, centre.y() + catch_height, 0, -pi / 2)};
  for (int i = 0; i <= bend_steps; ++i) {
    const double angle = -pi / 2 + (pi / 2 - down) * i / bend_steps;
    path.push_back(upright_station(centre.x() + bend * det::sin(angle),
                                   centre.y() - bend * det::cos(angle), 0, angle));
  }
  for (int i = 1; i <= straight_steps; ++i) {
    const double x = knee_x + (end_x - knee_x) * i / straight_steps;
    path.push_back(upright_station(x, 0.1 * (end_x - x), 0, -down));
  }
  return channel_along(path, 0.12);
}

Mesh make_marble_loop() {
  // Down a steep chute for speed, a bend, a level lead, once round while drifting sideways, and out
  // along x. The drift starts and ends gently. Rolling from 1.2 m a marble keeps to the loop: at
  // its top it needs v^2 > g r, and 10/7 g (1.2 - 2 r) with r = 0.25 m is four times as much.
  constexpr double radius = 0.30, lead = 0.3, drift = 0.26, bend = 0.5, top = 1.2;
  constexpr double steep = 40 * pi / 180;
  constexpr int steps = 64, lead_steps = 4, bend_steps = 12, chute_steps = 10;
  std::vector<Station> path;
  const double bend_x = -lead - bend * det::sin(steep), bend_y = bend * (1 - det::cos(steep));
  const double run = (top - bend_y) * det::cos(steep) / det::sin(steep);
  for (int i = 0; i < chute_steps; ++i) {
    const double t = 1 - double(i) / chute_steps;
    path.push_back(
        upright_station(bend_x - run * t, bend_y + (top - bend_y) * t, -drift / 2, -steep));
  }
  for (int i = 0; i <= bend_steps; ++i) {
    const double angle = -steep * (1 - double(i) / bend_steps);
    path.push_back(upright_station(-lead + bend * det::sin(angle), bend * (1 - det::cos(angle)),
                                   -drift / 2, angle));
  }
  for (int i = 1; i < lead_steps; ++i) {
    path.push_back(upright_station(-lead + lead * i / lead_steps, 0, -drift / 2, 0));
  }
  for (int i = 0; i <= steps; ++i) {
    const double t = double(i) / steps, angle = 2 * pi * t;
    const double z = drift * (t - det::sin(angle) / (2 * pi) - 0.5);
    path.push_back(
        upright_station(radius * det::sin(angle), radius * (1 - det::cos(angle)), z, angle));
  }
  for (int i = 1; i <= lead_steps; ++i) {
    path.push_back(upright_station(0.5 * i / lead_steps, 0, drift / 2, 0));
  }
  return channel_along(path, 0.12);
}

Mesh make_marble_funnel() {
  // Inside y = 0.62 - k / r, as the potential of gravity, between the spout's and the rim's radius.
  constexpr double spout = 0.065, rim = 0.55, k = 0.0369, thickness = 0.02, top = 0.62;
  constexpr int steps = 16;
  Loop2 inside = {{spout, 0}};
  for (int i = 0; i <= steps; ++i) {
    const double t = double(i) / steps;
    const double r = spout * det::pow(rim / spout, t);
    inside.push_back({r, top - k / r});
  }
  const double lip = inside.back().w + 0.07;
  Loop2 outside;
  for (size_t i = 1; i < inside.size(); ++i) {  // moved along the normal (slope k / r^2)
    const double slope = k / (inside[i].u * inside[i].u), n = std::sqrt(1 + slope * slope);
    outside.push_back({inside[i].u + thickness * slope / n, inside[i].w - thickness / n});
  }
  Loop2 profile = {{spout, 0}, {spout + thickness, 0}};
  for (const Point2& p : outside) {
    if (p.u > spout + thickness + 0.001) profile.push_back(p);
  }
  profile.push_back({rim + thickness, outside.back().w + 0.005});
  profile.push_back({rim + thickness, lip - 0.005});
  profile.push_back({rim + thickness - 0.005, lip});
  profile.push_back({rim + 0.005, lip});
  profile.push_back({rim, lip - 0.005});
  for (size_t i = inside.size(); i-- > 1;) profile.push_back(inside[i]);
  Builder builder;
  revolve(builder, profile, 56);
  return builder.mesh();
}

}  // namespace tumble::assets
