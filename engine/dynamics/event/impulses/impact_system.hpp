#pragma once
#include "engine/dynamics/event/impulses/impact_law.hpp"
#include "engine/dynamics/event/impulses/point_mobility.hpp"
#include "engine/dynamics/event/tolerances.hpp"
#include "engine/math/dense.hpp"

#include <array>
#include <vector>

#include <Eigen/Core>

namespace tumble {

/// A collision in terms of its impulses z: three unknowns per point (normal and two tangents), with
/// relative velocities u = u0 + A z. Shared by all laws.
class ImpactSystem {
 public:
  /// The blocks, points and joints must outlive this; masses must not change.
  ImpactSystem(std::span<const DofBlock> blocks, std::span<const ImpactPoint> points,
               const Articulation& joints);

  int points() const { return int(points_.size()); }
  const ImpactPoint& point(int i) const { return points_[size_t(i)]; }
  bool finite() const;
  double normal_velocity(int i) const { return u_[3 * i]; }
  Vec3 velocity(int i) const { return small_vector(u_.segment<3>(3 * i)); }
  /// The mobility of a point: its velocity change by an impulse on itself; and the whole matrix.
  const Mat3& mobility(int i) const { return A_.own(i); }
  const PointMobility& mobility() const { return A_; }
  /// Greatest relative velocity component at the beginning [m/s].
  double first_speed() const { return first_speed_; }
  /// Approach slower than this counts as none [m/s].
  double rest_speed() const { return tolerances::rest_of_fastest * first_speed_; }
  bool approaching(int i) const { return normal_velocity(i) < -rest_speed(); }

  /// Applies an impulse at one point, in the point's frame.
  void add(int i, const Vec3& impulse);
  void add(const Eigen::VectorXd& impulse);

  /// Finds impulses of the points in `active` (all others zero) with u_n >= target_i where z_n = 0
  /// and u_n = target_i where z_n > 0, and friction in Coulomb's cone opposing the slip afterwards.
  /// False, with the report's status set, if there is no acceptable solution.
  bool solve(std::span<const int> active, const Eigen::VectorXd& target, Eigen::VectorXd& impulse,
             ImpactReport& report) const;
  /// solve() with every approaching point of `active` rebounding at restitution times its approach;
  /// restitution is scaled down as far as energy would grow otherwise.
  bool rebound(std::span<const int> active, Eigen::VectorXd& impulse, ImpactReport& report) const;

  /// Friction for given normal impulses: tangential impulses, within discs of radius friction times
  /// the normal part of `impulse`, that minimise the kinetic energy; written into `impulse`.
  /// Projected Gauss-Seidel sweeps to 1e-13.
  void add_friction(Eigen::VectorXd& impulse, ImpactReport& report) const;
  /// The largest share s in [0, 1] for which `first` + s `more` does not increase the energy; a
  /// share below 1 is noted in the report.
  double harmless_share(const Eigen::VectorXd& first, const Eigen::VectorXd& more,
                        ImpactReport& report) const;

  /// Work of a further impulse [J].
  double work(const Eigen::VectorXd& impulse) const;

  /// Applies the sum of all impulses to the blocks, and fills in the report by point.
  void finish(std::span<DofBlock> blocks, ImpactReport& report) const;

 private:
  struct Unknowns;
  void add_limit(const Row& along);
  void set_conditions(std::span<const int> active, const Eigen::VectorXd& target,
                      Unknowns& out) const;
  void set_matrices(Unknowns& unknowns) const;
  void add_joint_rows(std::vector<Row>& rows, lcp::LcpProblem& problem) const;

  std::span<const DofBlock> blocks_;
  std::span<const ImpactPoint> points_;
  const Articulation* joints_;
  std::vector<Row> rows_;
  std::vector<std::array<Vec3, 3>> frames_;
  PointMobility A_;
  Eigen::VectorXd u0_, u_, z_;
  double first_speed_ = 0;
};

}  // namespace tumble
