#include "viewer/app/selected_def.hpp"

#include "engine/world/world.hpp"

namespace tumble {

void SelectedDef::update(Session& session, const Frame& frame, BodyId selected) {
  if (answer_.valid()) {
    if (answer_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return;
    def_ = answer_.get();
  }
  if (selected != asked_) def_ = nullptr;
  if (selected == asked_ && frame.infos == asked_with_) return;
  asked_ = selected;
  asked_with_ = frame.infos;
  if (selected.is_null()) return;
  answer_ = session.call([selected](World& world) -> std::shared_ptr<const BodyDef> {
    auto def = world.body_def(selected);
    return def ? std::make_shared<const BodyDef>(*std::move(def)) : nullptr;
  });
}

void SelectedDef::expect(const EditBody& edit) {
  if (!def_ || edit.id != asked_) return;
  auto changed = std::make_shared<BodyDef>(*def_);
  edit.change(*changed);
  def_ = std::move(changed);
  asked_with_ = nullptr;  // ask again, whether the world agrees or not
}

}  // namespace tumble
