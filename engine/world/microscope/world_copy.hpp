#pragma once
#include "engine/world/microscope/microscope.hpp"
#include "engine/world/world_def.hpp"

namespace tumble {

struct BodyInfo;
struct Frame;

/// A world of its own in the state of another one, on the calling thread: what it does next is what
/// the other will do if nobody touches it. With `stepper` it goes on by that one. Error: the copy
/// could not be made.
Result<std::unique_ptr<World>> copy_of(const World& world, std::string_view stepper = {});

/// "" for a body that is there and that forces move; else why nothing can be asked about it.
/// `wanted`: what the algorithm looks at, for the case that no body is given.
std::string moving_body_refusal(const Frame& frame, BodyId body, std::string_view wanted);

/// The name of the body in a slot, or "body 7".
std::string body_text(const Frame& frame, uint32_t slot);

/// The outline of a body's shapes at a pose of it.
void draw_outline(Sketch& out, const BodyInfo& info, const Pose& pose, Ink ink, float width);
/// The greatest radius of a body's shapes that end somewhere [m].
double body_size(const BodyInfo& info);

}  // namespace tumble
