#pragma once
#include "viewer/ui/panel.hpp"

namespace tumble {

/// What the selected body is made from, to be changed: a widget for each value of its description
/// (scene/description/body.hpp), of its shapes and of their materials.
void draw_body_form(PanelContext& context, const BodyFrame& body, const BodyDef& def);

}  // namespace tumble
