#pragma once
#include "engine/scene/build/live_parts.hpp"
#include "viewer/app/editing/scene_saver.hpp"
#include "viewer/app/session/refusal.hpp"

#include <memory>
#include <vector>

namespace tumble {

/// Applies the edits of the scene's file by the user's changes to a world at its first tick, so
/// that it starts as the file would describe it. For jobs on the simulation thread. A value that an
/// edit did not change keeps its initial value, whenever the edit was made; a body that does not
/// exist at the start is skipped. Settings are not applied: see ShownSettings::restart. `parts`: as
/// the scene was opened. Rejections are reported to `refusal`.
void do_at_start(World& world, const std::vector<UndoStepEdits>& undo_steps,
                 const std::shared_ptr<const SceneDescription>& parts,
                 const std::shared_ptr<LiveParts>& live, const Refusal& refusal);

}  // namespace tumble
