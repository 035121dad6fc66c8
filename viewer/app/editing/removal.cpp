#include "viewer/app/editing/removal.hpp"

#include "engine/scene/reader.hpp"
#include "engine/world/world.hpp"

#include <set>
#include <utility>

namespace tumble {
namespace {

/// Whether the part can be replaced without losing its state. Sensors and particle systems would
/// begin anew; the world itself has dropped their references to what was removed.
bool goes_on_when_set(const PartDescription& part) {
  return std::holds_alternative<EmitterDescription>(part) ||
         std::holds_alternative<ForceDescription>(part);
}

}  // namespace

Removal::Removal(const SceneFile& file, std::vector<UndoStepEdits> undo_steps, UndoStepEdits edits,
                 const PartsController& controller, Refusal told)
    : undo_steps_(std::move(undo_steps)),
      edits_(std::move(edits)),
      parts_(controller.parts()),
      live_(controller.live()),
      told_(std::move(told)) {
  taking_->text = file.text;
  taking_->file = file.path.string();
}

void Removal::take(World& world, const SceneEdit& removal) const {
  std::vector<TakenAlong> along;
  if (!taking_->text.empty()) {
    if (!taking_->rest) {
      std::vector<SceneEdit> before;
      for (const UndoStepEdits& undo_step : undo_steps_)
        before.insert(before.end(), undo_step->begin(), undo_step->end());
      taking_->rest = std::make_unique<FileRemovals>(taking_->text, before);
    }
    along = taking_->rest->take(removal);
  }
  edits_->push_back(removal);
  for (TakenAlong& one : along) {
    if (const auto part = find_part(*parts_, one.list, one.name); part && one.rest.empty()) {
      (void)live_->remove(world, one.name, *part);
      edits_->push_back(RemovedPart{one.name, *part});
    }
    taking_->along.push_back(std::move(one));
  }
}

void Removal::describe_anew(World& world) const {
  std::set<std::pair<std::string, std::string>> changed;
  for (const TakenAlong& one : taking_->along)
    if (!one.rest.empty() && find_part(*parts_, one.list, one.name))
      changed.emplace(one.list, one.name);
  if (changed.empty()) return;
  const SceneRead left = read_scene(taking_->rest->text(), taking_->file);
  if (!left.ok()) return;
  (void)world.apply_commands();
  const SceneDescription parts = parts_of(left.scene);
  for (const auto& [list, name] : changed) {
    const auto part = find_part(parts, list, name);
    if (!part) continue;  // it was removed later
    if (goes_on_when_set(*part)) (void)live_->set(world, parts, name, *part);
    // Equal before and after: the removal itself has already changed the file.
    edits_->push_back(ChangedPart{name, *part, *part});
  }
}

void Removal::finish(World& world) const {
  describe_anew(world);
  std::vector<std::string> lines;
  for (const TakenAlong& one : taking_->along) lines.push_back(one.words());
  if (!lines.empty()) told_.tell(std::move(lines));
  if (taking_->rest) told_.leave(taking_->rest->text());
}

}  // namespace tumble
