#pragma once
#include "viewer/ui/panel.hpp"

namespace tumble {

/// Draws an editable field for each value of the description of the selected body
/// (scene/description/body.hpp), of its shapes and of their materials.
void draw_body_form(PanelContext& context, const BodyFrame& body, const BodyDef& def);
/// Draws one of these values of any body, if it has it; false if not. Its widget is called by
/// `mark` and the pin's value.
bool draw_pinned_body_value(PanelContext& context, const Pin& pin, const std::string& mark,
                            const BodyFrame& body, const BodyDef& def);

}  // namespace tumble
