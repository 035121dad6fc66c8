#include "viewer/app/editing/arranger.hpp"

#include "engine/world/world.hpp"
#include "viewer/app/editing/displaced_body.hpp"
#include "viewer/render/render_scene.hpp"

namespace tumble {
namespace {

using Bodies = std::vector<BodyId>;
using Start = std::vector<std::tuple<BodyId, BodyDef, Pose>>;

/// Runs on the simulation thread.
void displace(World& world, const Bodies& bodies, Start& start, const Displacement& way, bool held,
              const UndoStepEdits& edits, const Refusal& refusal) {
  if (start.empty())
    for (const BodyId id : bodies)
      if (auto def = world.body_def(id))
        start.emplace_back(id, *std::move(def), world.body(id)->body_frame());
  // All bodies are changed, or none.
  std::vector<std::pair<BodyId, BodyDef>> moved;
  std::vector<SceneEdit> changes;
  for (const auto& [id, known, now] : start) {
    BodyDef standing = known;
    standing.pose = now;
    auto wanted = displaced(standing, way);
    if (!wanted) return refusal.say(wanted.error());
    ChangedBody change = changed_at(known, now, *std::move(wanted), world.tick() > 0);
    BodyDef after = change.after;
    changes.push_back(std::move(change));
    if (held && after.type == BodyType::dynamic)
      after.velocity = after.angular_velocity = Vec3::Zero();
    moved.emplace_back(id, std::move(after));
  }
  for (auto& [id, def] : moved)
    if (const Status done = world.set_body(id, std::move(def)); !done)
      return refusal.say(done.error());
  *edits = std::move(changes);
}

}  // namespace

std::optional<Pose> Arranger::frame_of(const Frame& shown, const Selection& selection,
                                       const HandleSettings& settings) {
  const auto slot = find_slot(shown, selection.main());
  if (!slot) return std::nullopt;
  const Pose& centre = shown.body(*slot).pose;
  return Pose{centre.x, settings.own_axes ? centre.q : Quat::Identity()};
}

void Arranger::begin(const Frame& shown, const Selection& selection, const HandleSettings& settings,
                     const Handles::View& view, double x, double y, bool on_handle) {
  const auto frame = frame_of(shown, selection, settings);
  if (!frame) return;
  active_ = true;
  frame_ = *frame;
  bodies_ = selection.all();
  start_ = std::make_shared<Start>();
  const Handles::Part part =
      on_handle ? Handles::hit(settings.kind, frame_, view, x, y) : Handles::Part::none;
  if (part != Handles::Part::none) handles_.begin(settings, frame_, part, view, x, y);
  const auto slot = find_slot(shown, selection.main());
  bounds_ = body_bounds(shown, *slot);
  bounds_ = {bounds_.min - frame_.x, bounds_.max - frame_.x};
}

std::optional<Displacement> Arranger::drag(const HandleSettings& settings,
                                           const Handles::View& view, double x, double y, bool snap,
                                           const std::optional<Pick>& hit) {
  if (!active_) return std::nullopt;
  const auto way = asked(settings, view, x, y, snap, hit);
  if (way && (last_ || !way->is_null())) last_ = way;
  return way;
}

std::optional<Displacement> Arranger::asked(const HandleSettings& settings,
                                            const Handles::View& view, double x, double y,
                                            bool snap, const std::optional<Pick>& hit) const {
  if (handles_.active()) return handles_.drag(view, x, y, snap);
  if (!hit || bounds_.empty()) return std::nullopt;
  // The body stands on the face under the pointer, as far out as its bounding box reaches.
  const Vec3& n = hit->normal;
  const double below = -(n.cwiseMin(0).dot(bounds_.max) + n.cwiseMax(0).dot(bounds_.min));
  Vec3 at = hit->x_world;
  if (snap && settings.step > 0)
    for (int axis = 0; axis < 3; ++axis)
      if (std::abs(n[axis]) < 0.5) at[axis] = settings.step * std::round(at[axis] / settings.step);
  at += (hit->x_world - at).dot(n) * n;
  return Displacement{.pivot = frame_.x, .shift = at + below * n - frame_.x};
}

void Arranger::end() {
  handles_.end();
  last_.reset();
  active_ = false;
}

void Arranger::apply(Session& session, const Displacement& way, UndoStepEdits edits,
                     Refusal refusal) const {
  session.post(
      [bodies = bodies_, start = start_, way, held = !session.paused(), edits = std::move(edits),
       refusal](World& world) { displace(world, bodies, *start, way, held, edits, refusal); });
}

void Arranger::apply_once(Session& session, const Selection& selection, const Displacement& way,
                          UndoStepEdits edits, Refusal refusal) {
  session.post([bodies = selection.all(), way, edits = std::move(edits), refusal](World& world) {
    Start start;
    displace(world, bodies, start, way, false, edits, refusal);
  });
}

void Arranger::draw(const Frame& shown, const Selection& selection, const HandleSettings& settings,
                    const Handles::View& view, double x, double y, RenderScene& out) const {
  if (settings.kind == HandleKind::none) return;
  const auto frame = frame_of(shown, selection, settings);
  if (!frame) return;
  const Handles::Part lit =
      handles_.active() ? handles_.part() : Handles::hit(settings.kind, *frame, view, x, y);
  Handles::draw(settings.kind, *frame, lit, view, out);
}

}  // namespace tumble
