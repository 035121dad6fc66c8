#include "engine/world/emission.hpp"

#include "engine/core/chunks.hpp"
#include "engine/dynamics/particles/emission_bounds.hpp"
#include "engine/dynamics/particles/tolerances.hpp"
#include "engine/math/rotation.hpp"
#include "engine/world/emission_due.hpp"
#include "engine/world/sensors/tolerances.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include <fmt/format.h>

namespace tumble {
namespace {

/// Number of whole periods in a product of a rate and a time, which is as if exact.
double whole_number(double x) {
  return std::floor(x * (1 + tolerances::count_rounding));
}

LedgerEntry entry_of(const LedgerState& s, double sign) {
  return {sign * s.kinetic, sign * s.energy, sign * s.momentum, sign * s.angular_momentum};
}

/// Why a particle is removed.
enum Gone : uint8_t { stays, dies, in_sink };

class ParticleEmission {
 public:
  ParticleEmission(WorldState& state, const TickBackup& start)
      : s_(state),
        start_(start),
        scratch_(state.workspace.emission),
        h_(state.settings.tick.tick()),
        end_(state.time_after()) {
    for (const Emitter& e : s_.emitters.list) {
      eventful_ = eventful_ || (e.def && !e.def->events.empty());
      masses_change_ = masses_change_ || (e.def && !e.def->mass_over_life.empty());
    }
  }

  Status run() {
    scratch_.calls.clear();
    for (auto* list : {&scratch_.dead, &scratch_.born, &scratch_.shed, &scratch_.gained})
      empty(*list);
    for (uint32_t k = 0; k < s_.particles.size(); ++k)
      if (s_.particle_ids.alive(k)) end_lives(k);
    if (eventful_) bodies_live();
    take_asked();
    scratch_.counts.clear();
    for (const ParticleSystem& p : s_.particles) scratch_.counts.push_back(p.size());
    answer_calls();
    for (uint32_t i = 0; i < s_.emitters.list.size(); ++i) emit_due(i);
    answer_calls();
    if (too_many_) return too_many(s_, *too_many_);
    for (ParticleSystem& p : s_.particles) age(p);
    for (size_t k = 0; masses_change_ && k < s_.particles.size(); ++k) change_masses(k);
    book();
    return {};
  }

 private:
  void empty(std::vector<ParticleSystem>& systems) const {
    systems.resize(s_.particles.size());
    for (size_t k = 0; k < systems.size(); ++k) {
      systems[k].clear();
      systems[k].gravity_scale = s_.particles[k].gravity_scale;
      systems[k].grains = s_.particles[k].grains;
    }
  }

  /// State of a particle at a time before the end of the tick, as if it had been in free fall
  /// since.
  struct Past {
    Vec3 x, v;
  };
  Past before(const ParticleSystem& p, size_t i, double ago) const {
    const Vec3 a = p.gravity_scale * s_.settings.gravity.now();
    return {p.x[i] - ago * p.v[i] + (0.5 * ago * ago) * a, p.v[i] - ago * a};
  }

  bool taken(const ParticleSystem& p, size_t i, ParticleSystemId id) const {
    for (uint32_t k = 0; k < s_.sinks.list.size(); ++k) {
      const SinkDef& sink = s_.sinks.list[k];
      if (!s_.sinks.ids.alive(k) || !sink.takes_particles) continue;
      if (!sink.systems.empty() && std::ranges::find(sink.systems, id) == sink.systems.end())
        continue;
      if (holds(sink, p.x[i])) return true;
    }
    return false;
  }

  /// Finds the particles of a system that have reached their end, and collects the births that
  /// events of all its particles ask for.
  void end_lives(uint32_t k) {
    ParticleSystem& p = s_.particles[k];
    std::vector<uint8_t>& gone = scratch_.gone;
    gone.assign(p.size(), stays);
    const ParticleSystemId id = s_.particle_ids.at(k);
    for_chunks(s_.crew.get(), p.size(), [&](size_t, size_t first, size_t last) {
      for (size_t i = first; i < last; ++i)
        gone[i] = p.age[i] >= p.life[i] ? dies : taken(p, i, id) ? in_sink : stays;
    });
    if (eventful_) live(k);
    size_t left = 0;
    for (size_t i = 0; i < p.size(); ++i) {
      if (gone[i] == stays) continue;
      ++left;
      scratch_.dead[k].add_copy(p, i);
      if (Emitter* e = s_.emitters.find(p.emitter[i]); e && e->alive > 0) --e->alive;
    }
    if (left == 0) return;
    renumber(k);
    p.remove(gone);
  }

  /// Evaluates the events of a system's particles.
  void live(uint32_t k) {
    const ParticleSystem& p = s_.particles[k];
    find_hits(k);
    const ParticleSystem& start = start_.particles()[k];
    for (size_t i = 0, was = 0; i < p.size(); ++i) {
      while (was < start.size() && start.id[was] < p.id[i]) ++was;  // ids ascend in both
      const Emitter* e = s_.emitters.find(p.emitter[i]);
      if (!e || e->def->events.empty()) continue;
      const double over = scratch_.gone[i] == dies ? p.age[i] - p.life[i] : 0;  // since its death
      const bool was_there = was < start.size() && start.id[was] == p.id[i];
      along_life(*e, was_there ? start.age[was] : 0, p.age[i], p.life[i],
                 [&](double ago) { return before(p, i, ago); });
      for (const SpawnRule& r : e->def->events) {
        if (r.on != SpawnRule::On::collision || !scratch_.hit[i] || scratch_.gone[i] != stays)
          continue;
        call(r, {p.x[i], p.v[i]}, 0);
        if (r.dies) scratch_.gone[i] = dies;
      }
      if (scratch_.gone[i] == dies) call_all(*e, SpawnRule::On::death, before(p, i, over), over);
      if (scratch_.gone[i] == in_sink) call_all(*e, SpawnRule::On::sink, {p.x[i], p.v[i]}, 0);
    }
  }

  /// Marks the particles of a system that collided in this tick.
  void find_hits(uint32_t k) {
    std::vector<uint8_t>& hit = scratch_.hit;
    hit.assign(s_.particles[k].size(), 0);
    for (const FastCollision& c : s_.workspace.fast_collisions)
      if (c.system == k) hit[c.particle] = 1;
    const auto& contacts = s_.particle_detection.contacts();
    if (!contacts) return;
    const ParticleSystemId id = s_.particle_ids.at(k);
    for (const ParticleContactFrame& c : *contacts) {
      if (!(c.time > 0)) continue;  // they touched before the tick
      if (c.system == id) hit[c.particle] = 1;
      if (c.other == id) hit[c.other_particle] = 1;
    }
  }

  /// Births by the rules `life` after one age and up to another. The first is to be the second of
  /// the tick before, bit by bit, so that each birth is in one tick. `at` gives position and
  /// velocity at a time before the end of the tick.
  template <class At>
  void along_life(const Emitter& e, double from, double to, double life, const At& at) {
    const double until = std::min(to, life);
    for (const SpawnRule& r : e.def->events) {
      if (r.on != SpawnRule::On::life || !(r.rate > 0)) continue;
      const double last = whole_number(r.rate * until);
      for (double n = whole_number(r.rate * from) + 1; n <= last; ++n) {
        const double ago = std::max(0.0, to - n / r.rate);
        call(r, at(ago), ago);
      }
    }
  }

  void call_all(const Emitter& e, SpawnRule::On on, const Past& at, double ago) {
    for (const SpawnRule& r : e.def->events)
      if (r.on == on) call(r, at, ago);
  }
  void call(const SpawnRule& r, const Past& at, double ago) {
    Emitter* called = s_.emitters.find(r.emitter);
    if (!called) return;
    if (called->def->body)  // they are made before the next tick
      called->asked.push_back({at.x, at.v, end_ - ago, r.count});
    else
      scratch_.calls.push_back({r.emitter, at.x, at.v, ago, r.count});
  }

  /// The births of particles that events of bodies asked for before the tick.
  void take_asked() {
    for (uint32_t slot = 0; slot < s_.emitters.list.size(); ++slot) {
      Emitter& e = s_.emitters.list[slot];
      if (!e.def || e.def->body) continue;
      for (const Emitter::Asked& a : e.asked)
        scratch_.calls.push_back(
            {s_.emitters.ids.at(slot), a.x, a.v, std::clamp(end_ - a.time, 0.0, h_), a.count});
      e.asked.clear();
    }
  }

  /// The events of bodies within the tick.
  void bodies_live() {
    find_body_hits();
    for (Emitter& e : s_.emitters.list) {
      if (!e.def || !e.def->body || e.def->events.empty()) continue;
      for (Emitter::OwnBody& own : e.bodies)
        if (const RigidBody* b = s_.bodies.find(own.id)) live_body(e, own, *b);
    }
  }

  void live_body(const Emitter& e, Emitter::OwnBody& own, const RigidBody& b) {
    const double age = end_ - own.born;
    const auto at = [&](double ago) -> Past {
      return {interpolate(start_.pose(own.id.index), b.pose, 1 - ago / h_).x, b.v};
    };
    along_life(e, std::max(0.0, s_.time() - own.born), age, own.dies - own.born, at);
    if (b.asleep) return;  // it touches what it touched
    const std::vector<BodyHit>& hits = scratch_.body_hits;
    const auto first = std::ranges::lower_bound(hits, own.id.index, {}, &BodyHit::slot);
    const auto last = std::ranges::upper_bound(first, hits.end(), own.id.index, {}, &BodyHit::slot);
    const std::vector<BodyId> before = std::exchange(own.touching, {});
    bool dead = false;
    for (auto hit = first; hit != last; ++hit) {
      const bool touched = std::ranges::binary_search(before, hit->other);
      if (!touched && !hit->presses) continue;
      own.touching.push_back(hit->other);
      // What it meets besides, meets one that is gone.
      if (!touched && !dead) dead = collide(e, {hit->x, b.v + b.omega.cross(hit->x - b.pose.x)});
    }
    if (dead) own.dies = end_;
  }

  /// Calls for the births of a body's collision; whether it dies of it.
  bool collide(const Emitter& e, const Past& there) {
    bool ends = false;
    for (const SpawnRule& r : e.def->events) {
      if (r.on != SpawnRule::On::collision) continue;
      call(r, there, 0);
      ends = ends || r.dies;
    }
    return ends;
  }

  /// Whether a contact goes on if it was one before: its gap is that of a rattle.
  bool near(const Contact& c) const {
    const double rattle = tolerances::rattle_gap * s_.settings.gravity.now().norm() * h_ * h_;
    return std::ranges::any_of(c.used(), [&](const ContactPoint& p) { return p.gap <= rattle; });
  }

  /// What presses against bodies whose collisions are events, or is near them, one place for each
  /// pair.
  void find_body_hits() {
    std::vector<BodyHit>& hits = scratch_.body_hits;
    hits.clear();
    std::vector<uint8_t>& waits = scratch_.hit;
    waits.assign(s_.bodies.bodies.size(), 0);
    bool any = false;
    for (const Emitter& e : s_.emitters.list) {
      if (!e.def || !e.def->body) continue;
      const bool collisions = std::ranges::any_of(
          e.def->events, [](const SpawnRule& r) { return r.on == SpawnRule::On::collision; });
      for (const Emitter::OwnBody& own : e.bodies)
        if (collisions && own.id.index < waits.size()) {
          waits[own.id.index] = 1;
          any = true;
        }
    }
    if (!any) return;
    for (const Contact& c : std::as_const(s_.contacts).contacts()) {
      const uint32_t a = c.key.body_a, b = c.key.body_b;
      if (std::max(a, b) >= waits.size() || !(waits[a] || waits[b])) continue;
      const bool presses = c.pressed();
      if (!presses && !near(c)) continue;
      int pressed = 0;
      while (pressed + 1 < c.count && contact_impulse(c, pressed).isZero(0)) ++pressed;
      const Vec3 x = contact_position(c, pressed, s_.bodies.bodies);
      if (waits[a]) hits.push_back({a, s_.bodies.ids.at(b), presses, x});
      if (waits[b]) hits.push_back({b, s_.bodies.ids.at(a), presses, x});
    }
    const auto pair = [](const BodyHit& hit) { return std::pair(hit.slot, hit.other); };
    const auto pressing_first = [](const BodyHit& hit) {
      return std::tuple(hit.slot, hit.other, !hit.presses);
    };
    std::ranges::stable_sort(hits, {}, pressing_first);
    const auto same = [&](const BodyHit& a, const BodyHit& b) { return pair(a) == pair(b); };
    hits.erase(std::unique(hits.begin(), hits.end(), same), hits.end());
  }

  void answer_calls() {
    for (size_t n = 0; n < scratch_.calls.size() && !too_many_; ++n) {
      const SpawnCall c = scratch_.calls[n];  // a copy: births may add more calls
      Emitter* e = s_.emitters.find(c.emitter);
      if (!e) continue;
      const EmissionPlace place{{c.x, e->def->pose.q}, c.x, c.v, Vec3::Zero()};
      for (int i = 0; i < c.count; ++i) bear(*e, c.emitter, place, c.ago);
    }
    scratch_.calls.clear();
  }

  /// Births by rate and bursts of an emitter in this tick.
  void emit_due(uint32_t slot) {
    Emitter& e = s_.emitters.list[slot];
    if (!e.def || e.def->particles.is_null() || too_many_) return;
    if (due_by(e, end_ - e.begun) > double(most_of_a_system)) too_many_ = &e;
    if (too_many_) return;
    scratch_.births.clear();
    take_due(e, end_ - e.begun, scratch_.births);
    for (const double birth : scratch_.births) {
      const double ago = std::clamp(end_ - e.begun - birth, 0.0, h_);
      if (const auto place = place_of(e, ago)) bear(e, s_.emitters.ids.at(slot), *place, ago);
    }
  }

  /// Empty if the carrier no longer exists.
  std::optional<EmissionPlace> place_of(const Emitter& e, double ago) const {
    const EmitterDef& d = *e.def;
    if (d.carrier.is_null()) return EmissionPlace{d.pose, d.pose.x, Vec3::Zero(), Vec3::Zero()};
    const RigidBody* b = s_.bodies.find(d.carrier);
    if (!b) return std::nullopt;
    const Pose centre = interpolate(start_.pose(d.carrier.index), b->pose, 1 - ago / h_);
    const Pose body{centre.x - centre.direction(b->centre_body), centre.q};
    return EmissionPlace{body * d.pose, centre.x, b->v, b->omega};
  }

  void bear(Emitter& e, EmitterId id, const EmissionPlace& place, double ago) {
    const EmitterDef& d = *e.def;
    if (!s_.particle_ids.contains(d.particles) || e.alive >= d.at_most) return;
    ParticleSystem& p = s_.particles[d.particles.index];
    if (p.size() >= most_of_a_system) too_many_ = &e;
    if (too_many_) return;
    ParticleDef born = next_particle(e, place, end_ - ago - e.begun);
    const Vec3 a = p.gravity_scale * s_.settings.gravity.now();
    if (!d.events.empty()) {
      const auto at = [&](double before_end) -> Past {
        const double t = ago - before_end;
        return {born.x + t * born.v + (0.5 * t * t) * a, born.v + t * a};
      };
      call_all(e, SpawnRule::On::birth, at(ago), ago);
      along_life(e, 0, ago, born.life, at);
      if (ago >= born.life) call_all(e, SpawnRule::On::death, at(ago - born.life), ago - born.life);
    }
    if (ago >= born.life) return;
    born.x += ago * born.v + (0.5 * ago * ago) * a;
    born.v += ago * a;
    p.add(born, id, ago);
    ++e.alive;
  }

  /// Sets sizes and colours by age.
  void age(ParticleSystem& p) const {
    for_chunks(s_.crew.get(), p.size(), [&](size_t, size_t first, size_t last) {
      for (size_t i = first; i < last; ++i) {
        const Emitter* e = s_.emitters.find(p.emitter[i]);
        if (!e) continue;
        const EmitterDef& d = *e->def;
        if (d.size_over_life.empty() && d.colour_over_life.empty()) continue;
        const double u = std::clamp(p.age[i] / p.life[i], 0.0, 1.0);
        if (!d.size_over_life.empty())
          p.radius[i] = p.born_radius[i] * over_life(d.size_over_life, u);
        if (!d.colour_over_life.empty()) p.colour[i] = over_life(d.colour_over_life, u);
      }
    });
  }

  /// Sets masses to those of the present age. Mass that is lost leaves, and mass that is gained
  /// comes, with the velocity of its particle.
  void change_masses(size_t k) {
    ParticleSystem& p = s_.particles[k];
    for (size_t i = 0; i < p.size(); ++i) {
      const Emitter* e = s_.emitters.find(p.emitter[i]);
      if (!e || e->def->mass_over_life.empty()) continue;
      const double u = std::clamp(p.age[i] / p.life[i], 0.0, 1.0);
      const double lost = p.mass[i] - p.born_mass[i] * over_life(e->def->mass_over_life, u);
      if (lost == 0) continue;
      if (i < scratch_.counts[k]) {  // others are booked as they are born
        ParticleSystem& moved = lost > 0 ? scratch_.shed[k] : scratch_.gained[k];
        moved.add_copy(p, i);
        moved.mass.back() = std::fabs(lost);
      }
      p.mass[i] -= lost;
    }
  }

  /// Before a removal: updates the contacts found, which refer to particles by index.
  void renumber(uint32_t k) {
    scratch_.places.clear();
    uint32_t next = 0;
    for (const uint8_t gone : scratch_.gone)
      scratch_.places.push_back(gone == stays ? next++ : ParticleDetection::gone);
    s_.particle_detection.renumber(s_.particle_ids.at(k), scratch_.places);
  }

  void book() {
    for (size_t k = 0; k < s_.particles.size(); ++k) {
      const ParticleSystem& p = s_.particles[k];
      for (size_t i = scratch_.counts[k]; i < p.size(); ++i) scratch_.born[k].add_copy(p, i);
    }
    book(LedgerLine::emission, scratch_.born, 1);
    book(LedgerLine::emission, scratch_.gained, 1);
    book(LedgerLine::removal, scratch_.dead, -1);
    book(LedgerLine::removal, scratch_.shed, -1);
  }
  void book(LedgerLine line, std::vector<ParticleSystem>& moved, double sign) {
    const bool any =
        std::ranges::any_of(moved, [](const ParticleSystem& p) { return p.size() > 0; });
    if (any) s_.ledger.book(line, entry_of(measure_particles(s_, moved), sign));
  }

  WorldState& s_;
  const TickBackup& start_;
  EmissionScratch& scratch_;
  double h_, end_;
  bool eventful_ = false, masses_change_ = false;
  const Emitter* too_many_ = nullptr;
};

}  // namespace

double due_by(const Emitter& e, double time) {
  double sum = double(count_by_rate(*e.def, time) - count_by_rate(*e.def, e.emitted_to));
  for (const Burst& b : e.def->bursts)
    sum += double(bursts_by(b, time) - bursts_by(b, e.emitted_to)) * b.count;
  return sum;
}

Error too_many(const WorldState& s, const Emitter& e) {
  return {ErrorCode::numeric,
          fmt::format("the emitter '{}' makes more than {} at once", e.def->name, most_of_a_system),
          fmt::format("tick {}", s.tick + 1), "give it a lower rate, a shorter life or at_most"};
}

Result<Emitter> make_emitter(const EmitterDef& def, double time) {
  auto shape = EmissionShape::make(def.shape);
  if (!shape) return shape.error();
  Emitter out;
  out.def = std::make_shared<const EmitterDef>(def);
  out.shape = std::make_shared<const EmissionShape>(std::move(*shape));
  out.begun = time;
  return out;
}

void reserve_for_emitters(WorldState& s) {
  std::vector<NamedEmitter> emitters;
  for (uint32_t i = 0; i < s.emitters.list.size(); ++i)
    if (s.emitters.ids.alive(i))
      emitters.push_back({s.emitters.ids.at(i), s.emitters.list[i].def.get()});
  const std::vector<double> most = most_alive(emitters, s.settings.tick.tick());
  std::vector<double> room(s.particles.size(), 0.0);
  for (size_t k = 0; k < emitters.size(); ++k)
    if (s.particle_ids.contains(emitters[k].def->particles))
      room[emitters[k].def->particles.index] += most[k];
  for (size_t k = 0; k < room.size(); ++k)
    if (room[k] > 0 && room[k] < double(most_of_a_system))
      s.particles[k].reserve(s.particles[k].size() + size_t(room[k]));
}

Status emit_particles(WorldState& s, const TickBackup& start) {
  const bool mortal = std::ranges::any_of(s.particles, &ParticleSystem::mortal);
  if (s.emitters.ids.count() == 0 && s.sinks.ids.count() == 0 && !mortal) {
    s.workspace.emission.dead.clear();
    return {};
  }
  const ScopedStage stage(s.profiler, "emission");
  return ParticleEmission(s, start).run();
}

bool emission_to_come(const WorldState& s) {
  const auto dies = [](const Emitter::OwnBody& b) { return std::isfinite(b.dies); };
  const auto lives = [](const SpawnRule& r) { return r.on == SpawnRule::On::life; };
  return std::ranges::any_of(s.emitters.list, [&](const Emitter& e) {
    if (!e.def) return false;
    const bool lively = !e.bodies.empty() && std::ranges::any_of(e.def->events, lives);
    return lively || !e.asked.empty() || !spent(e) || std::ranges::any_of(e.bodies, dies);
  });
}

}  // namespace tumble
