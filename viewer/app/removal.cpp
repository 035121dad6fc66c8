#include "viewer/app/removal.hpp"

#include "engine/world/world.hpp"

#include <utility>

namespace tumble {

Removal::Removal(std::string text, std::vector<DeedEdits> deeds, DeedEdits edits,
                 const PartsDesk& desk, Refusal told)
    : text_(std::move(text)),
      deeds_(std::move(deeds)),
      edits_(std::move(edits)),
      parts_(desk.parts()),
      live_(desk.live()),
      told_(std::move(told)) {}

void Removal::take(World& world, const SceneEdit& removal) const {
  std::vector<TakenAlong> along;
  if (!text_.empty()) {
    std::vector<SceneEdit> before;
    for (const DeedEdits& deed : deeds_) before.insert(before.end(), deed->begin(), deed->end());
    along = taken_along(text_, before, removal);
  }
  edits_->push_back(removal);
  for (const TakenAlong& one : along) {
    along_->push_back(one.words());
    if (!one.rest.empty()) continue;
    const auto part = find_part(*parts_, one.list, one.name);
    if (!part) continue;
    (void)live_->remove(world, one.name, *part);
    edits_->push_back(RemovedPart{one.name, *part});
  }
}

void Removal::say() const {
  if (!along_->empty()) told_.tell(*along_);
}

}  // namespace tumble
