// A pin tumbler lock, ten times as large as one of a door, and two keys for it. Sections stand
// across the x axis, about which the plug turns: u = y, w = z, counter-clockwise as seen from +x.
#include "assets/generate/constructions.hpp"
#include "assets/generate/makers.hpp"
#include "engine/math/det/det.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>

namespace tumble::assets {
namespace {

using det::pi;

constexpr int pins = 4;
constexpr double plug_radius = 0.1, bore_radius = 0.1015;
constexpr double hole = 0.038;                       // side of the square holes of the pins
constexpr double way = 0.022;                        // width of the keyway
constexpr double way_low = -0.075, way_top = 0.045;  // its floor and roof
constexpr double ledge = 0;                          // height on which pins rest without a key
constexpr double back = -0.5, flange = -0.03, bearing = -0.032;  // stations along x

/// Middle of hole number `i`, counted from the front.
double pin_at(int i) {
  return -0.12 - 0.1 * i;
}

/// The part of a circle that the holes leave, and the part that they take, from one hole's corner
/// to the other.
struct SlottedCircle {
  Loop2 rest, slot;
};
SlottedCircle slotted_circle(double radius) {
  const double corner = det::asin(hole / 2 / radius);
  return {arc(0, 0, radius, corner, 2 * pi - corner, 84), arc(0, 0, radius, -corner, corner, 6)};
}

/// One loop of several that begin where the one before ends.
Loop2 joined(std::initializer_list<Loop2> parts) {
  Loop2 out;
  const auto same = [](const Point2& a, const Point2& b) {
    return std::abs(a.u - b.u) + std::abs(a.w - b.w) < 1e-9;
  };
  for (const Loop2& part : parts)
    for (const Point2& p : part)
      if (out.empty() || !same(p, out.back())) out.push_back(p);
  if (same(out.front(), out.back())) out.pop_back();
  return out;
}

Loop3 at_station(const Loop2& loop, double x) {
  Loop3 out;
  for (const Point2& p : loop) out.emplace_back(x, p.u, p.w);
  return out;
}

Loop2 reversed(Loop2 loop) {
  std::reverse(loop.begin(), loop.end());
  return loop;
}

/// A part with holes for pins: between them its section has the loops `closed`, where they are
/// `open`; `step` is what the hole takes away. Loops are solid to their left.
struct Drilled {
  std::vector<Loop2> closed, open;
  Loop2 step;
};

void walls(Builder& builder, const std::vector<Loop2>& loops, double from, double to) {
  for (const Loop2& loop : loops)
    skin(builder, {at_station(loop, from), at_station(loop, to)}, false);
}

void drilled(Builder& builder, const Drilled& part, double from, double to) {
  double x = from;
  for (int i = pins - 1; i >= 0; --i) {
    const double a = pin_at(i) - hole / 2, b = pin_at(i) + hole / 2;
    walls(builder, part.closed, x, a);
    builder.polygon(at_station(part.step, a));
    walls(builder, part.open, a, b);
    builder.polygon(at_station(reversed(part.step), b));
    x = b;
  }
  walls(builder, part.closed, x, to);
}

/// Cuts of a key at the pins, as heights above the axis. A pin of the right key is as long as what
/// lies between its cut and the middle of the gap about the plug.
using Cuts = std::array<double, pins>;

constexpr double bow_at = 0.16, bow = 0.11;  // what one holds the key by: middle and radius

/// A key seen from its side, u along the lock's axis and w up: blade with cuts, shoulder and bow.
Loop2 key_outline(const Cuts& cuts) {
  constexpr double low = -0.073, top = 0.043, tip = -0.495;
  constexpr double flat = 0.009;  // half the width of a cut's floor
  constexpr double shoulder = 0.07;
  Loop2 out = {{tip, low}, {0, low}, {0, low - 0.015}, {0.02, low - 0.015}};
  const double side = det::asin(shoulder / bow);
  const Loop2 round = arc(bow_at, 0, bow, side - pi, pi - side, 40);
  out.insert(out.end(), round.begin(), round.end());
  out.insert(out.end(), {{0.02, -low + 0.015}, {0, -low + 0.015}, {0, top}});
  for (int i = 0; i < pins; ++i) {
    const double depth = top - cuts[size_t(i)], x = pin_at(i);
    out.insert(out.end(), {{x + flat + depth, top},
                           {x + flat, top - depth},
                           {x - flat, top - depth},
                           {x - flat - depth, top}});
  }
  constexpr double ramp = 0.055;  // it lifts the pins from their ledges
  out.insert(out.end(), {{tip + ramp, top}, {tip, top - ramp}});
  return out;
}

Mesh key(const Cuts& cuts) {
  constexpr double thickness = 0.02;
  Loop2 ring_hole = regular_polygon(0.03, 24);
  for (Point2& p : ring_hole) p.u += bow_at + 0.05;
  Builder builder;
  extrude(builder, key_outline(cuts), {ring_hole}, thickness, 0.002);
  return builder.mesh({0, -thickness / 2, 0});
}

/// Cuts at which the pins part at the plug's rim.
constexpr Cuts fitting = {0.030, 0.010, 0.022, 0.035};
constexpr Cuts not_fitting = {0.010, 0.030, 0.035, 0.035};

}  // namespace

Mesh make_lock_case() {
  constexpr double side = 0.15, floor = -0.15, roof = 0.27, shaft_top = 0.24;
  const auto [rest, slot] = slotted_circle(bore_radius);
  const Loop2 outside = {{floor, -side}, {roof, -side}, {roof, side}, {floor, side}};
  const Loop2 shaft = {{shaft_top, -hole / 2}, {shaft_top, hole / 2}};
  const Loop2 bore = joined({slot, rest});
  const Drilled part = {{outside, reversed(bore)},
                        {outside, reversed(joined({shaft, rest}))},
                        joined({shaft, reversed(slot)})};
  Builder builder;
  drilled(builder, part, back, bearing);
  builder.polygon(at_station(reversed(outside), back), {at_station(bore, back)});
  builder.polygon(at_station(outside, bearing), {at_station(bore, bearing)});
  return builder.mesh();
}

Mesh make_lock_plug() {
  constexpr double flange_radius = 0.125;
  const auto [rest, slot] = slotted_circle(plug_radius);
  const Loop2 right = {{ledge, hole / 2}, {ledge, way / 2}};
  const Loop2 roof = {{ledge, way / 2}, {way_top, way / 2}, {way_top, -way / 2}, {ledge, -way / 2}};
  const Loop2 left = {{ledge, -way / 2}, {ledge, -hole / 2}};
  const Loop2 floor = {{way_low, -way / 2}, {way_low, way / 2}};
  const Loop2 round = joined({slot, rest}), keyway = joined({roof, floor});  // the latter clockwise
  const Drilled part = {{round, keyway},
                        {joined({rest, reversed(left), floor, reversed(right)})},
                        joined({slot, right, roof, left})};
  const Loop2 rim = regular_polygon(flange_radius, 90);
  Builder builder;
  drilled(builder, part, back, flange);
  walls(builder, {rim, keyway}, flange, 0);
  builder.polygon(at_station(reversed(round), back), {at_station(keyway, back)});
  builder.polygon(at_station(reversed(rim), flange), {at_station(round, flange)});
  builder.polygon(at_station(rim, 0), {at_station(keyway, 0)});
  return builder.mesh();
}

Mesh make_lock_key() {
  return key(fitting);
}

Mesh make_lock_key_wrong() {
  return key(not_fitting);
}

}  // namespace tumble::assets
