#pragma once
#include <array>
#include <cmath>
#include <memory>

/// Chains of equal rods, one after the other from the world's origin, in every library the same.
/// In C++ of 2017, which is what Simbody's headers are written in.
namespace tumble::bench {

inline constexpr double rod_length = 0.2, rod_half_width = 0.02, rod_mass = 1, gravity = 9.81;
inline constexpr double step_seconds = 1e-3;

using Axis = std::array<double, 3>;

struct ChainScene {
  int links = 0;
  /// Open: hinges across the rods, each across the one before, bent and moving. Closed: a ring of
  /// ball joints at rest, whose last rod ends at the origin.
  bool closed = false;

  /// Of a link's hinge, in its own axes and in those of the link before.
  Axis axis(int link) const { return closed || link % 2 == 0 ? Axis{0, 0, 1} : Axis{0, 1, 0}; }
  double angle(int link) const {
    return closed ? 2 * std::acos(-1.0) / links : 0.4 * std::sin(1.7 * link);
  }
  double rate(int link) const { return closed ? 0 : 0.5 * std::cos(2.3 * link); }
  /// Moments about the centre [kg m2].
  static Axis inertia() {
    const double l2 = rod_length * rod_length, w2 = 4 * rod_half_width * rod_half_width;
    return {rod_mass / 12 * 2 * w2, rod_mass / 12 * (l2 + w2), rod_mass / 12 * (l2 + w2)};
  }
};

/// A library's chain. Both figures are sums over the joints of the size of their own acceleration,
/// by which answers are compared [rad/s2].
class ChainPeer {
 public:
  virtual ~ChainPeer() = default;
  /// One evaluation of the accelerations from positions and velocities that are new.
  virtual double evaluate() = 0;
  /// A step of step_seconds by a Runge-Kutta method; returns the tip's height [m].
  virtual double step() = 0;
};

std::unique_ptr<ChainPeer> tumble_chain(const ChainScene& scene);
std::unique_ptr<ChainPeer> mujoco_chain(const ChainScene& scene);
std::unique_ptr<ChainPeer> simbody_chain(const ChainScene& scene);

}  // namespace tumble::bench
