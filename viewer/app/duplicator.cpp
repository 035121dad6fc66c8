#include "viewer/app/duplicator.hpp"

#include "engine/world/world.hpp"
#include "viewer/app/new_name.hpp"
#include "viewer/interact/picking.hpp"

namespace tumble {
void Duplicator::copy(Session& session, BodyId body, const Vec3& aside, bool repeat,
                      DeedEdits edits) {
  const BodyId before = repeat && body == copy_ ? original_ : BodyId{};
  original_ = body;
  made_ = session.call([body, before, aside, edits = std::move(edits)](World& world) -> BodyId {
    auto def = world.body_def(body);
    if (!def) return {};
    const auto first = before.is_null() ? std::nullopt : world.body_def(before);
    if (first)
      def->pose = def->pose * (first->pose.inverse() * def->pose);
    else
      def->pose.x += aside;
    def->name = new_body_name(world, def->name);
    def->starts_asleep = false;
    def->course = nullptr;  // its way begins where the original began
    const auto made = world.create_body(*def);
    if (!made) return {};
    edits->push_back(AddedBody{*std::move(def)});
    return *made;
  });
}

std::optional<BodyId> Duplicator::take(const Frame& shown) {
  if (made_.valid() && made_.wait_for(std::chrono::seconds(0)) == std::future_status::ready) {
    copy_ = made_.get();
    awaited_ = !copy_.is_null();
  }
  if (!awaited_ || !find_slot(shown, copy_)) return std::nullopt;
  awaited_ = false;
  return copy_;
}

}  // namespace tumble
