#pragma once
#include "viewer/ui/panel.hpp"

namespace tumble {

/// What a mesh of the selected body collides as: chosen here, and, when asked for, compared with
/// the other ways by error, size and cost. Nothing where the body has no mesh.
void draw_mesh_form(PanelContext& context, const BodyDef& def);

}  // namespace tumble
