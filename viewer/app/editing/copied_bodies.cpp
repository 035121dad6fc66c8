#include "viewer/app/editing/copied_bodies.hpp"

#include "engine/world/world.hpp"
#include "viewer/app/editing/new_name.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace tumble {
namespace {

/// The index of a body in the group; empty if it is outside the group.
std::optional<CopiedBodies::End> end_of(const std::vector<BodyId>& taken, BodyId id) {
  if (id.is_null()) return CopiedBodies::End{};
  const auto at = std::ranges::find(taken, id);
  if (at == taken.end()) return std::nullopt;
  return CopiedBodies::End(size_t(at - taken.begin()));
}

/// The same for an anchor; empty for anchors at particles, and at bodies outside the group.
std::optional<CopiedBodies::End> end_of(const std::vector<BodyId>& taken, const Anchor& anchor) {
  if (anchor.kind == Anchor::Kind::particle) return std::nullopt;
  return end_of(taken, anchor.kind == Anchor::Kind::body ? anchor.body : BodyId{});
}

/// The ids of the copies, which the world creates only at its next tick.
struct Made {
  std::vector<BodyId> ids;
  std::vector<std::string> names, joints;  ///< of bodies, of joints

  BodyId id(CopiedBodies::End end) const { return end ? ids[*end] : BodyId{}; }
  std::string name(CopiedBodies::End end) const { return end ? names[*end] : ""; }
};

void add_joint(World& world, const CopiedBodies::Joint& joint, Made& made, const Pose& way,
               std::vector<SceneEdit>& edits) {
  JointDef def = joint.def;
  def.a = made.id(joint.a);
  def.b = made.id(joint.b);
  if (!joint.a) def.frame_a = way * def.frame_a;
  if (!joint.b) def.frame_b = way * def.frame_b;
  const std::string base = def.name.empty() ? std::string(entry_of(def.kind).name)
                                            : def.name.substr(0, def.name.find('['));
  def.name = base;
  const auto taken = [&] {
    return std::ranges::find(made.joints, def.name) != made.joints.end() ||
           !world.find_joint(def.name).is_null() || !world.find_joint(def.name + "[0]").is_null();
  };
  for (int n = 2; taken(); ++n) def.name = fmt::format("{}_{}", base, n);
  if (!world.create_joint(def)) return;
  made.joints.push_back(def.name);
  edits.push_back(AddedJoint{std::move(def), made.name(joint.a), made.name(joint.b)});
}

void add_spring(World& world, const CopiedBodies::Spring& spring, const Made& made, const Pose& way,
                std::vector<SceneEdit>& edits) {
  SpringDef def = spring.def;
  std::string names[2];
  int k = 0;
  for (const auto& [anchor, end] : {std::pair(&def.a, spring.a), std::pair(&def.b, spring.b)}) {
    if (end) {
      anchor->body = made.id(end);
      names[k] = made.name(end);
    } else {
      anchor->point = way.point(anchor->point);
    }
    ++k;
  }
  const auto force = world.create_force(def);
  if (force) edits.push_back(AddedSpring{def, {}, names[0], names[1], *force});
}

}  // namespace

CopiedBodies take_copies(const World& world, std::span<const BodyId> bodies) {
  CopiedBodies group;
  std::vector<BodyId> taken;
  for (const BodyId id : bodies)
    if (auto def = world.body_def(id)) {
      group.bodies.push_back(*std::move(def));
      taken.push_back(id);
    }
  const auto frame = world.frame();
  for (const JointFrame& shown : *frame->joints) {
    const JointDef* def = world.joint(shown.id);
    if (!def) continue;
    const auto a = end_of(taken, def->a), b = end_of(taken, def->b);
    if (a && b && (*a || *b)) group.joints.push_back({*def, *a, *b});
  }
  for (const ForceFrame& shown : frame->forces) {
    const auto* spring = std::get_if<SpringDef>(&shown.def);
    if (!spring) continue;
    const auto a = end_of(taken, spring->a), b = end_of(taken, spring->b);
    if (a && b && (*a || *b)) group.springs.push_back({*spring, *a, *b});
  }
  return group;
}

Result<std::vector<BodyId>> add_copies(World& world, const CopiedBodies& group, const Pose& way,
                                       std::vector<SceneEdit>& edits, bool of_this_scene) {
  Made made;
  for (BodyDef def : group.bodies) {
    const std::string original = of_this_scene ? def.name : "";
    def.pose = way * def.pose;
    def.name = new_body_name(world, def.name, made.names);
    def.starts_asleep = false;
    def.course = nullptr;  // its course begins where the original's begins
    const auto id = world.create_body(def);
    if (!id) return id.error();
    made.ids.push_back(*id);
    made.names.push_back(def.name);
    edits.push_back(AddedBody{std::move(def), nullptr, original});
  }
  for (const CopiedBodies::Joint& joint : group.joints) add_joint(world, joint, made, way, edits);
  for (const CopiedBodies::Spring& spring : group.springs)
    add_spring(world, spring, made, way, edits);
  return made.ids;
}

}  // namespace tumble
