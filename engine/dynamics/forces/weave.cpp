#include "engine/dynamics/forces/weave.hpp"

#include "engine/dynamics/forces/tolerances.hpp"
#include "engine/math/det/det.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

namespace tumble {
namespace {

Error refused(std::string message) {
  return {ErrorCode::invalid_argument, std::move(message), {}, {}};
}

bool not_negative(double value) {
  return std::isfinite(value) && value >= 0;
}
bool positive(double value) {
  return std::isfinite(value) && value > 0;
}

double damping_of(double ratio, double stiffness, double mass) {
  return 2 * ratio * std::sqrt(stiffness * mass);
}

Status check_sheet(const Sheet& s) {
  if (s.rows < 2 || s.columns < 2 || double(s.rows) * s.columns > tolerances::most_weave_nodes)
    return refused(
        fmt::format("{} rows and {} columns: a sheet has two and more of each, and up to "
                    "{} nodes",
                    s.rows, s.columns, tolerances::most_weave_nodes));
  if (!s.corner.allFinite() || !positive(s.across.norm()) || !positive(s.down.norm()))
    return refused("corner, across and down must be finite, and across and down have a length");
  if (std::fabs(s.across.normalized().dot(s.down.normalized())) > tolerances::right_angle)
    return refused("across and down are not at right angles");
  if (!not_negative(s.damping_ratio) || !not_negative(s.radius))
    return refused(
        fmt::format("damping ratio {} and radius {} m must be >= 0", s.damping_ratio, s.radius));
  for (const WeavePin& pin : s.pins)
    if (pin.row < 0 || pin.row >= s.rows || pin.column < 0 || pin.column >= s.columns)
      return refused(
          fmt::format("there is no node in row {}, column {} to pin, of {} rows and {} "
                      "columns",
                      pin.row, pin.column, s.rows, s.columns));
  return {};
}

/// A node at the rim has half of a cell's share, or a quarter in a corner.
double share_of(const Sheet& s, int row, int column) {
  return (row == 0 || row == s.rows - 1 ? 0.5 : 1) *
         (column == 0 || column == s.columns - 1 ? 0.5 : 1);
}

/// Nodes and particles; `mass` gives that of a node.
template <class Mass>
void add_nodes(const Sheet& s, const Mass& mass, Weave& out) {
  std::vector<const WeavePin*> pinned(size_t(s.rows) * size_t(s.columns), nullptr);
  for (const WeavePin& pin : s.pins) pinned[size_t(s.node(pin.row, pin.column))] = &pin;
  ParticleDef particle;
  particle.v = s.velocity;
  particle.colour = s.colour;
  particle.radius = s.radius > 0
                        ? s.radius
                        : tolerances::radius_in_spacings * std::min(s.cell_across(), s.cell_down());
  for (int r = 0; r < s.rows; ++r)
    for (int c = 0; c < s.columns; ++c) {
      if (const WeavePin* pin = pinned[size_t(s.node(r, c))]) {
        out.mesh.nodes.push_back(pin->anchor);
        continue;
      }
      out.own.push_back(uint32_t(out.mesh.nodes.size()));
      out.mesh.nodes.emplace_back();
      particle.x =
          s.corner + s.across * (double(c) / (s.columns - 1)) + s.down * (double(r) / (s.rows - 1));
      particle.mass = mass(r, c);
      out.particles.push_back(particle);
    }
  out.mesh.drawing.colour = s.colour;
  out.mesh.drawing.second_colour = s.second_colour;
}

/// Links along the threads. The stiffnesses are those of threads inside; at the rim, half of it.
void add_threads(const Sheet& s, double k_across, double k_down, double mass, bool half_at_rim,
                 Weave& out) {
  const auto add = [&](int a, int b, double length, double k) {
    out.mesh.links.push_back(
        {uint32_t(a), uint32_t(b), length, k, damping_of(s.damping_ratio, k, 0.5 * mass)});
  };
  const auto rim = [half_at_rim](int i, int count) {
    return half_at_rim && (i == 0 || i == count - 1) ? 0.5 : 1.0;
  };
  for (int r = 0; r < s.rows; ++r)
    for (int c = 0; c < s.columns; ++c) {
      if (c + 1 < s.columns)
        add(s.node(r, c), s.node(r, c + 1), s.cell_across(), rim(r, s.rows) * k_across);
      if (r + 1 < s.rows)
        add(s.node(r, c), s.node(r + 1, c), s.cell_down(), rim(c, s.columns) * k_down);
    }
}

void add_diagonals(const Sheet& s, double k, double mass, Weave& out) {
  const double length = std::hypot(s.cell_across(), s.cell_down());
  const double damping = damping_of(s.damping_ratio, k, 0.5 * mass);
  for (int r = 0; r + 1 < s.rows; ++r)
    for (int c = 0; c + 1 < s.columns; ++c)
      for (const auto& [a, b] :
           {std::pair{s.node(r, c), s.node(r + 1, c + 1)}, {s.node(r, c + 1), s.node(r + 1, c)}})
        out.mesh.links.push_back({uint32_t(a), uint32_t(b), length, k, damping});
}

SpringMesh::Bend triple(int a, int b, int c, double k, double damping) {
  return {{uint32_t(a), uint32_t(b), uint32_t(c), 0}, {1, -2, 1, 0}, 3, k, damping};
}

/// The plate energy D/2 (kxx^2 + kyy^2 + 2 kxy^2) with second differences for the curvatures.
void add_bends(const Sheet& s, double D, double mass, Weave& out) {
  const double a = s.cell_across(), b = s.cell_down();
  const auto add = [&](SpringMesh::Bend bend, double k) {
    bend.stiffness = k;
    bend.damping = damping_of(s.damping_ratio, k, mass);
    out.mesh.bends.push_back(bend);
  };
  for (int r = 0; r < s.rows; ++r)
    for (int c = 0; c < s.columns; ++c) {
      if (c > 0 && c + 1 < s.columns)
        add(triple(s.node(r, c - 1), s.node(r, c), s.node(r, c + 1), 0, 0),
            (r == 0 || r + 1 == s.rows ? 0.5 : 1) * D * b / (a * a * a));
      if (r > 0 && r + 1 < s.rows)
        add(triple(s.node(r - 1, c), s.node(r, c), s.node(r + 1, c), 0, 0),
            (c == 0 || c + 1 == s.columns ? 0.5 : 1) * D * a / (b * b * b));
      if (r + 1 < s.rows && c + 1 < s.columns)
        add({{uint32_t(s.node(r, c)), uint32_t(s.node(r, c + 1)), uint32_t(s.node(r + 1, c)),
              uint32_t(s.node(r + 1, c + 1))},
             {1, -1, -1, 1},
             4,
             0,
             0},
            2 * D / (a * b));
    }
}

/// Two triangles to a cell, cut so that neighbours differ: no direction is preferred.
void add_faces(const Sheet& s, Weave& out) {
  for (int r = 0; r + 1 < s.rows; ++r)
    for (int c = 0; c + 1 < s.columns; ++c) {
      const auto p = uint32_t(s.node(r, c)), q = uint32_t(s.node(r, c + 1)),
                 u = uint32_t(s.node(r + 1, c)), v = uint32_t(s.node(r + 1, c + 1));
      const uint32_t tone = s.stripe > 0 ? uint32_t(c / s.stripe % 2) : 0;
      if ((r + c) % 2 == 0) {
        out.mesh.faces.push_back({{p, u, v}, tone});
        out.mesh.faces.push_back({{p, v, q}, tone});
      } else {
        out.mesh.faces.push_back({{p, u, q}, tone});
        out.mesh.faces.push_back({{q, u, v}, tone});
      }
    }
}

Status check_rope(const RopeDef& d) {
  if (d.places.size() < 2) return refused("a rope needs two places and more");
  if (d.segments < 1 ||
      double(d.segments) * double(d.places.size() - 1) > tolerances::most_weave_nodes)
    return refused(
        fmt::format("{} segments: there may be 1 and more between two places, and {} in "
                    "all",
                    d.segments, tolerances::most_weave_nodes));
  for (size_t i = 0; i < d.places.size(); ++i) {
    if (!d.places[i].x.allFinite()) return refused("a place is not finite");
    if (d.places[i].loose && i > 0 && i + 1 < d.places.size())
      return refused("only the ends of a rope may be loose");
    if (i > 0 && !positive((d.places[i].x - d.places[i - 1].x).norm()))
      return refused("two places that follow each other are the same");
  }
  if (!(std::isfinite(d.slack) && d.slack >= 1))
    return refused(fmt::format("slack must be >= 1, got {}", d.slack));
  for (const auto& [name, value] :
       {std::pair{"density", d.density}, {"stiffness", d.stiffness}, {"radius", d.radius}})
    if (!positive(value)) return refused(fmt::format("{} must be > 0, got {}", name, value));
  for (const auto& [name, value] : {std::pair{"bend", d.bend}, {"damping_ratio", d.damping_ratio}})
    if (!not_negative(value)) return refused(fmt::format("{} must be >= 0, got {}", name, value));
  return {};
}

double sinh(double x) {
  return 0.5 * (det::exp(x) - det::exp(-x));
}
double asinh(double x) {
  const double size = std::fabs(x), y = det::log(size + std::sqrt(size * size + 1));
  return x < 0 ? -y : y;
}

/// Half the span over the parameter a of a catenary whose length (without its rise) is so many
/// times its span: the u > 0 with sinh(u)/u = ratio, by bisection.
double catenary_u(double ratio) {
  double low = 0, high = 1;
  while (sinh(high) / high < ratio) high *= 2;
  for (int i = 0; i < 200; ++i) {
    const double u = 0.5 * (low + high);
    if (u == low || u == high) break;
    (sinh(u) / u < ratio ? low : high) = u;
  }
  return 0.5 * (low + high);
}

}  // namespace

SpringMeshDef tie(Weave weave, ParticleSystemId system, uint64_t first) {
  for (size_t i = 0; i < weave.own.size(); ++i) {
    Anchor& anchor = weave.mesh.nodes[weave.own[i]];
    anchor.kind = Anchor::Kind::particle;
    anchor.particles = system;
    anchor.particle = first + i;
  }
  SpringMeshDef out;
  out.mesh = std::make_shared<const SpringMesh>(std::move(weave.mesh));
  return out;
}

Result<Weave> weave_cloth(const ClothDef& d) {
  const Sheet& s = d.sheet;
  if (Status fine = check_sheet(s); !fine) return fine.error();
  for (const auto& [name, value] : {std::pair{"density", d.density}, {"stretch", d.stretch}})
    if (!positive(value)) return refused(fmt::format("{} must be > 0, got {}", name, value));
  for (const auto& [name, value] : {std::pair{"shear", d.shear}, {"bend", d.bend}})
    if (!not_negative(value)) return refused(fmt::format("{} must be >= 0, got {}", name, value));
  // With threads of stiffness K a and K b per width and diagonals of shear modulus G, the energy of
  // strains e, f along the threads is Ka e^2/2 + Kb f^2/2 + G (p e + f/p)^2/2, p = a/b. A strip
  // that is free at its sides then has Young's modulus E along either thread for
  const double a = s.cell_across(), b = s.cell_down(), p2 = a * a / (b * b);
  const double E = d.stretch, G = d.shear, A = 0.5 * (E + std::sqrt(E * E + 4 * G * G));
  const double along = A - G * p2, beside = A - G / p2;
  if (!(along > 0 && beside > 0))
    return refused(
        fmt::format("cells of {:.3g} by {:.3g} m are too far from square for shear {} "
                    "N/m at stretch {} N/m (give rows and columns that make them square)",
                    a, b, G, E));
  Weave out;
  const double mass = d.density * a * b;
  add_nodes(
      s, [&](int r, int c) { return mass * share_of(s, r, c); }, out);
  add_threads(s, along * b / a, beside * a / b, mass, true, out);
  if (G > 0) add_diagonals(s, 0.5 * G * (a * a + b * b) / (a * b), mass, out);
  if (d.bend > 0) add_bends(s, d.bend, mass, out);
  add_faces(s, out);
  return out;
}

Result<Weave> weave_net(const NetDef& d) {
  const Sheet& s = d.sheet;
  if (Status fine = check_sheet(s); !fine) return fine.error();
  for (const auto& [name, value] : {std::pair{"density", d.density}, {"stiffness", d.stiffness}})
    if (!positive(value)) return refused(fmt::format("{} must be > 0, got {}", name, value));
  if (!not_negative(d.thread_radius)) return refused("the radius of threads must be >= 0");
  const double a = s.cell_across(), b = s.cell_down();
  const auto mass = [&](int r, int c) {
    const double half = 0.5 * d.density;
    return half * (a * ((c > 0) + (c + 1 < s.columns)) + b * ((r > 0) + (r + 1 < s.rows)));
  };
  Weave out;
  add_nodes(s, mass, out);
  add_threads(s, d.stiffness / a, d.stiffness / b, d.density * (a + b), false, out);
  for (const SpringMesh::Link& link : out.mesh.links) out.mesh.strands.push_back({link.a, link.b});
  out.mesh.drawing.radius = d.thread_radius;
  return out;
}

std::vector<Vec3> hanging_points(const Vec3& a, const Vec3& b, const Vec3& down, double slack,
                                 int segments) {
  std::vector<Vec3> out;
  const Vec3 g = down.normalized(), chord = b - a;
  const double length = slack * chord.norm(), drop = g.dot(chord);
  const Vec3 level = chord - drop * g;
  const double span = level.norm();
  for (int i = 0; i <= segments; ++i) {
    const double s = length * i / segments;  // along the chain
    if (!(slack > 1 + tolerances::no_sag)) {
      out.push_back(a + chord * (double(i) / segments));
    } else if (!(span > tolerances::no_sag * length)) {
      // Straight down and up again.
      const double lowest = 0.5 * (length + drop);
      out.push_back(a + std::min(s, lowest) * g - std::max(0.0, s - lowest) * g);
    } else {
      // y = a cosh(x/a) with its lowest point at arc length s0 from the start.
      const double u = catenary_u(std::sqrt(length * length - drop * drop) / span);
      const double c = 0.5 * span / u;
      const double x0 = 0.5 * span - c * asinh(-drop / (2 * c * sinh(u)));
      const double s0 = c * sinh(x0 / c), t = s - s0;
      const double x = x0 + c * asinh(t / c);
      const double fall = std::sqrt(c * c + s0 * s0) - std::sqrt(c * c + t * t);
      out.push_back(a + level * (x / span) + fall * g);
    }
  }
  out.back() = b;
  return out;
}

Result<Weave> weave_rope(const RopeDef& d) {
  if (Status fine = check_rope(d); !fine) return fine.error();
  Weave out;
  ParticleDef particle;
  particle.v = d.velocity;
  particle.colour = d.colour;
  particle.radius = d.radius;
  const auto add_particle = [&](const Vec3& x, double mass) {
    particle.x = x;
    particle.mass = mass;
    out.own.push_back(uint32_t(out.mesh.nodes.size()));
    out.mesh.nodes.emplace_back();
    out.particles.push_back(particle);
  };
  const auto add_place = [&](const RopeDef::Place& place, double mass) {
    if (place.loose)
      add_particle(place.x, mass);
    else
      out.mesh.nodes.push_back(place.anchor);
  };
  std::vector<double> lengths;  // of the links, by number
  for (size_t k = 0; k + 1 < d.places.size(); ++k) {
    const Vec3 &a = d.places[k].x, &b = d.places[k + 1].x;
    const double l = d.slack * (b - a).norm() / d.segments, mass = d.density * l;
    const std::vector<Vec3> points = hanging_points(a, b, d.down, d.slack, d.segments);
    if (k == 0) add_place(d.places[0], 0.5 * mass);
    for (int i = 1; i < d.segments; ++i) add_particle(points[size_t(i)], mass);
    add_place(d.places[k + 1], 0.5 * mass);
    for (int i = 0; i < d.segments; ++i) lengths.push_back(l);
  }
  for (uint32_t i = 0; i < lengths.size(); ++i) {
    const double l = lengths[i], k = d.stiffness / l;
    out.mesh.links.push_back({i, i + 1, l, k, damping_of(d.damping_ratio, k, 0.5 * d.density * l)});
    out.mesh.strands.push_back({i, i + 1});
    if (i == 0 || !(d.bend > 0)) continue;
    const double mean = 0.5 * (l + lengths[i - 1]), stiff = d.bend / (mean * mean * mean);
    out.mesh.bends.push_back(triple(int(i) - 1, int(i), int(i) + 1, stiff,
                                    damping_of(d.damping_ratio, stiff, d.density * mean)));
  }
  out.mesh.drawing.colour = d.colour;
  out.mesh.drawing.radius = d.radius;
  return out;
}

}  // namespace tumble
