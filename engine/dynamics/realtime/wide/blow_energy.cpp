// Limits the energy of impacts to what was taken, in each ordinary island by itself, as
// solve_island does for a precise one.
#include "engine/dynamics/realtime/blows.hpp"
#include "engine/dynamics/realtime/wide/lane_values.hpp"
#include "engine/dynamics/realtime/wide/wide_island.hpp"

#include <algorithm>

namespace tumble {

double WideIsland::normal_speed(const BlowBooks::Point& p) const {
  const WideContact& c = rows_.contacts[p.contact];
  const WidePoint& at = rows_.points[p.point];
  const WideBody &a = rows_.bodies[c.a[p.lane]], &b = rows_.bodies[c.b[p.lane]];
  const Vec3 slip = doubles_of(b.v) + doubles_of(b.w).cross(doubles_of(at.rb, p.lane)) -
                    doubles_of(a.v) - doubles_of(a.w).cross(doubles_of(at.ra, p.lane));
  return doubles_of(c.n, p.lane).dot(slip);
}

std::array<double, 5> WideIsland::row_speeds(const BlowBooks::Joint& of) const {
  const WideJoint& j = rows_.joints[of.joint];
  const WideBody &a = rows_.bodies[j.a[of.lane]], &b = rows_.bodies[j.b[of.lane]];
  const Vec3 wa = doubles_of(a.w), wb = doubles_of(b.w);
  const Vec3 slip = doubles_of(b.v) + wb.cross(doubles_of(j.rb, of.lane)) - doubles_of(a.v) -
                    wa.cross(doubles_of(j.ra, of.lane));
  std::array<double, 5> out{slip.x(), slip.y(), slip.z()};
  if (j.hinge == WideJoint::no_hinge) return out;
  for (size_t k = 0; k < 2; ++k)
    out[3 + k] = doubles_of(rows_.hinges[j.hinge].turn[k], of.lane).dot(wb - wa);
  return out;
}

size_t WideIsland::rows_of(const BlowBooks::Joint& of) const {
  return rows_.joints[of.joint].hinge == WideJoint::no_hinge ? 3 : 5;
}
float& WideIsland::row_impulse(const BlowBooks::Joint& of, size_t row, JointPass pass) {
  WideJoint& j = rows_.joints[of.joint];
  return row < 3 ? impulses(j, pass)[row][of.lane]
                 : impulses(rows_.hinges[j.hinge], pass)[row - 3][of.lane];
}

/// Lists the points that bounce in this tick, and the joints that they shake.
void WideIsland::open_blow_books() {
  books_.points.clear();
  books_.joints.clear();
  books_.open = false;
  if (sort_ != WideSort::jointed_bouncing) return;
  with_rest([&](const SolverIsland&) {
    for (Part& part : parts_) part.bounces = bounces(rest_of(part));
  });
  for (uint32_t i = 0; i < rows_.contacts.size(); ++i) {
    const WideContact& c = rows_.contacts[i];
    if (!c.bounces) continue;
    for (uint32_t lane = 0; lane < c.lanes; ++lane)
      for (uint32_t k = c.first; k < c.first + c.counts[lane]; ++k) {
        if (!(rows_.points[k].bounce[lane] > 0)) continue;
        books_.points.push_back({i, k, lane, part_of(c.a[lane], c.b[lane])});
        parts_[books_.points.back().part].bounces = true;
      }
  }
  for (uint32_t i = 0; i < rows_.joints.size(); ++i) {
    const WideJoint& j = rows_.joints[i];
    for (uint32_t lane = 0; lane < j.lanes; ++lane) {
      const uint32_t part = part_of(j.a[lane], j.b[lane]);
      if (parts_[part].bounces) books_.joints.push_back({i, lane, part});
    }
  }
  books_.open = std::ranges::any_of(parts_, &Part::bounces);
}

/// As note_speeds and note_joint_speeds.
void WideIsland::note_blow_speeds(double share) {
  for (BlowBooks::Point& p : books_.points) {
    p.speed = normal_speed(p);
    p.normal = share * double(rows_.points[p.point].normal[p.lane]);
  }
  for (BlowBooks::Joint& j : books_.joints) j.speeds = row_speeds(j);
  with_rest([&](const SolverIsland&) {
    for (const Part& part : parts_) {
      if (!part.bounces) continue;
      note_speeds(rest_of(part), share);
      note_joint_speeds(rest_of(part));
    }
  });
}

/// As taken_by_contacts and taken_by_joints.
void WideIsland::add_taken(JointPass pass) {
  for (const BlowBooks::Point& p : books_.points)
    parts_[p.part].taken -= 0.5 * (double(rows_.points[p.point].normal[p.lane]) - p.normal) *
                            (p.speed + normal_speed(p));
  for (const BlowBooks::Joint& j : books_.joints) {
    const std::array<double, 5> speeds = row_speeds(j);
    for (size_t row = 0; row < rows_of(j); ++row) {
      double impulse = double(row_impulse(j, row, pass));
      if (pass == JointPass::moving) impulse += double(row_impulse(j, row, JointPass::correcting));
      parts_[j.part].taken -= 0.5 * impulse * (j.speeds[row] + speeds[row]);
    }
  }
  with_rest([&](const SolverIsland&) {
    for (Part& part : parts_)
      if (part.bounces)
        part.taken += taken_by_contacts(rest_of(part)) + taken_by_joints(rest_of(part), pass);
  });
}

void WideIsland::remember_before_blow() {
  note_blow_speeds(1);
  for (BlowBooks::Joint& j : books_.joints)
    for (size_t row = 0; row < rows_of(j); ++row)
      j.relaxing[row] = row_impulse(j, row, JointPass::relaxing);
  books_.bodies = rows_.bodies;
  for (const Part& part : parts_)
    if (part.bounces) remember_relaxing(rest_of(part));
}

/// Reduces the impact of each island to the share that its energy allows.
void WideIsland::bound_blows() {
  std::vector<BlowEnergy> energies(parts_.size());
  for (const BlowBooks::Point& p : books_.points) {
    const double rebound = double(rows_.rebounds[p.point][p.lane]);
    energies[p.part].linear += rebound * p.speed;
    energies[p.part].square += 0.5 * rebound * (normal_speed(p) - p.speed);
  }
  for (const BlowBooks::Joint& j : books_.joints) {
    const std::array<double, 5> speeds = row_speeds(j);
    for (size_t row = 0; row < rows_of(j); ++row) {
      const double impulse =
          double(row_impulse(j, row, JointPass::relaxing)) - double(j.relaxing[row]);
      energies[j.part].linear += impulse * j.speeds[row];
      energies[j.part].square += 0.5 * impulse * (speeds[row] - j.speeds[row]);
    }
  }
  with_rest([&](const SolverIsland&) {
    for (size_t k = 0; k < parts_.size(); ++k) {
      if (!parts_[k].bounces) continue;
      const BlowEnergy more = blow_energy(rest_of(parts_[k]));
      energies[k].linear += more.linear;
      energies[k].square += more.square;
    }
  });
  for (size_t k = 0; k < parts_.size(); ++k) {
    Part& part = parts_[k];
    part.share = part.bounces ? energies[k].bearable_share(part.taken) : 1;
    if (part.share < 1) scale_impulses(rest_of(part), part.share);
  }
  scale_blows();
}

/// Applies the shares.
void WideIsland::scale_blows() {
  const auto scaled = [](float now, float before, double share) {
    return before + float(share) * (now - before);
  };
  for (size_t k = 0; k < islands_.size(); ++k) {
    if (islands_[k] >= parts_.size() || !(parts_[islands_[k]].share < 1)) continue;
    const double share = parts_[islands_[k]].share;
    WideBody& body = rows_.bodies[k];
    for (size_t i = 0; i < 3; ++i) {
      body.v[i] = scaled(body.v[i], books_.bodies[k].v[i], share);
      body.w[i] = scaled(body.w[i], books_.bodies[k].w[i], share);
    }
  }
  for (const BlowBooks::Point& p : books_.points) {
    const auto left = float(parts_[p.part].share);
    if (!(left < 1)) continue;
    float& rebound = rows_.rebounds[p.point][p.lane];
    rows_.points[p.point].normal_sum[p.lane] -= (1 - left) * rebound;
    rebound *= left;
  }
  for (const BlowBooks::Joint& j : books_.joints)
    for (size_t row = 0; parts_[j.part].share < 1 && row < rows_of(j); ++row) {
      float& now = row_impulse(j, row, JointPass::relaxing);
      now = scaled(now, j.relaxing[row], parts_[j.part].share);
    }
}

}  // namespace tumble
