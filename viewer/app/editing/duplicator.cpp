#include "viewer/app/editing/duplicator.hpp"

#include "engine/world/world.hpp"
#include "viewer/app/editing/copied_bodies.hpp"
#include "viewer/interact/picking.hpp"

namespace tumble {

void Duplicator::copy(Session& session, const Selection& bodies, const Vec3& aside, bool repeat,
                      UndoStepEdits edits) {
  const bool again = repeat && !copies_.empty() && bodies.main() == copies_.back();
  const BodyId before = again ? original_ : BodyId{};
  original_ = bodies.main();
  made_ = session.call([all = bodies.all(), before, aside,
                        edits = std::move(edits)](World& world) -> std::vector<BodyId> {
    const CopiedBodies group = take_copies(world, all);
    if (group.empty()) return {};
    Pose way{aside, Quat::Identity()};
    if (const auto first = before.is_null() ? std::nullopt : world.body_def(before))
      way = group.bodies.back().pose * first->pose.inverse();
    auto made = add_copies(world, group, way, *edits, true);
    return made ? *std::move(made) : std::vector<BodyId>{};
  });
}

void Duplicator::await(std::future<std::vector<BodyId>> copies) {
  original_ = {};
  made_ = std::move(copies);
}

std::vector<BodyId> Duplicator::take(const Frame& shown) {
  if (made_.valid() && made_.wait_for(std::chrono::seconds(0)) == std::future_status::ready) {
    copies_ = made_.get();
    awaited_ = !copies_.empty();
  }
  if (!awaited_ || !find_slot(shown, copies_.back())) return {};
  awaited_ = false;
  return copies_;
}

}  // namespace tumble
