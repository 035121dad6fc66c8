#include "viewer/app/editing/edits_at_start.hpp"

#include "engine/world/world.hpp"
#include "viewer/app/editing/parts_controller.hpp"

namespace tumble {
namespace {

/// The definition after a change made at another moment: of quantities that the motion changes,
/// only those that the edit itself has changed.
BodyDef changed_at_start(const BodyDef& now, const ChangedBody& c) {
  BodyDef def = c.after;
  if (c.after.pose.x == c.before.pose.x) def.pose.x = now.pose.x;
  if (c.after.pose.q.coeffs() == c.before.pose.q.coeffs()) def.pose.q = now.pose.q;
  if (c.after.velocity == c.before.velocity) def.velocity = now.velocity;
  if (c.after.angular_velocity == c.before.angular_velocity)
    def.angular_velocity = now.angular_velocity;
  if (c.after.starts_asleep == c.before.starts_asleep) def.starts_asleep = now.starts_asleep;
  if (c.after.course == c.before.course) def.course = now.course;
  return def;
}

/// Applies each edit in the world. Things are found by name, since ids may have changed since an
/// earlier run.
struct AtStart {
  World& world;
  SceneDescription parts;  ///< as changed by the edits so far
  LiveParts& live;

  Status operator()(const ChangedBody& c) {
    const BodyId id = world.find_body(c.name);
    const auto now = world.body_def(id);
    return now ? world.set_body(id, changed_at_start(*now, c)) : Status();
  }
  Status operator()(const AddedBody& c) { return status_of(world.create_body(c.def)); }
  Status operator()(const RemovedBody& c) {
    const BodyId id = world.find_body(c.name);
    return id.is_null() ? Status() : world.destroy_body(id);
  }
  Status operator()(const AddedJoint& c) {
    JointDef def = c.def;
    def.a = world.find_body(c.a);
    def.b = world.find_body(c.b);
    if (missing(c.a, def.a) || missing(c.b, def.b)) return {};
    return status_of(world.create_joint(std::move(def)));
  }
  Status operator()(const ChangedJoint& c) {
    const JointId id = world.find_joint(c.after.name);
    const JointDef* now = world.joint(id);
    if (!now) return {};
    JointDef def = *now;
    def.drives = c.after.drives;
    def.break_force = c.after.break_force;
    def.break_torque = c.after.break_torque;
    return world.set_joint(id, std::move(def));
  }
  Status operator()(const RemovedJoint& c) {
    const JointId id = world.find_joint(c.name);
    return id.is_null() ? Status() : world.destroy_joint(id);
  }
  Status operator()(AddedSpring& c) {
    SpringDef def = c.def;
    for (const auto& [anchor, name] : {std::pair(&def.a, &c.a), std::pair(&def.b, &c.b)}) {
      if (anchor->kind != Anchor::Kind::body) continue;
      anchor->body = world.find_body(*name);
      if (anchor->body.is_null()) return {};
    }
    const auto made = world.create_force(def);
    if (!made) return made.error();
    c.id = *made;
    live.know(c.name, c.id);
    return {};
  }
  Status operator()(const AddedPart& c) { return set(c.name, c.part, nullptr); }
  Status operator()(const ChangedPart& c) { return set(c.name, c.after, &c.before); }
  Status operator()(const RemovedPart& c) {
    (void)live.remove(world, c.name, c.part);
    return {};
  }
  Status operator()(const ChangedSettings&) { return {}; }
  Status operator()(const ChangedParameter&) { return {}; }

  Status set(const std::string& name, const PartDescription& part, const PartDescription* before) {
    return live.set(world, parts, name, part, before);
  }
  template <class Id>
  static Status status_of(const Result<Id>& made) {
    return made ? Status() : Status(made.error());
  }
  static bool missing(const std::string& name, BodyId id) { return !name.empty() && id.is_null(); }
};

}  // namespace

void do_at_start(World& world, const std::vector<UndoStepEdits>& undo_steps,
                 const std::shared_ptr<const SceneDescription>& parts,
                 const std::shared_ptr<LiveParts>& live, const Refusal& refusal) {
  AtStart at_start{world, *parts, *live};
  for (const UndoStepEdits& undo_step : undo_steps)
    for (SceneEdit& edit : *undo_step) {
      fold_part(at_start.parts, edit);
      Status done = std::visit(at_start, edit);
      // Later edits refer by name to what earlier ones have created.
      if (done) done = world.apply_commands();
      if (!done) refusal.say(done.error());
    }
}

}  // namespace tumble
