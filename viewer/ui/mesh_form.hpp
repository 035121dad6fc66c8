#pragma once
#include "viewer/ui/panel.hpp"

namespace tumble {

/// Draws the choice of the collision representation of a mesh of the selected body and, on request,
/// a comparison of all of them by error, size and cost. Draws nothing if the body has no mesh.
void draw_mesh_form(PanelContext& context, const BodyDef& def);

}  // namespace tumble
