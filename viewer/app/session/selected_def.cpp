#include "viewer/app/session/selected_def.hpp"

#include "engine/world/world.hpp"

namespace tumble {

void SelectedDef::update(Session& session, const Frame& frame, BodyId selected) {
  if (answer_.valid()) {
    if (answer_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return;
    Known known = answer_.get();
    def_ = std::move(known.def);
    joints_ = std::move(known.joints);
  }
  if (selected != asked_) {
    def_ = nullptr;
    joints_ = nullptr;
  }
  if (selected == asked_ && frame.infos == asked_with_) return;
  asked_ = selected;
  asked_with_ = frame.infos;
  if (selected.is_null()) return;
  answer_ = session.call([selected](World& world) -> Known {
    auto def = world.body_def(selected);
    if (!def) return {};
    Joints joints;
    const auto frame_now = world.frame();
    for (const JointFrame& joint : *frame_now->joints)
      if (const JointDef* made = world.joint(joint.id);
          made && (joint.a == selected || joint.b == selected))
        joints.push_back({joint.id, *made, joint.a == selected ? joint.b : joint.a});
    return {std::make_shared<const BodyDef>(*std::move(def)),
            std::make_shared<const Joints>(std::move(joints))};
  });
}

void SelectedDef::expect(const EditJoint& edit) {
  if (!joints_) return;
  auto changed = std::make_shared<Joints>(*joints_);
  for (SelectedJoint& joint : *changed)
    if (joint.id == edit.id) edit.change(joint.def);
  joints_ = std::move(changed);
  ask_again();
}

void SelectedDef::expect(const EditBody& edit) {
  if (!def_ || edit.id != asked_) return;
  auto changed = std::make_shared<BodyDef>(*def_);
  edit.change(*changed);
  def_ = std::move(changed);
  ask_again();  // whether or not the world accepts the edit
}

}  // namespace tumble
