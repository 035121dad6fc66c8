#include "engine/core/chunks.hpp"
#include "engine/core/prefetch.hpp"
#include "engine/math/rotation.hpp"
#include "engine/world/particle_frames.hpp"
#include "engine/world/state.hpp"
#include "engine/world/tolerances.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <limits>
#include <utility>

namespace tumble {
namespace {

std::shared_ptr<const std::vector<BodyInfo>> make_infos(const WorldState& s) {
  auto infos = std::make_shared<std::vector<BodyInfo>>(s.bodies.ids.capacity());
  for (uint32_t i = 0; i < infos->size(); ++i) {
    if (!s.bodies.ids.alive(i)) continue;
    const RigidBody& b = s.bodies.bodies[i];
    const BodyDef& def = *s.body_defs[i];
    (*infos)[i] = {s.bodies.ids.at(i), def.name, b.type,   b.mass, b.inertia_body,
                   b.centre_body,      b.shapes, def.look, b.drawn};
  }
  return infos;
}

uint32_t island_of(const WorldState& s, uint32_t i) {
  return i < s.islands.island_of.size() ? s.islands.island_of[i] : 0;
}

BodyFrame frame_of(const WorldState& s, uint32_t i) {
  if (!s.bodies.ids.alive(i)) return {};
  const RigidBody& b = s.bodies.bodies[i];
  return {s.bodies.ids.at(i), b.pose, b.v, b.omega, island_of(s, i), b.asleep, b.teleported};
}

/// Whether a body's entry must be made anew: its motion or state differs from what was last
/// published.
bool changed(const WorldState& s, const BodyFrame& old, uint32_t i) {
  const RigidBody& b = s.bodies.bodies[i];
  const bool moved = b.pose.x != old.pose.x || b.pose.q.coeffs() != old.pose.q.coeffs();
  return b.awake() || moved || b.asleep != old.asleep || island_of(s, i) != old.island;
}

/// A body stays marked `teleported` until a frame has shown it; the flag is cleared here.
void make_chunk(WorldState& s, size_t c, std::shared_ptr<const Frame::BodyChunk>& out) {
  const uint32_t begin = uint32_t(c * Frame::chunk_size);
  const uint32_t end = std::min(begin + uint32_t(Frame::chunk_size), s.bodies.ids.capacity());
  const auto old =
      s.frames.last && c < s.frames.last->chunks.size() ? s.frames.last->chunks[c] : nullptr;
  const bool noted = std::exchange(s.frames.chunks_changed[c], uint8_t{0}) != 0;
  bool fresh = noted || !old;
  for (uint32_t i = begin; i < end && s.frames.unsure && !fresh; ++i)
    fresh = changed(s, (*old)[i - begin], i);
  if (!fresh) {
    out = old;
    return;
  }
  const auto chunk = s.frames.pool.chunks.get();
  for (uint32_t i = begin; i < end; ++i) (*chunk)[i - begin] = frame_of(s, i);
  std::fill(chunk->begin() + (end - begin), chunk->end(), BodyFrame{});
  out = chunk;
  for (uint32_t i = begin; i < end; ++i)
    if (std::exchange(s.bodies.bodies[i].teleported, false)) s.frames.chunks_changed[c] = 1;
}

void make_chunks(WorldState& s, std::vector<std::shared_ptr<const Frame::BodyChunk>>& chunks) {
  const uint32_t slots = s.bodies.ids.capacity();
  const size_t count = (slots + Frame::chunk_size - 1) / Frame::chunk_size;
  chunks.resize(count);
  s.frames.chunks_changed.resize(count, 1);
  s.frames.pool.chunks.keep_at_most(2 * count);
  const size_t least = least_parallel / Frame::chunk_size;
  for_chunks(
      s.crew.get(), count,
      [&](size_t, size_t first, size_t last) {
        for (size_t c = first; c < last; ++c) make_chunk(s, c, chunks[c]);
      },
      least);
}

/// Passes a ContactFrame for every contact point to `next`. Poses are read from `frame`, whose
/// bodies are closer together in memory than those of the world.
template <class Next>
void put_contacts(const Frame& frame, std::span<const Contact* const> contacts, const Next& next) {
  uint32_t last = ~uint32_t{0};
  Mat3 axes_a = Mat3::Identity();
  for (size_t k = 0; k < contacts.size(); ++k) {  // contacts of a body are consecutive
    prefetch<sizeof(ContactHead) + sizeof(ContactPoint)>(
        contacts[std::min(k + 8, contacts.size() - 1)]);
    const Contact& c = *contacts[k];
    const BodyFrame &a = frame.body(c.key.body_a), &b = frame.body(c.key.body_b);
    if (c.key.body_a != last) axes_a = a.pose.q.toRotationMatrix();
    last = c.key.body_a;
    const Mat3 axes_b = b.pose.q.toRotationMatrix();
    for (int i = 0; i < c.count; ++i) {
      const ContactPoint& p = c.points[size_t(i)];
      ContactFrame& f = next();
      f.a = a.id;
      f.b = b.id;
      f.x_world = 0.5 * (a.pose.x + axes_a * p.anchor_a + b.pose.x + axes_b * p.anchor_b);
      f.normal = c.normal;
      f.gap = p.gap;
      f.impulse = contact_impulse(c, i);
      f.friction = c.friction;
    }
  }
}

using ContactFrames = std::shared_ptr<const std::vector<ContactFrame>>;

/// `points`: expected number of points.
ContactFrames make_contacts(WorldState& s, const Frame& frame,
                            std::span<const Contact* const> contacts, size_t points) {
  const auto out = s.frames.pool.contacts.get();
  if (s.crew->threads() == 1 || contacts.size() < least_parallel) {
    size_t count = 0;
    out->reserve(points);
    out->resize(std::max(out->size(), points));
    put_contacts(frame, contacts, [&]() -> ContactFrame& {
      if (count == out->size()) out->emplace_back();
      return (*out)[count++];
    });
    out->resize(count);
    return out;
  }
  std::array<size_t, chunk_count> begins{};  // first point of each chunk; counts at first
  for_chunks(s.crew.get(), contacts.size(), [&](size_t chunk, size_t first, size_t last) {
    for (size_t k = first; k < last; ++k) begins[chunk] += size_t(contacts[k]->count);
  });
  size_t total = 0;
  for (size_t& begin : begins) begin = std::exchange(total, total + begin);
  out->resize(total);
  for_chunks(s.crew.get(), contacts.size(), [&](size_t chunk, size_t first, size_t last) {
    ContactFrame* at = out->data() + begins[chunk];
    put_contacts(frame, contacts.subspan(first, last - first),
                 [&at]() -> ContactFrame& { return *at++; });
  });
  return out;
}

ContactFrames make_active_contacts(WorldState& s, const Frame& frame) {
  const std::span<const Contact> contacts = std::as_const(s.contacts).contacts();
  s.frames.contacts.resize(contacts.size());
  size_t points = 0;
  for (size_t k = 0; k < contacts.size(); ++k) {
    s.frames.contacts[k] = &contacts[k];
    points += size_t(contacts[k].count);
  }
  return make_contacts(s, frame, s.frames.contacts, points);
}

/// The list of the last frame, if no contact came to rest or was disturbed since.
ContactFrames make_resting_contacts(WorldState& s, const Frame& frame) {
  const uint64_t revision = s.contacts.resting_revision();
  const bool same = s.frames.last && s.frames.resting_revision == revision;
  if (same) return s.frames.last->resting_contacts;
  s.frames.resting_revision = revision;
  return make_contacts(s, frame, s.contacts.resting(), s.contacts.resting_points());
}

/// Overwrites `out`, whose memory is reused.
void make_forces(WorldState& s, std::vector<ForceFrame>& out) {
  const ForceContext context = s.force_context();
  out.resize(s.forces.size());
  size_t count = 0;
  for (uint32_t i = 0; i < s.forces.size(); ++i) {
    if (!s.forces[i]) continue;
    ForceFrame& f = out[count++];
    f.id = s.force_ids.at(i);
    f.def = *s.forces[i];
    f.points.clear();
    const bool mesh = std::holds_alternative<SpringMeshDef>(f.def);
    for (const Anchor& a : anchors(f.def))
      if (const auto at = locate(a, context))
        f.points.push_back(at->x_world);
      else if (mesh)
        f.points.push_back(Vec3::Constant(std::numeric_limits<double>::quiet_NaN()));
  }
  out.resize(count);
}

std::array<CoordinateFrame, most_coordinates> coordinates_of(const WorldState& s,
                                                             const Joint& joint) {
  Joint now = joint;
  follow_coordinates(now, s.bodies.bodies, 0);
  std::array<CoordinateFrame, most_coordinates> out{};
  for (size_t k = 0; k < entry_of(joint.kind).coordinates.size(); ++k)
    out[k] = {now.value[k], now.rate[k], joint.motor_impulse[k] / s.settings.tick.tick()};
  return out;
}

std::shared_ptr<const std::vector<JointFrame>> make_joints(WorldState& s) {
  const auto out = s.frames.pool.joints.get();
  out->resize(s.joints.ids.count());
  auto next = out->begin();
  for (uint32_t i = 0; i < s.joints.ids.capacity(); ++i) {
    if (!s.joints.ids.alive(i)) continue;
    const Joint& j = s.joints.joints[i];
    const JointDef& def = s.joints.defs[i];
    const JointSides sides = joint_sides(j, s.bodies.bodies);
    JointFrame& f = *next++;
    f.id = s.joints.ids.at(i);
    f.name = def.name;
    f.kind = def.kind;
    f.a = def.a;
    f.b = def.b;
    f.frame_a = {sides.a.anchor(), sides.a.q};
    f.frame_b = {sides.b.anchor(), sides.b.q};
    const JointWrench mean = mean_load(j, s.settings.tick.tick());
    f.mean_force = mean.force;
    f.mean_torque = mean.torque;
    f.coordinates = coordinates_of(s, j);
  }
  return out;
}

/// Overwrites `out`, whose memory is reused.
void make_particles(WorldState& s, std::vector<std::shared_ptr<const ParticleFrame>>& out) {
  out.clear();
  const auto emitter = [&s](EmitterId id) -> const Emitter* { return s.emitters.find(id); };
  for (uint32_t i = 0; i < s.particles.size(); ++i) {
    if (!s.particle_ids.alive(i)) continue;
    const auto f = s.frames.pool.particles.get();
    f->id = s.particle_ids.at(i);
    show_particles(s.particles[i], emitter, *f);
    out.push_back(f);
  }
}

/// Overwrites `out`, whose memory is reused.
void make_fluid_forces(const WorldState& s, std::vector<FluidForceFrame>& out) {
  out.clear();
  for (const FluidWorkspace::OnBody& on : s.workspace.fluids.on_bodies)
    if (s.bodies.ids.alive(on.slot)) out.push_back({s.bodies.ids.at(on.slot), on.force, on.torque});
}

/// An empty frame that reuses memory of an old one.
std::shared_ptr<Frame> blank_frame(FramePool& pool) {
  auto frame = pool.frames.get();
  frame->chunks.clear();
  frame->contacts.reset();
  frame->resting_contacts.reset();
  frame->joints.reset();
  frame->particles.clear();
  frame->fluid_forces.clear();
  frame->sensors.reset();
  frame->ledger.reset();
  return frame;
}

/// Stores the times of the stages; publishing itself, which began at `start`, is the last of them.
void note_stages(WorldState& s, std::chrono::steady_clock::time_point start) {
  const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - start;
  s.stats.stages = s.profiler.stages();
  s.stats.stages.add("publish", spent.count());
}

/// Makes the frame of the present state; parts that did not change are shared with the last frame.
void publish_frame(WorldState& s) {
  const auto start = std::chrono::steady_clock::now();
  auto frame = blank_frame(s.frames.pool);
  frame->tick = s.tick;
  frame->rate = s.settings.tick;
  frame->time = s.time();
  frame->gravity = s.settings.gravity.now();
  frame->usual_gravity =
      std::max(frame->gravity.norm(), s.settings.gravity.varies() ? tolerances::earth_gravity : 0);
  frame->broad_phase = s.settings.broad_phase;
  frame->infos = !s.frames.last || s.frames.infos_changed ? make_infos(s) : s.frames.last->infos;
  const bool joints_changed = s.frames.infos_changed;
  s.frames.infos_changed = false;
  make_chunks(s, frame->chunks);
  const bool still = s.frames.last && s.frames.last->tick + 1 >= s.tick && s.stats.awake == 0 &&
                     s.frames.last->stats.awake == 0 && s.frames.last->chunks == frame->chunks &&
                     s.frames.resting_revision == s.contacts.resting_revision();
  frame->contacts = still ? s.frames.last->contacts : make_active_contacts(s, *frame);
  frame->resting_contacts = make_resting_contacts(s, *frame);
  frame->particle_contacts = s.particle_detection.contacts();
  make_forces(s, frame->forces);
  frame->joints = still && !joints_changed ? s.frames.last->joints : make_joints(s);
  make_particles(s, frame->particles);
  make_fluid_forces(s, frame->fluid_forces);
  if (!s.sensors.empty()) {
    const auto sensors = s.frames.pool.sensors.get();
    make_sensor_frames(s, *sensors);
    frame->sensors = sensors;
  }
  const auto ledger = s.frames.pool.ledgers.get();
  *ledger = s.ledger;
  frame->ledger = ledger;
  s.frames.unsure = false;
  note_stages(s, start);
  frame->stats = s.stats;
  s.frames.last = std::move(frame);
}

/// Makes a frame of the present tick that equals the last one, for a state that is still.
void repeat_frame(WorldState& s) {
  const auto start = std::chrono::steady_clock::now();
  auto frame = blank_frame(s.frames.pool);
  *frame = *s.frames.last;
  frame->tick = s.tick;
  frame->time = s.time();
  note_stages(s, start);
  frame->stats.stages = s.stats.stages;
  s.frames.last = std::move(frame);
}

}  // namespace

const std::shared_ptr<const Frame>& present_frame(WorldState& s) {
  const std::lock_guard lock(s.frames.mutex);
  if (s.frames.due == FrameState::Due::make) publish_frame(s);
  if (s.frames.due == FrameState::Due::repeat) repeat_frame(s);
  s.frames.due = FrameState::Due::nothing;
  return s.frames.last;
}

FluidForceFrame Frame::fluid_force(BodyId body) const {
  const auto found = std::ranges::find(fluid_forces, body, &FluidForceFrame::body);
  return found == fluid_forces.end() ? FluidForceFrame{.body = body} : *found;
}

double kinetic_energy(const BodyFrame& body, const BodyInfo& info) {
  if (info.type != BodyType::dynamic) return 0;
  const Vec3 omega_body = body.pose.inverse_direction(body.omega);
  return 0.5 * info.mass * body.v.squaredNorm() + 0.5 * omega_body.dot(info.inertia * omega_body);
}

Pose interpolated_pose(const Frame& from, const Frame& to, size_t slot, double s) {
  const BodyFrame& b = to.body(slot);
  if (b.jumped || slot >= from.body_slots() || from.body(slot).id != b.id) return b.pose;
  return interpolate(from.body(slot).pose, b.pose, s);
}

}  // namespace tumble
