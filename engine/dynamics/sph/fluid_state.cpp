#include "engine/dynamics/sph/fluid_state.hpp"

#include "engine/core/stop.hpp"
#include "engine/dynamics/sph/wall_integrals.hpp"
#include "engine/math/rotation.hpp"

#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

namespace tumble {

Pose FluidState::wall_pose(const FluidWall& wall) const {
  const FluidBodyState& b = bodies[wall.body];
  const Vec3 arm = wall.pose.x - body_defs[wall.body].centre;
  return {b.centre + b.turned * arm, (b.turned * wall.pose.q).normalized()};
}

void FluidState::push_bodies(std::span<const Wrench> impulses) {
  for (size_t b = 0; b < bodies.size(); ++b) {
    const Wrench r = response(b, impulses[b]);
    bodies[b].velocity += r.impulse;
    bodies[b].angular_velocity += r.angular_impulse;
    pushes[b].impulse += impulses[b].impulse;
    pushes[b].angular_impulse += impulses[b].angular_impulse;
  }
}

double FluidState::accelerate() {
  return sum([&](size_t p) {
    const Vec3 before = v[p], after = before + h * acceleration[p];
    v.set(p, after);
    return 0.5 * density[p] * volume[p] * (after - before).dot(after + before);
  });
}

void find_walls(FluidState& s) {
  std::vector<Pose> poses;
  std::vector<Aabb> bounds;
  for (const FluidWall& w : s.walls) {
    poses.push_back(s.wall_pose(w));
    bounds.push_back(w.shape->bounds(poses.back()).inflated(s.kernel.reach()));
  }
  std::vector<std::vector<WallTouch>>& found = s.found_touches;
  std::vector<uint32_t>& counts = s.touch_counts;
  found.resize(chunk_count), counts.resize(s.size());
  for (auto& f : found) f.clear();
  for_chunks(s.crew, s.size(), [&](size_t chunk, size_t first, size_t last) {
    // A few neighbours in memory are neighbours in space, and have few walls about them.
    constexpr size_t together = 32;
    std::vector<uint32_t> near;
    for (size_t begin = first; begin < last; begin += together) {
      if (stop_requested()) return;
      const size_t end = std::min(begin + together, last);
      Aabb box;
      for (size_t p = begin; p < end; ++p) box.include(s.x(p));
      near.clear();
      for (uint32_t w = 0; w < bounds.size(); ++w)
        if (bounds[w].overlaps(box)) near.push_back(w);
      for (size_t p = begin; p < end; ++p) {
        const size_t before = found[chunk].size();
        for (const uint32_t w : near) {
          if (!bounds[w].contains(s.x(p))) continue;
          const auto touch = wall_share(s.kernel, s.spacing, *s.walls[w].shape, poses[w], s.x(p));
          if (touch)
            found[chunk].push_back({w, s.walls[w].body, touch->share, touch->gradient,
                                    touch->distance, touch->normal});
        }
        counts[p] = uint32_t(found[chunk].size() - before);
      }
    }
  });
  s.touches.clear();
  for (const auto& f : found) s.touches.insert(s.touches.end(), f.begin(), f.end());
  s.first_touch.resize(s.size() + 1);
  s.first_touch[0] = 0;
  for (size_t p = 0; p < s.size(); ++p) s.first_touch[p + 1] = s.first_touch[p] + counts[p];
  for (FluidBodyState& b : s.bodies) b.touches = 0;
  for (const WallTouch& t : s.touches) s.bodies[t.body].touches += 1;
}

namespace {

/// What a particle's own pressure does to the bodies beside it, and they to its share: as if every
/// particle that a body touches had its part of the body, so that all together do not push too far
/// (Tonge, Benevolenski and Voroshilov, "Mass splitting for jitter-free parallel rigid body
/// simulation", 2012).
double body_diagonal(const FluidState& s, size_t p, Vec3 WallTouch::*gradient) {
  double sum = 0;
  for (const WallTouch& t : s.touches_of(p)) {
    if (s.body_defs[t.body].inverse_mass == 0) continue;
    const Vec3 arm = s.x(p) - s.bodies[t.body].centre, &along = t.*gradient;
    const Wrench r = s.response(t.body, {along, arm.cross(along)});
    sum += s.bodies[t.body].touches * along.dot(r.impulse + r.angular_impulse.cross(arm));
  }
  return s.volume[p] * sum;
}

}  // namespace

Status find_neighbours(FluidState& s, std::span<const Vec3> x, double skin) {
  const auto made = s.lists.update(
      x, {.reach = s.kernel.reach(), .skin = skin, .box = {}, .by_group = true}, s.crew);
  if (!made) return made.error();
  return {};
}

namespace {

/// Pairs of all particles, and what their sums say of shares.
void find_fluid_pairs(FluidState& s) {
  const bool corrects = s.corrects();
  const FluidMoments moments = corrects ? FluidMoments::found : FluidMoments::left_out;
  s.pairs.make_room(s.lists, s.kernel, s.any(&FluidDef::xsph));
  s.single_volumes.resize(s.lists.places());
  s.single_volumes.back() = {};
  s.each([&](size_t p) {
    s.single_volumes[p] = {float(s.volume[p]), float(s.volume[p] / s.density[p]), 0, 0};
  });
  const FluidPoints points{s.at.data(), s.single_volumes.data()};
  std::array<size_t, chunk_count> pairs{};
  s.each_batch<FluidPairSums>(
      [&](size_t first, size_t end, FluidPairSums* sums) {
        find_pairs(s.kernel, moments, points, s.pairs, first, end, sums);
      },
      [&](size_t chunk, size_t p, const FluidPairSums& sum) {
        pairs[chunk] += sum.pairs;
        s.share[p] = sum.share;
        s.fluid_gradient[p] = s.gradient[p] = {sum.gx, sum.gy, sum.gz};
        s.slopes[p] = sum.slopes;
        s.diagonal[p] = s.volume[p] * sum.squares;
        if (corrects) s.moment[p] = sum.moment, s.square_matrix[p] = sum.square_matrix;
      });
  s.report.pairs = 0;
  for (const size_t n : pairs) s.report.pairs += n;
}

}  // namespace

void find_surroundings(FluidState& s) {
  const size_t n = s.size();
  s.share.resize(n), s.fluid_gradient.resize(n), s.gradient.resize(n), s.slopes.resize(n),
      s.diagonal.resize(n);
  if (s.corrects()) s.moment.resize(n), s.square_matrix.resize(n);
  find_walls(s);
  if (stop_requested()) return;  // touches may be incomplete
  find_fluid_pairs(s);
  s.each([&](size_t p) {
    for (const WallTouch& t : s.touches_of(p)) {
      s.share[p] += t.share;
      s.gradient[p] += t.gradient;
    }
    s.diagonal[p] +=
        s.gradient[p].squaredNorm() / s.density[p] + body_diagonal(s, p, &WallTouch::gradient);
  });
}

namespace {

/// The inverse of a symmetric matrix whose eigenvalues are raised to `least` where they are below:
/// by Jacobi's rotations.
Mat3 raised_inverse(Mat3 a, double least) {
  Mat3 axes = Mat3::Identity();
  for (int sweep = 0; sweep < tolerances::moment_sweeps; ++sweep)
    for (const auto& [i, j] : {std::pair{0, 1}, {0, 2}, {1, 2}}) {
      if (a(i, j) == 0) continue;
      const double theta = (a(j, j) - a(i, i)) / (2 * a(i, j));
      const double t = std::copysign(1 / (std::abs(theta) + std::sqrt(theta * theta + 1)), theta);
      const double c = 1 / std::sqrt(t * t + 1), s = t * c;
      Mat3 turn = Mat3::Identity();
      turn(i, i) = turn(j, j) = c;
      turn(i, j) = s, turn(j, i) = -s;
      a = turn.transpose() * a * turn;
      axes = axes * turn;
    }
  const Vec3 inverse = a.diagonal().cwiseMax(Vec3::Constant(least)).cwiseInverse();
  return axes * inverse.asDiagonal() * axes.transpose();
}

/// Whether all eigenvalues of a symmetric matrix are above `least` (Sylvester's criterion).
bool all_above(const Mat3& a, double least) {
  const double x = a(0, 0) - least, y = a(1, 1) - least, z = a(2, 2) - least;
  const double xy = a(0, 1), xz = a(0, 2), yz = a(1, 2);
  const double minor = x * y - xy * xy;
  return x > 0 && minor > 0 && z * minor - xz * (xz * y - xy * yz) + yz * (xy * xz - x * yz) > 0;
}

/// How steeply a wall closes the share of a particle that comes nearer [1/m]: as a plane through
/// the nearest point, since fluid goes through no wall, however little solid there is behind it.
double barrier(const FluidState& s, const WallTouch& t) {
  return mirrored_plane(s.kernel, s.spacing, t.distance);
}

/// What a body can bear of the layer beside it. Pressures see how it yields to that, which is no
/// symmetric part of their problem: with a layer of mass m, a body of mass M and the lever l the
/// problem is positive as long as l^2 m < 4 (1 + l) M, and iterations converge slowly near there.
double most_lever(const FluidState& s, size_t p, const WallTouch& t) {
  const double inverse = s.body_defs[t.body].inverse_mass;
  if (inverse == 0) return std::numeric_limits<double>::infinity();
  const double layer = s.bodies[t.body].touches * s.density[p] * s.volume[p];
  const double bound = tolerances::lever_mass / (inverse * layer);
  return 0.5 * (bound + std::sqrt(bound * bound + 4 * bound));
}

/// Sum of -V f d d, which is 1 for a fluid without end, and what walls add: next to one a fluid
/// whose velocity is linear does not go through it, and closes its share by that velocity over the
/// distance.
Mat3 moment_with_walls(const FluidState& s, size_t p) {
  Mat3 sum = s.moment[p];
  for (const WallTouch& t : s.touches_of(p))
    if (t.distance > 0) sum += t.distance * barrier(s, t) * t.normal * t.normal.transpose();
  return sum;
}

}  // namespace

void find_corrections(FluidState& s) {
  const size_t n = s.size();
  s.correction.resize(n), s.corrected_diagonal.resize(n);
  s.each([&](size_t p) {
    const Mat3 moment = moment_with_walls(s, p);
    const double least = tolerances::least_moment;
    const Mat3 correction =
        all_above(moment, least) ? Mat3(moment.inverse()) : raised_inverse(moment, least);
    Vec3 gradient = correction * s.fluid_gradient[p];
    for (size_t k = s.first_touch[p]; k < s.first_touch[p + 1]; ++k) {
      WallTouch& t = s.touches[k];
      const double steep = barrier(s, t) * t.normal.dot(correction * t.normal);
      t.corrected = -steep * t.normal;
      // Where pressure is linear, it is greater or less at the wall than at the particle by what
      // its gradient makes of the distance. That gradient is the acceleration by pressures, of
      // which the wall so gives a part.
      const double part = std::clamp(t.distance * steep, 0.0, tolerances::most_levered);
      t.lever = std::min(part / (1 - part), most_lever(s, p, t));
      gradient += t.corrected;
    }
    s.correction[p] = correction;
    const double squares = correction.cwiseProduct(correction * s.square_matrix[p]).sum();
    double own = gradient.squaredNorm();
    for (const WallTouch& t : s.touches_of(p)) {
      const double along = t.normal.dot(gradient);
      own += t.lever * along * along;
    }
    s.corrected_diagonal[p] =
        own / s.density[p] + s.volume[p] * squares + body_diagonal(s, p, &WallTouch::corrected);
  });
}

void move_bodies(FluidState& s) {
  for (FluidBodyState& b : s.bodies) {
    b.centre += s.h * b.velocity;
    b.turned = integrate_rotation(b.turned, b.angular_velocity, s.h);
  }
}

void keep_clear_of_walls(FluidState& s) {
  const double clear = tolerances::wall_clearance * s.spacing;
  double work = 0;
  for (size_t p = 0; p < s.size(); ++p)
    for (const WallTouch& t : s.touches_of(p)) {
      FluidBodyState& b = s.bodies[t.body];
      const Vec3 at = s.x(p);
      const double room = t.distance - clear;
      // What is too near already goes slowly, what comes near stops there.
      const double least = room < 0 ? -tolerances::wall_return * room / s.h : -room / s.h;
      const double speed = (s.v[p] - b.velocity_at(at)).dot(t.normal);
      if (speed >= least) continue;
      const double mass = s.density[p] * s.volume[p];
      const Vec3 arm = at - b.centre;
      const Wrench r = s.response(t.body, {t.normal, arm.cross(t.normal)});
      const double yielding = t.normal.dot(r.impulse + r.angular_impulse.cross(arm));
      const double push = (least - speed) / (1 / mass + yielding);
      const Vec3 impulse = push * t.normal;
      const Vec3 before = s.v[p], after = before + impulse / mass;
      s.v.set(p, after);
      work += 0.5 * impulse.dot(before + after);
      b.velocity -= push * r.impulse;
      b.angular_velocity -= push * r.angular_impulse;
      s.add_force(s.pushes, t.body, at, -impulse);
    }
  s.report.pressure_work += work;
}

}  // namespace tumble
