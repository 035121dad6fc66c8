#include "engine/dynamics/realtime/hits.hpp"

#include "engine/dynamics/realtime/integrate_bodies.hpp"
#include "engine/dynamics/realtime/joint_lines.hpp"
#include "engine/dynamics/realtime/tolerances.hpp"
#include "engine/math/block_ldl.hpp"
#include "engine/math/lcp/cones/solve_cones.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

namespace tumble {
namespace {

using Line = CoupledJoints::Line;

bool moves(const SolverIsland& island, uint32_t body) {
  return island.bodies[body].inverse_mass > 0;
}

/// The rows by which joints transmit an impact, joint by joint, then couplings: K = J M^-1 J^T + C
/// in sparse blocks, which are eliminated in the order of trees. C is the compliance of armatures.
class Transmission {
 public:
  explicit Transmission(const SolverIsland& island) : island_(island) {
    for (const JointBlock& joint : island.joints) add_joint(joint);
    for (const CoupledJoints& all : island.coupled)
      for (size_t k = 0; k < all.couplings.size(); ++k) {
        add(all.lines[all.kept - all.couplings.size() + k], 0);
        end_block();
      }
    lay_out();
  }

  size_t size() const { return lines_.size(); }
  /// The impulses of rows that leave their velocities as they were when one unit acts along `line`.
  void answer(const Line& line, std::span<double> out) const {
    std::ranges::fill(out, 0);
    for (uint32_t end = 0; end < line.ends; ++end)
      for (const uint32_t block : blocks_at_[line.body[end]])
        for (uint32_t i = first_[block]; i < first_[block + 1]; ++i)
          out[i] = -line_product(island_, lines_[i], line);
    factor_.solve(out);
  }
  /// The change of speed along `line` by such impulses.
  double speed(const Line& line, std::span<const double> impulses) const {
    double sum = 0;
    seen_.assign(first_.size(), 0);
    for (uint32_t end = 0; end < line.ends; ++end)
      for (const uint32_t block : blocks_at_[line.body[end]]) {
        if (std::exchange(seen_[block], 1)) continue;
        for (uint32_t i = first_[block]; i < first_[block + 1]; ++i)
          sum += impulses[i] * line_product(island_, lines_[i], line);
      }
    return sum;
  }
  /// Applies impulses, and books them where joints keep theirs.
  void apply(std::span<const double> impulses) const {
    for (size_t i = 0; i < lines_.size(); ++i) push_line(island_, lines_[i], impulses[i]);
    uint32_t block = 0;
    for (JointBlock& joint : island_.joints) book(joint, impulses.subspan(first_[block++]));
    for (CoupledJoints& all : island_.coupled)
      for (const CouplingBlock& c : all.couplings) book(c, impulses[first_[block++]]);
  }

 private:
  void add_joint(const JointBlock& joint) {
    const auto add_row = [&](uint32_t row, double give) {
      Line line;
      add_ends(line, joint.a, joint.b, joint.lines[row]);
      add(line, give);
    };
    for (uint32_t i = 0; i < joint.kept; ++i) add_row(i, 0);
    const std::span<const DriveRow> drives = drives_of(island_, joint);
    for (uint32_t k = 0; k < drives.size(); ++k)
      if (const double armature = drives[k].drive->armature; armature > 0)
        add_row(joint.kept + k, 1 / armature);
    end_block();
  }
  void add(const Line& line, double give) {
    lines_.push_back(line);
    gives_.push_back(give);
  }
  void end_block() { first_.push_back(uint32_t(lines_.size())); }

  void lay_out() {
    const auto blocks = uint32_t(first_.size() - 1);
    blocks_at_.resize(island_.bodies.size());
    std::vector<uint32_t> sizes;
    for (uint32_t block = 0; block < blocks; ++block) {
      sizes.push_back(first_[block + 1] - first_[block]);
      for (uint32_t i = first_[block]; i < first_[block + 1]; ++i)
        for (uint32_t end = 0; end < lines_[i].ends; ++end) {
          const uint32_t body = lines_[i].body[end];
          std::vector<uint32_t>& at = blocks_at_[body];
          if (moves(island_, body) && (at.empty() || at.back() != block)) at.push_back(block);
        }
    }
    std::vector<std::pair<uint32_t, uint32_t>> coupled;
    for (const std::vector<uint32_t>& at : blocks_at_)
      for (size_t i = 0; i < at.size(); ++i)
        for (size_t k = 0; k < i; ++k) coupled.emplace_back(at[i], at[k]);
    std::ranges::sort(coupled);
    coupled.erase(std::unique(coupled.begin(), coupled.end()), coupled.end());
    factor_ = BlockLdl(sizes, coupled);
    for (uint32_t block = 0; block < blocks; ++block) fill(block, block);
    for (const auto& [i, k] : coupled) fill(i, k);
    for (uint32_t block = 0; block < blocks; ++block)
      for (uint32_t i = 0; i < sizes[block]; ++i)
        factor_.add(block, i, block, i, gives_[first_[block] + i]);
    factor_.factor();
  }
  void fill(uint32_t i, uint32_t k) {
    for (uint32_t r = first_[i]; r < first_[i + 1]; ++r)
      for (uint32_t c = first_[k]; c < first_[k + 1]; ++c)
        factor_.add(i, r - first_[i], k, c - first_[k],
                    line_product(island_, lines_[r], lines_[c]));
  }

  void book(JointBlock& joint, std::span<const double> impulses) const {
    JointPush push;
    for (uint32_t i = 0; i < joint.kept; ++i) push.add(push_of(joint.lines[i], impulses[i]));
    uint32_t next = joint.kept;
    const std::span<const DriveRow> drives = drives_of(island_, joint);
    for (uint32_t k = 0; k < drives.size(); ++k)
      if (drives[k].drive->armature > 0)
        push.add(push_of(joint.lines[joint.kept + k], impulses[next++]));
    joint.add(push);
  }
  void book(const CouplingBlock& c, double impulse) const {
    for (size_t half = 0; half < 2; ++half)
      if (c.block[half] != CouplingBlock::none)
        island_.joints[c.block[half]].add(push_of(c.lines[half], impulse));
  }

  const SolverIsland& island_;
  std::vector<Line> lines_;
  std::vector<double> gives_;
  std::vector<uint32_t> first_{0};                ///< row by block
  std::vector<std::vector<uint32_t>> blocks_at_;  ///< by body, of those that move
  mutable std::vector<uint8_t> seen_;             ///< by block
  BlockLdl factor_;
};

/// A contact point that takes part in an impact.
struct Candidate {
  const ContactRow* row;
  PointRow* point;
  double least;  ///< speed along the normal after the impact [m/s]
  bool hit;
};

/// What acts along a coordinate by steps takes part like a contact: hard limits, motors that hold a
/// rate, friction.
struct Hold {
  JointBlock* joint;
  uint32_t row;
  DriveRow* drive;
  DriveRow::Cause cause;
  double target;       ///< speed after the impact, or the least (lower) or greatest (upper)
  double least, most;  ///< impulse
  double rate;         ///< that a motor is to hold
};

double line_velocity(const BodyVelocity& a, const BodyVelocity& b, const JointBlock::Line& row) {
  return row.linear.dot(b.v - a.v) + row.angular_a.dot(a.omega) + row.angular_b.dot(b.omega);
}

/// A coordinate before a pass, where it has the speed `speed`, of which forces have just brought
/// `brought`; `start` is the impulse with which the pass starts.
struct HeldCoordinate {
  double speed, brought, start;
};

/// Adds the holds of one coordinate.
void add_holds(const HeldCoordinate& at, double hs, JointPass pass, Hold hold,
               std::vector<Hold>& out) {
  const DriveRow& d = *hold.drive;
  const CoordinateLimits& limits = d.drive->limits;
  const CoordinateMotor& motor = d.drive->motor;
  const auto add = [&](DriveRow::Cause cause, double target, double least, double most) {
    hold.cause = cause, hold.target = target, hold.least = least, hold.most = most;
    out.push_back(hold);
  };
  double lowest = -no_bound, highest = no_bound;
  // A limit that bounces does so by itself, with the speed that the hit leaves.
  if (limits.hard() && !d.limits_bounce()) {
    if (limits.lower > -no_bound) {
      lowest = std::min(at.speed, -std::max(d.value - limits.lower, 0.0) / hs);
      add(DriveRow::lower, lowest, 0, no_bound);
    }
    if (limits.upper < no_bound) {
      highest = std::max(at.speed, std::max(limits.upper - d.value, 0.0) / hs);
      add(DriveRow::upper, highest, -no_bound, 0);
    }
  }
  // What forces bring about, and what the impulse of the pass would be without the hit, is left to
  // the pass: a motor that pulls with all of its force anyway adds nothing.
  const auto add_step = [&](DriveRow::Cause cause, double rate, double force) {
    const double bound = 0.5 * hs * force, missing = rate + at.brought - at.speed;
    const double guess = at.start + (d.mass > 0 ? missing / d.mass : 0);
    const double without = std::clamp(guess, -bound, bound);
    const double target = rate + at.brought;
    hold.rate = rate;
    add(cause, bound == no_bound ? std::clamp(target, lowest, highest) : target, -bound - without,
        bound - without);
  };
  if (motor.kind == MotorKind::velocity)
    add_step(DriveRow::motor, d.target_rate(pass, hs), motor.max_force);
  if (d.drive->friction > 0) add_step(DriveRow::friction, 0, d.drive->friction);
}

/// Those of all coordinates; forces have just changed the velocity of a body by gained(body).
template <class G>
std::vector<Hold> holds_of(const SolverIsland& island, double hs, JointPass pass, const G& gained) {
  std::vector<Hold> out;
  for (JointBlock& joint : island.joints) {
    const std::span<DriveRow> drives = drives_of(island, joint);
    for (uint32_t k = 0; k < drives.size(); ++k) {
      const uint32_t row = joint.kept + k;
      const JointBlock::Line& line = joint.lines[row];
      const HeldCoordinate at{line_velocity(island.bodies[joint.a], island.bodies[joint.b], line),
                              line_velocity(gained(joint.a), gained(joint.b), line),
                              joint.total(row, pass)};
      add_holds(at, hs, pass, {&joint, row, &drives[k], DriveRow::other, 0, 0, 0, 0}, out);
    }
  }
  return out;
}

/// The impact as a problem of the contact points and holds alone: speeds along the axes of points
/// (n, t1, t2 for each), then along coordinates, and W = J M^-1 J^T for the bodies with their
/// joints.
class Impact {
 public:
  Impact(const SolverIsland& island, std::span<const Candidate> points, std::span<const Hold> holds)
      : island_(island), points_(points), holds_(holds), joints_(island) {
    for (const Candidate& c : points_)
      for (const Vec3& axis : {c.row->n, c.row->t1, c.row->t2}) {
        Line& line = lines_.emplace_back();
        add_end(line, c.row->a, -axis, -c.point->ra.cross(axis));
        add_end(line, c.row->b, axis, c.point->rb.cross(axis));
      }
    for (const Hold& hold : holds_)
      add_ends(lines_.emplace_back(), hold.joint->a, hold.joint->b, hold.joint->lines[hold.row]);
    for (const Line& line : lines_) before_.push_back(line_velocity(island, line));
    set_compliances();
  }

  /// Returns whether there is an answer.
  bool solve() {
    lcp::ConeTask task;
    lcp::LcpProblem& p = task.problem;
    p = lcp::LcpProblem::plain(std::move(W_), lcp::VecX::Zero(Eigen::Index(lines_.size())));
    for (size_t k = 0; k < points_.size(); ++k) {
      const ContactRow& row = *points_[k].row;
      const auto n = Eigen::Index(3 * k);
      p.b[n] = before_[3 * k] - points_[k].least;
      p.b[n + 1] = before_[3 * k + 1] - row.target1;
      p.b[n + 2] = before_[3 * k + 2] - row.target2;
      if (row.friction > 0) p.add_group(int(n), row.friction);
      for (const Eigen::Index i : {n + 1, n + 2}) {
        p.upper[i] = row.friction > 0 ? no_bound : 0;
        p.lower[i] = -p.upper[i];
      }
    }
    for (size_t k = 0; k < holds_.size(); ++k) {
      const size_t i = 3 * points_.size() + k;
      p.b[Eigen::Index(i)] = before_[i] - holds_[k].target;
      p.lower[Eigen::Index(i)] = holds_[k].least;
      p.upper[Eigen::Index(i)] = holds_[k].most;
    }
    // What joints lock cannot change.
    for (Eigen::Index i = 0; i < p.size(); ++i)
      if (p.A(i, i) == 0) p.b[i] = 0;
    task.believable = tolerances::bounce_error;
    const lcp::ConeAnswer answer = lcp::solve_cones(task);
    if (!answer.found) return false;
    impulses_.assign(answer.solution.z.data(), answer.solution.z.data() + p.size());
    return true;
  }

  /// Applies the impulses; returns the energy that contacts with restitution and holds took [J].
  double apply() const {
    // The work of a limit in both passes is reckoned from the speed before the first of them, to
    // which this change does not belong.
    for_drives([](DriveRow& d, double speed) { d.entered -= speed; });
    std::vector<double> of_joints(joints_.size());
    for (size_t i = 0; i < lines_.size(); ++i) {
      push_line(island_, lines_[i], impulses_[i]);
      for (size_t k = 0; k < of_joints.size(); ++k)
        of_joints[k] += impulses_[i] * answers_[i * joints_.size() + k];
    }
    joints_.apply(of_joints);
    double taken = 0;
    for (size_t k = 0; k < points_.size(); ++k) {
      PointRow& p = *points_[k].point;
      p.normal_sum += impulses_[3 * k];
      p.tangent1_sum += impulses_[3 * k + 1];
      p.tangent2_sum += impulses_[3 * k + 2];
      if (p.bounce > 0) taken -= work(3 * k);
    }
    for (size_t k = 0; k < holds_.size(); ++k) {
      const Hold& hold = holds_[k];
      const size_t i = 3 * points_.size() + k;
      const double impulse = impulses_[i];
      hold.joint->add(push_of(hold.joint->lines[hold.row], impulse));
      hold.drive->add_hit(hold.cause, impulse, work(i));
      // A motor that holds its rate takes energy from the motion relative to that.
      if (hold.cause != DriveRow::motor)
        taken -= work(i);
      else if (hold.least < impulse && impulse < hold.most)
        taken -= work(i) - impulse * hold.rate;
    }
    // Armatures follow.
    for_drives([](DriveRow& d, double speed) {
      d.v = speed;
      d.entered += speed;
    });
    return taken;
  }

 private:
  /// Calls f(drive, the speed along its coordinate).
  template <class F>
  void for_drives(const F& f) const {
    for (const JointBlock& joint : island_.joints) {
      const std::span<DriveRow> drives = drives_of(island_, joint);
      for (uint32_t k = 0; k < drives.size(); ++k)
        f(drives[k], line_velocity(island_.bodies[joint.a], island_.bodies[joint.b],
                                   joint.lines[joint.kept + k]));
    }
  }
  void set_compliances() {
    const size_t n = lines_.size(), m = joints_.size();
    answers_.resize(n * m);
    W_.resize(Eigen::Index(n), Eigen::Index(n));
    std::vector<uint8_t> locked(n);
    for (size_t k = 0; k < n; ++k) {
      const std::span answer = std::span(answers_).subspan(k * m, m);
      joints_.answer(lines_[k], answer);
      for (size_t i = 0; i <= k; ++i)
        W_(Eigen::Index(i), Eigen::Index(k)) = W_(Eigen::Index(k), Eigen::Index(i)) =
            line_product(island_, lines_[i], lines_[k]) + joints_.speed(lines_[i], answer);
      // What joints lock completely, rounding would move.
      const double alone = line_product(island_, lines_[k], lines_[k]);
      locked[k] = !(W_(Eigen::Index(k), Eigen::Index(k)) > tolerances::dependent_row * alone);
    }
    for (size_t k = 0; k < n; ++k)
      if (locked[k]) {
        W_.row(Eigen::Index(k)).setZero();
        W_.col(Eigen::Index(k)).setZero();
      }
  }
  double work(size_t row) const {
    return 0.5 * impulses_[row] * (before_[row] + line_velocity(island_, lines_[row]));
  }

  const SolverIsland& island_;
  std::span<const Candidate> points_;
  std::span<const Hold> holds_;
  Transmission joints_;
  std::vector<Line> lines_;
  std::vector<double> answers_;  ///< of joints, line by line
  lcp::MatX W_;
  std::vector<double> before_, impulses_;  ///< by line
};

/// Calls f(row, index of the point, its gap, its approach speed).
template <class F>
void for_points(const SolverIsland& island, const F& f) {
  for (const ContactRow& row : island.rows) {
    const SolverBody &a = island.bodies[row.a], &b = island.bodies[row.b];
    for (uint32_t i = row.first; i < row.first + row.count; ++i) {
      const PointRow& p = island.points[i];
      const double approach = -row.n.dot(b.v + b.w.cross(p.rb) - a.v - a.w.cross(p.ra));
      f(row, i, gap_of(island, row, p), approach);
    }
  }
}

bool takes_hits(const SolverIsland& island) {
  return !island.joints.empty() && island.joints.size() <= tolerances::most_joints_of_hit;
}

/// If there are too many points, keeps those that are hit, then those of bodies that are hit.
void keep_nearest(const SolverIsland& island, std::vector<Candidate>& points) {
  if (points.size() <= tolerances::most_points_of_hit) return;
  std::vector<uint8_t> struck(island.bodies.size());
  for (const Candidate& c : points)
    if (c.hit) struck[c.row->a] = struck[c.row->b] = 1;
  const auto of_struck = [&](uint32_t body) { return struck[body] && moves(island, body); };
  std::ranges::stable_sort(points, {}, [&](const Candidate& c) {
    return c.hit ? 0 : of_struck(c.row->a) || of_struck(c.row->b) ? 1 : 2;
  });
  points.resize(tolerances::most_points_of_hit);
}

/// Solves the impact before a pass at these points, of which there are some.
template <class G>
double solve_hit(const SolverIsland& island, double hs, JointPass pass, const HitPoints& hits,
                 const G& gained) {
  std::vector<Candidate> candidates;
  double fastest = 0;
  for_points(island, [&](const ContactRow& row, uint32_t i, double gap, double approach) {
    const double touching = std::max(gap, 0.0) / hs;
    if (!(approach > touching) && !(island.points[i].normal > 0)) return;
    // Points that are not hit press on: what forces bring about there, the passes solve.
    const bool hit = std::ranges::binary_search(hits, i);
    if (hit) fastest = std::max(fastest, approach);
    candidates.push_back(
        {&row, &island.points[i], -(hit ? touching : std::max(touching, approach)), hit});
  });
  if (!(fastest > 0)) return 0;
  keep_nearest(island, candidates);
  const std::vector<Hold> holds = holds_of(island, hs, pass, gained);
  Impact impact(island, candidates, holds);
  return impact.solve() ? impact.apply() : 0;
}

}  // namespace

double hit_before_motion(const SolverContext& c, const SolverIsland& island, double hs,
                         HitPoints& points) {
  points.clear();
  if (!takes_hits(island)) return 0;
  const auto gained = [&](uint32_t body) { return gained_velocity(c, island, body, island.kick); };
  for_points(island, [&](const ContactRow& row, uint32_t i, double gap, double approach) {
    const PointRow& p = island.points[i];
    // What bounces is left to restitution, which spreads it at the end of the tick.
    if (p.bounce > 0) return;
    const BodyVelocity a = gained(row.a), b = gained(row.b);
    const double by_forces = row.n.dot(b.v + b.omega.cross(p.rb) - a.v - a.omega.cross(p.ra));
    const double explained = tolerances::limit_rest_speed + 2 * std::fabs(by_forces);
    // After the motion, points may approach by no more than their gap in the next sub-step.
    if (approach > explained && 2 * hs * approach > gap) points.push_back(i);
  });
  if (points.empty()) return 0;
  std::ranges::sort(points);
  return solve_hit(island, hs, JointPass::moving, points, gained);
}

double hit_after_motion(const SolverIsland& island, double hs, const HitPoints& points) {
  if (points.empty()) return 0;
  return solve_hit(island, hs, JointPass::relaxing, points,
                   [](uint32_t) { return BodyVelocity{}; });
}

}  // namespace tumble
