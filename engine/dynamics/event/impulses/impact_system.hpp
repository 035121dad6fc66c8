#pragma once
#include "engine/dynamics/event/impulses/impact_law.hpp"
#include "engine/dynamics/event/impulses/point_mobility.hpp"
#include "engine/dynamics/event/tolerances.hpp"
#include "engine/math/dense.hpp"

#include <array>
#include <vector>

#include <Eigen/Core>

namespace tumble {

/// A collision in the space of its impulses: three unknowns per point (normal, two tangents), the
/// relative velocities u = u0 + A z. Shared by all laws.
class ImpactSystem {
 public:
  /// The blocks, the points and the joints must live as long, the masses stay.
  ImpactSystem(std::span<const DofBlock> blocks, std::span<const ImpactPoint> points,
               const Articulation& joints);

  int points() const { return int(points_.size()); }
  const ImpactPoint& point(int i) const { return points_[size_t(i)]; }
  bool finite() const;
  double normal_velocity(int i) const { return u_[3 * i]; }
  Vec3 velocity(int i) const { return small_vector(u_.segment<3>(3 * i)); }
  /// How a point answers to its own impulse; and all to all.
  const Mat3& mobility(int i) const { return A_.own(i); }
  const PointMobility& mobility() const { return A_; }
  /// The fastest relative velocity at the beginning [m/s].
  double first_speed() const { return first_speed_; }
  /// Slower approach than this is none.
  double rest_speed() const { return tolerances::rest_of_fastest * first_speed_; }
  bool approaching(int i) const { return normal_velocity(i) < -rest_speed(); }

  /// Impulse at one point, in its frame.
  void add(int i, const Vec3& impulse);
  void add(const Eigen::VectorXd& impulse);

  /// Impulses of the points of `active` (others zero) that leave u_n >= target_i where z_n = 0 and
  /// u_n = target_i where z_n > 0, with friction in Coulomb's cone against the velocity that is
  /// left. False, with the report's status set, when there is no believable answer.
  bool solve(std::span<const int> active, const Eigen::VectorXd& target, Eigen::VectorXd& impulse,
             ImpactReport& report) const;
  /// solve() with every approaching point of `active` leaving at restitution times its approach,
  /// scaled towards no restitution as far as energy would grow.
  bool rebound(std::span<const int> active, Eigen::VectorXd& impulse, ImpactReport& report) const;

  /// Friction for given normal impulses: the tangential impulses within the discs of radius
  /// friction times `impulse`'s normal parts that leave the least kinetic energy, written into
  /// `impulse`. By projected Gauss-Seidel steps to 1e-13.
  void add_friction(Eigen::VectorXd& impulse, ImpactReport& report) const;
  /// The largest share in [0, 1] of `more` after `first` with which the two take energy together;
  /// notes it in the report.
  double harmless_share(const Eigen::VectorXd& first, const Eigen::VectorXd& more,
                        ImpactReport& report) const;

  /// Work of a further impulse [J].
  double work(const Eigen::VectorXd& impulse) const;

  /// Writes the impulses so far to the blocks, and what the report says by point.
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
