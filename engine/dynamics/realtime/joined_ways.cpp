#include "engine/dynamics/realtime/joined_ways.hpp"

#include <algorithm>
#include <utility>

namespace tumble {

void JoinedWays::enter(uint32_t body) {
  if (place_[body] != none) return;
  place_[body] = uint32_t(met_.size());
  met_.push_back({uint32_t(groups_.size()), 0, {}});
  groups_.push_back({body, {body}});
}

/// Of all that touches a body or is tied to it; of another one that may be among them not.
double JoinedWays::island_mass(uint32_t body, uint32_t without) const {
  const uint32_t number = islands_->island_of[body];
  if (number == 0) return bodies_[body].mass;
  const Island& island = islands_->islands[number - 1];
  double mass = 0;
  for (uint32_t k = island.body_begin; k < island.body_end; ++k)
    if (islands_->bodies[k] != without) mass += bodies_[islands_->bodies[k]].mass;
  return mass;
}

/// Whether what leads a goes its way whatever b does.
bool JoinedWays::takes_along(uint32_t a, uint32_t b) {
  const uint32_t leader = group(a).leader, other = group(b).leader;
  if (!gives_way(other)) return false;
  if (!gives_way(leader)) return true;
  return bodies_[leader].mass >= std::max(island_mass(b, leader), island_mass(other, leader));
}

/// From time t on with a motion, or at rest where it is none.
void JoinedWays::go_on(uint32_t body, const Motion& with, double t) {
  const Pose pose = way(body).pose(t);
  Motion leg = Motion::at_rest(pose, t, h_);
  if (Way::moves(with)) {
    leg.velocity = with.velocity;
    leg.omega = with.omega;
    leg.start = with.carrier(t);
    leg.offset = leg.start.inverse() * pose;
  }
  std::vector<Motion>& legs = met(body).legs;
  if (!legs.empty() && legs.back().t0 >= t) legs.pop_back();
  legs.push_back(leg);
  met(body).version = versions_;
}

/// All that goes with a body goes with another from now on.
std::vector<uint32_t> JoinedWays::join(uint32_t body, uint32_t other, double t) {
  const uint32_t into = met(other).group;
  std::vector<uint32_t> joining = std::exchange(group(body).members, {});
  const Motion with = way(groups_[into].leader).leg(t);
  for (const uint32_t i : joining) {
    met(i).group = into;
    go_on(i, with, t);
  }
  groups_[into].members.insert(groups_[into].members.end(), joining.begin(), joining.end());
  return joining;
}

/// Between two that cannot give way, what the one that moves carries stays behind at the other.
std::vector<uint32_t> JoinedWays::squeeze(uint32_t a, uint32_t b, double t) {
  const bool moves_a = Way::moves(way(group(a).leader).leg(t));
  const bool moves_b = Way::moves(way(group(b).leader).leg(t));
  const uint32_t body = moves_a ? a : b, other = moves_a ? b : a;
  if (moves_a == moves_b || !gives_way(body)) return {};
  std::erase(group(body).members, body);
  met(body).group = uint32_t(groups_.size());
  groups_.push_back({body, {body}});
  return join(body, other, t);
}

/// A body, if it `stops`, and all that goes with it.
void JoinedWays::rest(uint32_t body, bool stops, double t, std::vector<uint32_t>& stopped) {
  const std::vector<uint32_t>& all = group(body).members;
  if (!gives_way(body) || (all.size() == 1 && !stops)) return;
  for (const uint32_t i : all) {
    if (!way(i).moves_at(t)) continue;
    go_on(i, Motion(), t);
    stopped.push_back(i);
  }
}

std::vector<uint32_t> JoinedWays::meet(uint32_t a, uint32_t b, double t, bool stops_a,
                                       bool stops_b) {
  enter(a);
  enter(b);
  if (together(a, b)) return {};
  ++versions_;
  if (takes_along(a, b)) return join(b, a, t);
  if (takes_along(b, a)) return join(a, b, t);
  if (!gives_way(group(a).leader) && !gives_way(group(b).leader)) return squeeze(a, b, t);
  std::vector<uint32_t> stopped;
  rest(a, stops_a, t, stopped);
  rest(b, stops_b, t, stopped);
  return stopped;
}

}  // namespace tumble
