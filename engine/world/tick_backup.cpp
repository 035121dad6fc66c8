#include "engine/world/tick_backup.hpp"

#include "engine/core/chunks.hpp"
#include "engine/core/prefetch.hpp"
#include "engine/dynamics/particles/copy_particles.hpp"
#include "engine/world/state.hpp"

#include <algorithm>

namespace tumble {

void TickBackup::take(WorldState& s) {
  const ScopedStage stage(s.profiler, "backup");
  joints_ = s.joints.joints;
  couplings_ = s.joints.couplings;
  event_contacts_ = s.event.contacts;
  event_particles_ = s.event.particles;
  time_stepped_ = s.event.time_stepped;
  time_stepped_particles_ = s.event.time_stepped_particles;
  touching_particles_ = s.touching_particles;
  particles_.resize(s.particles.size());
  for (size_t i = 0; i < particles_.size(); ++i)
    copy_particles(s.particles[i], particles_[i], s.crew.get());
  emitters_ = s.emitters.list;
  s.contacts.begin_tick();
  s.particle_contacts.begin_tick();
  s.grain_touches.begin_tick();
  const std::span<const RigidBody> bodies = s.bodies.bodies;
  const bool all = s.roster.everything() || bodies_.size() != bodies.size();
  bodies_.resize(bodies.size());
  const auto keep = [&](size_t count, const auto& slot) {
    for_chunks(s.crew.get(), count, [&](size_t, size_t first, size_t last) {
      for (size_t k = first; k < last; ++k) {
        prefetch<256>(&bodies[slot(std::min(k + 8, last - 1))]);
        const RigidBody& b = bodies[slot(k)];
        bodies_[slot(k)] = {b.pose, b.v, b.omega, b.rest, b.asleep};
      }
    });
  };
  if (all) return keep(bodies.size(), [](size_t k) { return k; });
  // All others are unchanged since they were last copied.
  for (const std::span<const uint32_t> slots : {s.roster.active(), s.roster.settled()})
    keep(slots.size(), [slots](size_t k) { return slots[k]; });
}

void TickBackup::restore(WorldState& s) {
  s.roster.forget();
  s.contacts.go_back();
  s.joints.joints.swap(joints_);
  s.joints.couplings.swap(couplings_);
  s.event.contacts.swap(event_contacts_);
  s.event.particles.swap(event_particles_);
  s.event.time_stepped.swap(time_stepped_);
  s.event.time_stepped_particles.swap(time_stepped_particles_);
  s.particle_contacts.go_back();
  s.grain_touches.go_back();
  s.touching_particles.swap(touching_particles_);
  s.particles.swap(particles_);
  s.emitters.list.swap(emitters_);
  for (size_t i = 0; i < bodies_.size(); ++i) {
    RigidBody& b = s.bodies.bodies[i];
    b.pose = bodies_[i].pose;
    b.v = bodies_[i].v;
    b.omega = bodies_[i].omega;
    b.rest = bodies_[i].rest;
    b.asleep = bodies_[i].asleep;
  }
}

std::vector<Pose> TickBackup::poses() const {
  std::vector<Pose> out;
  out.reserve(bodies_.size());
  for (const Motion& m : bodies_) out.push_back(m.pose);
  return out;
}

}  // namespace tumble
