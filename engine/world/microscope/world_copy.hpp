#pragma once
#include "engine/world/microscope/microscope.hpp"
#include "engine/world/world_def.hpp"

namespace tumble {

struct BodyInfo;
struct Frame;

/// A copy of a world, run on the calling thread: its next ticks are those of the original if no
/// command intervenes. With `stepper` it goes on by that one. Error: the copy could not be made.
Result<std::unique_ptr<World>> copy_of(const World& world, std::string_view stepper = {});

/// "" for a body that exists and is dynamic; else why nothing can be recorded about it. `wanted`:
/// what the algorithm shows, for the message when no body is given.
std::string moving_body_refusal(const Frame& frame, BodyId body, std::string_view wanted);

/// The name of the body in a slot, or "body 7".
std::string body_text(const Frame& frame, uint32_t slot);

/// Draws the outline of a body's shapes, with the body at this pose.
void draw_outline(Sketch& out, const BodyInfo& info, const Pose& pose, Ink ink, float width);
/// The largest bounding radius of a body's bounded shapes [m].
double body_size(const BodyInfo& info);

}  // namespace tumble
