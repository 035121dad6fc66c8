#pragma once
#include "engine/core/chunks.hpp"
#include "engine/dynamics/particles/neighbours/neighbour_lists.hpp"
#include "engine/dynamics/sph/fluid_solver.hpp"
#include "engine/dynamics/sph/fluid_sums.hpp"
#include "engine/dynamics/sph/pressure_sums.hpp"
#include "engine/dynamics/sph/tolerances.hpp"

#include <algorithm>
#include <array>
#include <span>
#include <vector>

namespace tumble {

/// A wall in reach of a particle.
struct WallTouch {
  uint32_t wall, body;
  double share;     ///< of the kernel [-]
  Vec3 gradient;    ///< of that [1/m]
  double distance;  ///< [m]
  Vec3 normal;      ///< out of the wall
  /// The gradient as find_corrections makes it [1/m].
  Vec3 corrected = Vec3::Zero();
  /// The wall bears a part of the layer beside it: so many times what pressures do to the particle
  /// along the normal, the wall does to it besides [-]. See find_corrections.
  double lever = 0;
  double levered = 0;  ///< acceleration by that, along the normal [m/s2]
};

/// A body while the fluid of a tick is computed.
struct FluidBodyState {
  Vec3 centre, velocity, angular_velocity;
  Quat turned = Quat::Identity();  ///< since the start of the tick
  double touches = 0;              ///< how many particles it is in reach of
  Vec3 velocity_at(const Vec3& x) const { return velocity + angular_velocity.cross(x - centre); }
};

/// A force and torque about a body's centre, or impulses, or what they make of its velocities.
using Wrench = FluidPush;

/// A pressure that is sought.
struct alignas(16) SoughtPressure {
  float now;                     ///< [Pa]
  float step;                    ///< that a gradient makes of it [Pa]
  float residual;                ///< of it: see PressureSolve [1/s2]
  float source;                  ///< [1/s2]
  float diagonal, per_diagonal;  ///< [m3/(kg m2)], and one over it; 0: none
  float volume;                  ///< [volume units]
  /// Of the last iteration and the one before it [Pa].
  struct Change {
    float pressure = 0, step = 0;
  };
  Change changes[2];
};

/// What the pressure solve is made of: see pressure_sums. By place.
struct PressureOperands {
  std::vector<FlowRow> rows;
  std::vector<PushRow> pushes;                   ///< of plain slopes
  std::vector<StressRow> stresses;               ///< of corrected ones
  std::vector<SymmetricRow<float>> corrections;  ///< [-]
  std::vector<SingleVector> plain_gradients;     ///< sum of volumes times f d
  /// The sums of a particle's own gradients and those of walls, over its volume, and as w its
  /// volume over density and length unit [m2/kg].
  std::vector<SingleVector> gradients;
  std::vector<float> volumes;        ///< [volume units]
  std::vector<SingleVector> moving;  ///< velocities over the sub-step, times volumes
  std::vector<SoughtPressure> sought;
  std::vector<float> weights;                        ///< pressures times volumes [Pa volume units]
  std::vector<SymmetricRow<double>> exact_stresses;  ///< [Pa m3]
  std::vector<double> source;                        ///< [1/s2]
};

/// Memory of solve_viscosity and smooth_velocities, by place but for what is said.
struct ViscousOperands {
  FluidVectors residual, direction, image, found;
  std::vector<double> viscosity, scale, exchanged;
  std::vector<double> walls;  ///< by touch
};

/// Fluid and bodies in a sub-step. Particles are by place: see NeighbourLists.
struct FluidState {
  // -- of the tick
  std::span<const FluidDef* const> defs;  ///< of the fluids that are solved together
  FluidDef common;  ///< what they have in common, and of the rest the finest and the most
  SmoothingKernel kernel;
  double spacing = 0;   ///< cube root of the mean volume of particles [m]
  double stiffest = 1;  ///< largest eigenvalue over diagonal of the pressures that was seen [-]
  std::span<const FluidBody> body_defs;
  std::span<const FluidWall> walls;
  Crew* crew = nullptr;
  std::vector<FluidBodyState> bodies;
  std::vector<FluidPush> pushes;  ///< so far in the tick
  FluidReport report;
  FluidTrace* trace = nullptr;     ///< null: nobody looks
  std::vector<double> last_shift;  ///< by the caller's index, pressures of the last sub-step [Pa]

  // -- of the sub-step
  double h = 0;  ///< [s]
  NeighbourLists lists;
  FluidVectors at;                       ///< places [m] and volumes [m3]
  FluidVectors v, acceleration;          ///< [m/s]; of a solve [m/s2]
  FluidVectors terms;                    ///< what sums over pairs are of
  FluidVectors shift;                    ///< velocity of particles in this sub-step alone [m/s]
  std::vector<uint8_t> fluid;            ///< of which of the fluids a particle is
  std::vector<double> density;           ///< at rest [kg/m3]
  std::vector<double> volume, pressure;  ///< [m3], [Pa]
  std::vector<double> shift_pressure;    ///< what makes the shift, as a pressure [Pa]
  std::vector<double> share;             ///< density over that at rest [-]
  std::vector<Vec3> fluid_gradient;      ///< sum of V f d [1/m]
  std::vector<Vec3> gradient;            ///< that and the walls' gradients [1/m]
  std::vector<double> diagonal;  ///< how much a particle's own pressure opens it [m3/(kg m2)]
  /// Of `dfsph`: what makes sums of slopes exact for velocities that are linear in places, and the
  /// diagonal with it: see find_corrections.
  std::vector<Mat3> moment;                ///< of FluidPairSums [-]
  std::vector<Mat3> square_matrix;         ///< of the same [1/(kg m2)]
  std::vector<Mat3> correction;            ///< [-]
  std::vector<double> corrected_diagonal;  ///< [m3/(kg m2)]
  std::vector<double> slopes;              ///< sum of V f: see FluidPairSums [1/m2]
  Vec3 origin = Vec3::Zero();              ///< near the fluid, for what is linear in places [m]
  std::vector<size_t> first_touch;         ///< by place, and one more
  std::vector<WallTouch> touches;
  std::vector<std::vector<WallTouch>> found_touches;  ///< by chunk, before they are `touches`
  std::vector<uint32_t> touch_counts;                 ///< likewise, by place

  FluidPairs pairs;
  std::vector<SingleVector> single_volumes;  ///< see FluidPoints
  PressureOperands pressure_operands;
  ViscousOperands viscous_operands;

  size_t size() const { return lists.size(); }
  const FluidDef& def(size_t p) const { return *defs[fluid[p]]; }
  bool any(double FluidDef::*value) const {
    return std::ranges::any_of(defs, [&](const FluidDef* d) { return d->*value > 0; });
  }
  /// Whether pressures are by corrected slopes. Those of an attraction between particles are plain:
  /// pressures that are to bear it have them, too, else the shift would give it energy.
  bool corrects() const {
    return common.solver == FluidSolverKind::dfsph && !any(&FluidDef::surface_tension);
  }
  Vec3 x(size_t p) const { return at[p]; }
  Vec3 local(size_t p) const { return at[p] - origin; }
  std::span<const WallTouch> touches_of(size_t p) const {
    return {touches.data() + first_touch[p], first_touch[p + 1] - first_touch[p]};
  }
  Pose wall_pose(const FluidWall& wall) const;

  /// f(p) for all places.
  template <class F>
  void each(const F& f) const {
    for_chunks(crew, size(), [&](size_t, size_t first, size_t last) {
      for (size_t p = first; p < last; ++p) f(p);
    });
  }
  /// Sum of f(p) over all places, the same for every number of threads.
  template <class F>
  double sum(const F& f) const {
    return sum_chunks([&](size_t first, size_t last) {
      double s = 0;
      for (size_t p = first; p < last; ++p) s += f(p);
      return s;
    });
  }
  /// f(p, sum over the others of what `factor` says times y) for all places: see sum_pairs.
  template <class F>
  void each_with_pairs(FluidFactor factor, const FluidVectors& y, const double* q,
                       const F& f) const {
    each_batch<FluidVector>(
        [&](size_t first, size_t end, FluidVector* sums) {
          sum_pairs(pairs, factor, first, end, y.data(), q, sums);
        },
        [&](size_t, size_t p, const FluidVector& sum) { f(p, sum); });
  }
  /// For a few groups at a time find(first, end, sums of their particles), and for each of these
  /// f(chunk, place, sum).
  template <class Sum, class Find, class F>
  void each_batch(const Find& find, const F& f) const {
    for_chunks(crew, pairs.groups(), [&](size_t chunk, size_t first, size_t last) {
      constexpr size_t together = tolerances::batch_groups;
      std::array<Sum, FluidGroup::size * together> sums;
      for (size_t g = first; g < last; g += together) {
        const size_t end = std::min(last, g + together);
        find(g, end, sums.data());
        const size_t begin = lists.groups()[g].first;
        const NeighbourLists::Group& to = lists.groups()[end - 1];
        for (size_t p = begin; p < to.first + to.count; ++p) f(chunk, p, sums[p - begin]);
      }
    });
  }
  /// Sum over all places of what f(p, by body) adds to bodies, likewise.
  template <class F>
  std::vector<Wrench> sum_wrenches(const F& f) const {
    const size_t n = bodies.size();
    std::vector<Wrench> parts(chunk_count * n);
    for_chunks(crew, size(), [&](size_t chunk, size_t first, size_t last) {
      const std::span<Wrench> part(parts.data() + chunk * n, n);
      for (size_t p = first; p < last; ++p)
        if (first_touch[p] != first_touch[p + 1]) f(p, part);
    });
    std::vector<Wrench> total(n);
    for (size_t k = 0; k < parts.size(); ++k) {
      total[k % n].impulse += parts[k].impulse;
      total[k % n].angular_impulse += parts[k].angular_impulse;
    }
    return total;
  }
  void add_force(std::span<Wrench> to, uint32_t body, const Vec3& at, const Vec3& force) const {
    to[body].impulse += force;
    to[body].angular_impulse += (at - bodies[body].centre).cross(force);
  }
  /// What a force and torque make of a body's velocities per second.
  Wrench response(size_t body, const Wrench& w) const {
    return {body_defs[body].inverse_mass * w.impulse, turned_inertia(body) * w.angular_impulse};
  }
  Mat3 turned_inertia(size_t body) const {
    const Mat3 r = bodies[body].turned.toRotationMatrix();
    return r * body_defs[body].inverse_inertia * r.transpose();
  }
  /// Velocity of the response at a point.
  Vec3 response_at(std::span<const Wrench> responses, uint32_t body, const Vec3& at) const {
    return responses[body].impulse +
           responses[body].angular_impulse.cross(at - bodies[body].centre);
  }
  /// Bodies have had these impulses.
  void push_bodies(std::span<const Wrench> impulses);
  /// v += h acceleration; gives the work on the particles [J].
  double accelerate();

 private:
  /// Sum of f(first, last) over chunks of places.
  template <class F>
  double sum_chunks(const F& f) const {
    std::array<double, chunk_count> parts{};
    for_chunks(crew, size(),
               [&](size_t chunk, size_t first, size_t last) { parts[chunk] = f(first, last); });
    double total = 0;
    for (const double part : parts) total += part;
    return total;
  }
};

// With d = x - x' the way from another particle, which is linear in both places, sums of products
// with d come out of one sum over the others, and of what the particle itself has:
//   sum of V f (p + p') d = p sum of V f d + x sum of V f p' - sum of V f p' x'

/// What each_with_pairs has to be given for it, and what it makes of that but for the particle's
/// own p.
inline FluidVector pressing(const FluidState& s, size_t p, double pressure) {
  const double w = s.volume[p] * pressure;
  const Vec3 x = w * s.local(p);
  return {x[0], x[1], x[2], w};
}
inline Vec3 pressed(const FluidState& s, size_t p, const FluidVector& sum) {
  return sum.w * s.local(p) - sum.vector();
}
/// For sums of V f (u - u') or V W (u - u').
inline FluidVector differing(const FluidState& s, size_t p, const Vec3& u) {
  const Vec3 v = s.volume[p] * u;
  return {v[0], v[1], v[2], s.volume[p]};
}
inline Vec3 difference(const Vec3& u, const FluidVector& sum) {
  return sum.w * u - sum.vector();
}

/// Lists of neighbours at the particles' present places. What the caller has by place follows.
Status find_neighbours(FluidState& s, std::span<const Vec3> x, double skin);
/// Walls, shares, gradients and diagonals, from places and volumes.
void find_surroundings(FluidState& s);
/// From these the corrections, and with them gradients and diagonals.
void find_corrections(FluidState& s);
/// Fills FluidState::touches.
void find_walls(FluidState& s);
/// Bodies move on for the sub-step.
void move_bodies(FluidState& s);
/// What is about to come nearer to a wall than particles do gets an impulse of the wall.
void keep_clear_of_walls(FluidState& s);

/// Pressures of the divergence-free solver: velocities of particles and bodies that do not make
/// shares larger than 1, and then what else moves particles so that none is.
void solve_pressure(FluidState& s);
void shift_particles(FluidState& s);
/// Pressures by the equation of state.
void press_by_state(FluidState& s, double sound_speed);
/// Implicit viscosity, and XSPH.
void solve_viscosity(FluidState& s);
void smooth_velocities(FluidState& s);
/// Surface tension and adhesion.
void pull_surfaces(FluidState& s);

}  // namespace tumble
