#include "engine/scene/build/spring_limits.hpp"

#include "engine/dynamics/event/tolerances.hpp"
#include "engine/math/dense.hpp"
#include "engine/world/world.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <map>
#include <numbers>
#include <vector>

#include <Eigen/Eigenvalues>
#include <fmt/format.h>

namespace tumble {
namespace {

/// A run of a second is useful as long as integration errors alone at most double an amplitude in
/// that time.
constexpr double most_growth = 2;

/// Effect of springs on one end: sums of k n n^T / m over the springs there and the same for their
/// damping, and the stiffest spring.
struct Joined {
  Mat3 stiffness = Mat3::Zero(), damping = Mat3::Zero();  ///< [1/s2], [1/s]
  double most = 0;
  std::string spring;

  void add(const std::string& name, double k, double c, const Vec3& n, double mobility) {
    const Mat3 nn = n * n.transpose();
    stiffness += k * mobility * nn;
    damping += c * mobility * nn;
    if (k * mobility > most) most = k * mobility, spring = name;
  }
};

/// Identifies an end by what it is attached to.
using EndKey = std::pair<uint64_t, uint64_t>;

struct End {
  Vec3 x;
  double mobility = 0;  ///< of its point, as for a free body [1/kg]
  EndKey key{};
};

End end_of(const Anchor& anchor, const World& world) {
  End out{anchor.point, 0, {}};
  if (anchor.kind == Anchor::Kind::body) {
    const RigidBody* body = world.body(anchor.body);
    if (!body) return out;
    out.x = body->body_frame().point(anchor.point);
    out.mobility = body->inverse_mass;
    out.key = {anchor.body.index, 0};
  } else if (anchor.kind == Anchor::Kind::particle) {
    const ParticleSystem* system = world.particles(anchor.particles);
    const size_t i = system ? system->find(anchor.particle) : 0;
    if (!system || i == system->size()) return out;
    out.x = system->x[i];
    out.mobility = 1 / system->mass[i];
    out.key = {anchor.particles.index, anchor.particle};
  }
  return out;
}

using Ends = std::map<EndKey, Joined>;

void add_spring(const std::string& name, const End& a, const End& b, double stiffness,
                double damping, Ends& ends) {
  const double length = (b.x - a.x).norm();
  if (!(length > 0)) return;
  for (const End* end : {&a, &b})
    if (end->mobility > 0)
      ends[end->key].add(name, stiffness, damping, (b.x - a.x) / length, end->mobility);
}

/// Bending springs pull in all directions at each of their nodes.
void add_mesh(const std::string& name, const SpringMesh& mesh, const World& world, Ends& ends) {
  std::vector<End> nodes;
  for (const Anchor& node : mesh.nodes) nodes.push_back(end_of(node, world));
  for (const SpringMesh::Link& l : mesh.links)
    add_spring(name, nodes[l.a], nodes[l.b], l.stiffness, l.damping, ends);
  for (const SpringMesh::Bend& b : mesh.bends)
    for (uint32_t k = 0; k < b.count; ++k) {
      const End& end = nodes[b.node[k]];
      const double w2 = b.weight[k] * b.weight[k];
      if (!(end.mobility > 0)) continue;
      for (int axis = 0; axis < 3; ++axis)
        ends[end.key].add(name, w2 * b.stiffness, w2 * b.damping, Vec3::Unit(axis), end.mobility);
    }
}

/// The fastest oscillation of an end, estimated as if it moved alone, so never too fast.
struct Oscillation {
  double w = 0, d = 0;  ///< [rad/s], rate of decay [1/s]
};
Oscillation fastest(const Joined& joined) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(dense(joined.stiffness));
  const Vec3 axis = small_vector(solver.eigenvectors().col(2));
  return {std::sqrt(std::max(0.0, solver.eigenvalues()[2])), 0.5 * axis.dot(joined.damping * axis)};
}

/// Growth of the amplitude in a second; sub-steps of the stepper are adapted to the springs.
double growth_per_second(std::string_view integrator, const Oscillation& o, double hz) {
  const double step = tolerances::swing_per_step / std::max(o.w, 2 * o.d);
  const double h = std::min(1 / hz, step);
  return std::pow(amplification(integrator, o.w, o.d, h), 1 / h);
}
bool holds(std::string_view integrator, const Oscillation& o, double hz) {
  return growth_per_second(integrator, o, hz) <= most_growth;
}

}  // namespace

double amplification(std::string_view integrator, double w, double d, double h) {
  using Complex = std::complex<double>;
  if (integrator == "semi_implicit_euler") {
    // v+ = v - h (w^2 x + 2 d v), x+ = x + h v+: a matrix of this determinant and trace.
    const double det = 1 - 2 * d * h, half = 0.5 * (1 + det - h * h * w * w);
    const Complex root = std::sqrt(Complex(half * half - det));
    return std::max(std::abs(half + root), std::abs(half - root));
  }
  const int order = integrator == "explicit_euler" ? 1
                    : integrator == "rk2"          ? 2
                    : integrator == "rk4"          ? 4
                                                   : 0;
  double most = 0;
  for (const double sign : {1.0, -1.0}) {
    const Complex z = h * (-d + sign * std::sqrt(Complex(d * d - w * w)));
    Complex sum = 1, term = 1;
    for (int k = 1; k <= order; ++k) sum += term *= z / double(k);
    if (order > 0) most = std::max(most, std::abs(sum));
  }
  return most;
}

std::vector<std::string> spring_limit_warnings(const BuiltScene& built) {
  std::vector<std::string> out;
  const WorldSettings& settings = built.world->settings();
  if (settings.stepper != "event") return out;
  Ends ends;
  for (const auto& [name, id] : built.forces) {
    const ForceDef* force = built.world->force(id);
    if (const auto* spring = force ? std::get_if<SpringDef>(force) : nullptr)
      add_spring(name, end_of(spring->a, *built.world), end_of(spring->b, *built.world),
                 spring->stiffness, spring->damping, ends);
    if (const auto* mesh = force ? std::get_if<SpringMeshDef>(force) : nullptr)
      add_mesh(name, *mesh->mesh, *built.world, ends);
  }
  const std::string& integrator = settings.event.integrator;
  const double hz = double(settings.tick.num) / double(settings.tick.den);
  double worst = 1;
  std::string sentence;
  for (const auto& [key, joined] : ends) {
    const Oscillation o = fastest(joined);
    const double factor = std::pow(growth_per_second(integrator, o, hz), 1 / hz);
    if (holds(integrator, o, hz) || factor <= worst) continue;
    worst = factor;
    double enough = hz;
    while (enough < 1e5 && !holds(integrator, o, enough)) enough *= 2;
    sentence = fmt::format(
        "forces.{}: what it is tied to oscillates at {:.3g} Hz, which the integrator {} does not "
        "hold at {:.6g} ticks a second: the amplitude grows {:.3g}-fold in a tick ({}softer "
        "springs, or \"integrator\": \"implicit_euler\")",
        joined.spring, o.w / (2 * std::numbers::pi), integrator, hz, factor,
        holds(integrator, o, enough) ? fmt::format("\"tick_hz\": {:.0f}, ", std::ceil(enough))
                                     : "");
  }
  if (!sentence.empty()) out.push_back(std::move(sentence));
  return out;
}

}  // namespace tumble
