#include "engine/world/tick_backup.hpp"

#include "engine/core/chunks.hpp"
#include "engine/core/prefetch.hpp"
#include "engine/world/state.hpp"

namespace tumble {

void TickBackup::take(World::State& s) {
  const ScopedStage stage(s.profiler, "backup");
  joints_ = s.joints.joints;
  event_contacts_ = s.event.contacts;
  event_particles_ = s.event.particles;
  touching_particles_ = s.touching_particles;
  particles_ = s.particles;
  s.contacts.begin_tick();
  s.particle_contacts.begin_tick();
  bodies_.resize(s.bodies.bodies.size());
  for_chunks(s.crew.get(), bodies_.size(), [&](size_t, size_t first, size_t last) {
    for (size_t i = first; i < last; ++i) {
      prefetch_ahead<256>(std::span(s.bodies.bodies), i);
      const RigidBody& b = s.bodies.bodies[i];
      bodies_[i] = {b.pose, b.v, b.omega, b.rest, b.asleep};
    }
  });
}

void TickBackup::restore(World::State& s) {
  s.contacts.go_back();
  s.joints.joints.swap(joints_);
  s.event.contacts.swap(event_contacts_);
  s.event.particles.swap(event_particles_);
  s.particle_contacts.go_back();
  s.touching_particles.swap(touching_particles_);
  s.particles.swap(particles_);
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
