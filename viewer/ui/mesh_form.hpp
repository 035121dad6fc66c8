#pragma once
#include "viewer/ui/panel.hpp"

#include <string_view>

namespace tumble {

class ParameterWidgets;

/// What a mesh collides as, as people read it: "convex pieces".
std::string_view words_of(MeshMode mode);
/// A choice of what a mesh collides as; true if it was changed.
bool choose_mesh_mode(ParameterWidgets& widgets, MeshMode& mode, std::string_view help);

/// Draws the choice of the collision representation of a mesh of the selected body and, on request,
/// a comparison of all of them by error, size and cost. Draws nothing if the body has no mesh.
void draw_mesh_form(PanelContext& context, const BodyDef& def);

}  // namespace tumble
