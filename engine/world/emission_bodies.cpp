// Bodies that emitters make and sinks take.
#include "engine/world/emission.hpp"
#include "engine/world/emission_due.hpp"

#include <algorithm>

namespace tumble {
namespace {

/// Births and deaths of bodies between ticks, by the same commands that callers use.
class BodyEmission {
 public:
  explicit BodyEmission(WorldState& state) : s_(state), end_(state.time_after()) {}

  Status run() {
    if (Status done = remove(); !done) return done;
    book(LedgerLine::removal);
    for (Emitter& e : s_.emitters.list) {
      if (!e.def || !e.def->body) continue;
      if (Status done = emit(e); !done) return done;
    }
    if (Status done = emit_asked(); !done) return done;
    book(LedgerLine::emission);
    return {};
  }
  bool did() const { return did_; }

 private:
  Status remove() {
    std::vector<BodyId> leaving;
    for (Emitter& e : s_.emitters.list) {
      std::erase_if(e.bodies, [this](const Emitter::OwnBody& b) { return !s_.bodies.find(b.id); });
      for (const Emitter::OwnBody& b : e.bodies) {
        if (!(b.dies <= end_)) continue;
        leaving.push_back(b.id);
        ask(e, SpawnRule::On::death, b.id, s_.time());
      }
    }
    std::vector<BodyId> held;
    for (uint32_t k = 0; k < s_.sinks.list.size(); ++k)
      if (s_.sinks.ids.alive(k) && s_.sinks.list[k].takes_bodies) add_held(s_.sinks.list[k], held);
    std::ranges::sort(held);
    for (const Emitter& e : s_.emitters.list)
      for (const Emitter::OwnBody& b : e.bodies)
        if (b.dies > end_ && std::ranges::binary_search(held, b.id))
          ask(e, SpawnRule::On::sink, b.id, s_.time());
    leaving.insert(leaving.end(), held.begin(), held.end());
    std::ranges::sort(leaving);
    leaving.erase(std::unique(leaving.begin(), leaving.end()), leaving.end());
    for (const BodyId id : leaving) {
      s_.reserved.bodies.release(id);
      s_.reserved.joints.release_at(id);
      if (Status done = apply_command(s_, DestroyBody{id}); !done) return done;
      changed_ = true;
    }
    if (!leaving.empty())
      for (Emitter& e : s_.emitters.list)
        std::erase_if(e.bodies,
                      [this](const Emitter::OwnBody& b) { return !s_.bodies.find(b.id); });
    return {};
  }

  void add_held(const SinkDef& sink, std::vector<BodyId>& leaving) const {
    for (uint32_t slot = 0; slot < s_.bodies.bodies.size(); ++slot)
      if (s_.bodies.bodies[slot].dynamic() && holds(sink, s_.bodies.bodies[slot].pose.x))
        leaving.push_back(s_.bodies.ids.at(slot));
  }

  Status emit(Emitter& e) {
    std::vector<double>& births = s_.workspace.emission.births;
    births.clear();
    if (due_by(e, end_ - e.begun) > double(most_of_a_system)) return too_many(s_, e);
    take_due(e, end_ - e.begun, births);
    for (const double birth : births) {
      const auto place = place_of(e);
      if (!place) continue;
      if (Status done = bear(e, *place, e.begun + birth); !done) return done;
    }
    return {};
  }

  /// What events have asked for; births may ask for more, but never in a circle.
  Status emit_asked() {
    const auto asked = [](const Emitter& e) { return e.def && e.def->body && !e.asked.empty(); };
    for (;;) {
      const auto e = std::ranges::find_if(s_.emitters.list, asked);
      if (e == s_.emitters.list.end()) return {};
      for (const Emitter::Asked& a : std::exchange(e->asked, {})) {
        const double since = std::max(0.0, s_.time() - a.time);
        const Vec3 x = a.x + since * a.v + (0.5 * since * since) * s_.settings.gravity.now();
        const Vec3 v = a.v + since * s_.settings.gravity.now();
        for (int i = 0; i < a.count; ++i)
          if (Status done = bear(*e, {{x, e->def->pose.q}, x, v, Vec3::Zero()}, a.time); !done)
            return done;
      }
    }
  }

  Status bear(Emitter& e, const EmissionPlace& place, double time) {
    if (e.bodies.size() >= e.def->at_most) return {};
    EmittedBody born = next_body(e, place, std::max(0.0, time - e.begun));
    const BodyId id = s_.reserved.bodies.allocate();
    if (Status done = apply_command(s_, CreateBody{id, std::move(born.def)}); !done) return done;
    e.bodies.push_back({id, time + born.life, time});
    changed_ = true;
    ask(e, SpawnRule::On::birth, id, std::max(time, s_.time()));
    return {};
  }

  /// The births that an event of a body asks for.
  void ask(const Emitter& e, SpawnRule::On on, BodyId id, double time) {
    const RigidBody* b = s_.bodies.find(id);
    if (!b) return;
    for (const SpawnRule& r : e.def->events)
      if (Emitter* called = s_.emitters.find(r.emitter); called && r.on == on)
        called->asked.push_back({b->pose.x, b->v, time, r.count});
  }

  std::optional<EmissionPlace> place_of(const Emitter& e) const {
    const EmitterDef& d = *e.def;
    if (d.carrier.is_null()) return EmissionPlace{d.pose, d.pose.x, Vec3::Zero(), Vec3::Zero()};
    const RigidBody* b = s_.bodies.find(d.carrier);
    if (!b) return std::nullopt;
    return EmissionPlace{b->body_frame() * d.pose, b->pose.x, b->v, b->omega};
  }

  /// Books what has changed since the world was last measured.
  void book(LedgerLine line) {
    if (!std::exchange(changed_, false)) return;
    did_ = true;
    const LedgerState before = measured(s_);
    measure(s_);
    const LedgerState after = measured(s_);
    s_.ledger.book_between(
        line, {after.kinetic - before.kinetic, after.energy - before.energy,
               after.momentum - before.momentum, after.angular_momentum - before.angular_momentum});
  }

  WorldState& s_;
  double end_;
  bool changed_ = false, did_ = false;
};

}  // namespace

Result<bool> emit_bodies(WorldState& s) {
  const bool emits =
      std::ranges::any_of(s.emitters.list, [](const Emitter& e) { return e.def && e.def->body; });
  const bool takes =
      std::ranges::any_of(s.sinks.list, [](const SinkDef& sink) { return sink.takes_bodies; });
  if (!emits && !takes) return false;
  const ScopedStage stage(s.profiler, "emission");
  BodyEmission emission(s);
  if (Status done = emission.run(); !done) return done.error();
  return emission.did();
}

}  // namespace tumble
