#include "viewer/app/editing/clipboard.hpp"

#include "engine/collision/shape.hpp"
#include "engine/world/world.hpp"

namespace tumble {
namespace {

/// Bounds of all bounded shapes of the group.
Aabb bounds_of(const CopiedBodies& group) {
  Aabb out;
  for (const BodyDef& body : group.bodies)
    for (const BodyShapeDef& part : body.shapes)
      if (const auto shape = make_shape(part.shape); shape && !(*shape)->is_half_space())
        out.include((*shape)->bounds(body.pose * part.pose));
  return out;
}

}  // namespace

void BodyClipboard::copy(Session& session, const Selection& bodies, const std::string& scene) {
  scene_ = scene;
  count_ = bodies.size();
  group_ = std::make_shared<CopiedBodies>();
  session.post(
      [group = group_, all = bodies.all()](World& world) { *group = take_copies(world, all); });
}

std::future<std::vector<BodyId>> BodyClipboard::paste(Session& session, const std::string& scene,
                                                      const PastePlace& place, UndoStepEdits edits,
                                                      Refusal refusal) const {
  return session.call([group = group_, place, same = scene == scene_, edits = std::move(edits),
                       refusal](World& world) -> std::vector<BodyId> {
    const Aabb box = bounds_of(*group);
    Vec3 aside = Vec3::Zero();
    if (!box.empty()) {
      const Vec3& n = place.normal;
      const Vec3 half = 0.5 * box.extent();
      aside = place.x + n.cwiseAbs().dot(half) * n - box.centre();
    }
    auto made = add_copies(world, *group, {aside, Quat::Identity()}, *edits, same);
    if (made) return *std::move(made);
    refusal.say(made.error());
    return {};
  });
}

}  // namespace tumble
