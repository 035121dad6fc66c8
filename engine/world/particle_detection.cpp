#include "engine/world/particle_detection.hpp"

#include "engine/world/tolerances.hpp"

#include <algorithm>
#include <tuple>

namespace tumble {
namespace {

/// Merges two sorted lists: calls f(touch or null, meet or null) for every key that is in either.
template <class Touch, class Meet, class Key, class F>
void merge_contacts(const std::vector<Touch>& touches, const std::vector<Meet>& meets,
                    const Key& key, const F& f) {
  size_t i = 0, k = 0;
  while (i < touches.size() || k < meets.size()) {
    const bool touch =
        k == meets.size() || (i < touches.size() && !(key(meets[k]) < key(touches[i])));
    const bool meet =
        i == touches.size() || (k < meets.size() && !(key(touches[i]) < key(meets[k])));
    f(touch ? &touches[i] : nullptr, meet ? &meets[k] : nullptr);
    i += touch;
    k += meet;
  }
}

/// The common part of both kinds of contact: at the present touch if there is one, else at the
/// first meeting.
template <class Touch, class Meet>
ParticleContactFrame contact_of(const Touch* touch, const Meet* meet) {
  ParticleContactFrame c;
  c.x_world = touch ? touch->x : meet->x;
  c.normal = touch ? touch->normal : meet->normal;
  c.gap = touch ? touch->gap : 0;
  c.time = meet ? meet->time : 0;
  c.apart_again = !touch;
  return c;
}

}  // namespace

bool ParticleDetection::asked_for(std::span<const ParticleSystem> systems) {
  return std::any_of(systems.begin(), systems.end(),
                     [](const ParticleSystem& s) { return s.detect; });
}

void ParticleDetection::collect(const BodySet& bodies, std::span<const Pose> start_poses,
                                const HandlePool<ParticleSystemTag>& ids,
                                std::span<const ParticleSystem> systems,
                                std::span<const ParticleSystem> start, double h) {
  owners_.clear(), from_.clear(), to_.clear(), v_.clear(), radius_.clear();
  for (uint32_t s = 0; s < systems.size(); ++s) {
    const ParticleSystem& system = systems[s];
    if (!ids.alive(s) || !system.detect) continue;
    for (uint32_t i = 0; i < system.size(); ++i) {
      owners_.push_back({ids.at(s), i});
      from_.push_back(start[s].x[i]);
      to_.push_back(system.x[i]);
      v_.push_back((system.x[i] - start[s].x[i]) / h);
      radius_.push_back(system.radius[i]);
    }
  }
  parts_.clear(), moving_.clear(), still_.clear();
  for (uint32_t b = 0; b < bodies.bodies.size(); ++b) {
    if (!bodies.ids.alive(b)) continue;
    const RigidBody& body = bodies.bodies[b];
    const Motion motion = Motion::between(start_poses[b], body.pose, 0, h);
    for (uint32_t k = 0; k < body.shapes.size(); ++k) {
      const BodyShape& part = body.shapes[k];
      parts_.push_back({bodies.ids.at(b), k});
      moving_.push_back({part.shape.get(), motion});
      moving_.back().motion.offset = part.pose;
      still_.push_back({part.shape.get(), body.pose * part.pose});
    }
  }
}

Status ParticleDetection::find_bodies(double h, std::vector<ParticleContactFrame>& out) {
  std::vector<ParticleShapeContact> touches;
  std::vector<ParticleShapeMeeting> meets;
  if (Status s = finder_.touching_shapes({to_, radius_}, still_, 0, touches); !s) return s;
  if (Status s = finder_.meeting_shapes({{from_, radius_}, v_, h}, moving_,
                                        tolerances::meeting_distance, meets);
      !s)
    return s;
  const auto key = [](const auto& c) { return std::tuple(c.particle, c.shape); };
  merge_contacts(touches, meets, key, [&](const auto* touch, const auto* meet) {
    ParticleContactFrame c = contact_of(touch, meet);
    const Owner& owner = owners_[touch ? touch->particle : meet->particle];
    const Part& part = parts_[touch ? touch->shape : meet->shape];
    c.system = owner.system;
    c.particle = owner.particle;
    c.body = part.body;
    c.shape = part.shape;
    out.push_back(c);
  });
  return {};
}

Status ParticleDetection::find_particles(double h, std::vector<ParticleContactFrame>& out) {
  std::vector<ParticlePairContact> touches;
  std::vector<ParticlePairMeeting> meets;
  if (Status s = finder_.touching_pairs({to_, radius_}, 0, touches); !s) return s;
  if (Status s = finder_.meeting_pairs({{from_, radius_}, v_, h}, meets); !s) return s;
  const auto key = [](const auto& c) { return std::tuple(c.a, c.b); };
  merge_contacts(touches, meets, key, [&](const auto* touch, const auto* meet) {
    ParticleContactFrame c = contact_of(touch, meet);
    const Owner &a = owners_[touch ? touch->a : meet->a], &b = owners_[touch ? touch->b : meet->b];
    c.system = a.system;
    c.particle = a.particle;
    c.other = b.system;
    c.other_particle = b.particle;
    out.push_back(c);
  });
  return {};
}

Status ParticleDetection::find(const BodySet& bodies, std::span<const Pose> start_poses,
                               const HandlePool<ParticleSystemTag>& ids,
                               std::span<const ParticleSystem> systems,
                               std::span<const ParticleSystem> start, double h, Crew& crew) {
  collect(bodies, start_poses, ids, systems, start, h);
  finder_.use_threads(&crew);
  auto found = std::make_shared<std::vector<ParticleContactFrame>>();
  if (Status s = find_bodies(h, *found); !s) return s;
  if (Status s = find_particles(h, *found); !s) return s;
  // Each half is sorted by particle, then by what the particle touches.
  std::stable_sort(found->begin(), found->end(),
                   [](const ParticleContactFrame& a, const ParticleContactFrame& b) {
                     return std::tuple(a.system, a.particle) < std::tuple(b.system, b.particle);
                   });
  contacts_ = std::move(found);
  return {};
}

void ParticleDetection::renumber(ParticleSystemId system, std::span<const uint32_t> places) {
  if (!contacts_) return;
  auto changed = std::make_shared<std::vector<ParticleContactFrame>>(*contacts_);
  std::erase_if(*changed, [&](ParticleContactFrame& c) {
    if (c.system == system) c.particle = places[c.particle];
    if (c.other == system) c.other_particle = places[c.other_particle];
    return (c.system == system && c.particle == gone) ||
           (c.other == system && c.other_particle == gone);
  });
  contacts_ = std::move(changed);
}

}  // namespace tumble
