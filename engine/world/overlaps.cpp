// World::overlaps: the pairs of bodies that overlap now, for any stepper.
#include "engine/world/state.hpp"
#include "engine/world/world.hpp"

#include <algorithm>

namespace tumble {

std::vector<Overlap> World::overlaps(double deeper) const {
  const WorldState& s = *state_;
  std::vector<RigidBody> bodies = s.bodies.bodies;
  for (RigidBody& b : bodies) {
    b.asleep = false;
    b.v.setZero();
    b.omega.setZero();
  }
  ProxySet proxies;
  update_proxies(bodies, Vec3::Zero(), 0, 0, proxies);
  std::vector<ProxyPair> pairs;
  all_broad_phases().back().make()->find_pairs(proxies.proxies,
                                               pairs);  // all find the same
  PairFilter apart;
  s.joints.find_apart(s.bodies.bodies, apart);
  apart.apply(proxies, pairs);
  ContactSet contacts;
  contacts.update(bodies, proxies, pairs, Vec3::Zero(), 0, 0, *s.crew, s.methods.narrow_phase,
                  s.methods.hierarchy);
  std::vector<Overlap> out;
  for (const Contact* contact : contacts.all()) {
    const Contact& c = *contact;
    double depth = 0;
    for (int i = 0; i < c.count; ++i) depth = std::max(depth, -c.points[size_t(i)].gap);
    if (!(depth > deeper)) continue;
    const BodyId a = s.bodies.ids.at(c.key.body_a), b = s.bodies.ids.at(c.key.body_b);
    // The contacts of a pair of bodies are consecutive.
    if (out.empty() || out.back().a != a || out.back().b != b) out.push_back({a, b, 0});
    out.back().depth = std::max(out.back().depth, depth);
  }
  std::stable_sort(out.begin(), out.end(),
                   [](const Overlap& p, const Overlap& q) { return p.depth > q.depth; });
  return out;
}

}  // namespace tumble
