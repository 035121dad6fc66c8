#pragma once
#include "engine/scene/build/live_parts.hpp"
#include "viewer/app/editing/scene_saver.hpp"
#include "viewer/app/session/refusal.hpp"

#include <memory>
#include <vector>

namespace tumble {

/// Does what deeds change about the scene's file to a world that stands at its beginning, so that
/// it begins as the file would say: for jobs on the simulation thread. A value that a deed did not
/// change is that of the beginning, whenever the deed was done; a body that is not there yet at the
/// beginning is left alone. Settings are not among what is done here: see ShownSettings::restart.
/// `parts`: as the scene was opened with them. What the world refuses is told to `refusal`.
void do_at_start(World& world, const std::vector<DeedEdits>& deeds,
                 const std::shared_ptr<const SceneDescription>& parts,
                 const std::shared_ptr<LiveParts>& live, const Refusal& refusal);

}  // namespace tumble
