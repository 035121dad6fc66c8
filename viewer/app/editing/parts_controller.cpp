#include "viewer/app/editing/parts_controller.hpp"

#include "engine/world/world.hpp"

namespace tumble {
namespace {

struct Fold {
  SceneDescription& parts;

  void operator()(const AddedPart& e) { put_part(parts, e.name, e.part); }
  void operator()(const ChangedPart& e) { put_part(parts, e.name, e.after); }
  void operator()(const RemovedPart& e) { drop_part(parts, list_of(e.part), e.name); }
  void operator()(const AddedSpring& e) {
    SpringDescription d;
    d.a.body = e.a;
    d.a.point = e.def.a.point;
    d.b.body = e.b;
    d.b.point = e.def.b.point;
    d.stiffness = e.def.stiffness;
    d.damping = e.def.damping;
    d.rest_length = e.def.rest_length;
    d.cable_radius = e.def.cable_radius;
    put_part(parts, e.name, ForceDescription{d});
  }
  void operator()(const auto&) {}
};

}  // namespace

void fold_part(SceneDescription& parts, const SceneEdit& edit) {
  std::visit(Fold{parts}, edit);
}

void PartsController::open(std::shared_ptr<const SceneDescription> parts,
                           std::shared_ptr<LiveParts> live) {
  *this = PartsController{};
  opened_ = parts ? std::move(parts) : std::make_shared<const SceneDescription>();
  now_ = opened_;
  live_ = live ? std::move(live) : std::make_shared<LiveParts>();
}

void PartsController::update(Session& session, const std::vector<UndoStepEdits>& undo_steps) {
  if (collected_.valid()) {
    if (collected_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return;
    auto folded = std::make_shared<SceneDescription>(*opened_);
    for (const SceneEdit& edit : collected_.get()) {
      fold_part(*folded, edit);
      if (const auto* spring = std::get_if<AddedSpring>(&edit))
        session.post(
            [live = live_, name = spring->name, id = spring->id](World&) { live->know(name, id); });
    }
    if (!stale_) now_ = std::move(folded);  // otherwise a newer answer will follow
  }
  if (!stale_) return;
  stale_ = false;
  collected_ = collect_edits(session, undo_steps);
}

void PartsController::name_springs(Session& session, UndoStepEdits edits) const {
  session.post([edits = std::move(edits), parts = now_, live = live_](World&) {
    for (SceneEdit& edit : *edits)
      if (auto* spring = std::get_if<AddedSpring>(&edit); spring && spring->name.empty()) {
        spring->name = live->new_force_name(*parts, "spring");
        live->know(spring->name, spring->id);
      }
  });
}

void PartsController::expect(const std::string& name, const PartDescription& part, bool gone) {
  auto changed = std::make_shared<SceneDescription>(*now_);
  if (gone)
    drop_part(*changed, list_of(part), name);
  else
    put_part(*changed, name, part);
  now_ = std::move(changed);
}

}  // namespace tumble
