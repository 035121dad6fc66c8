#pragma once
#include "viewer/render/draw_plan.hpp"

namespace tumble {

/// Sorts the scene's particles into the plan's sphere runs and adds to its counts. Spheres that are
/// not drawable() or hold the eye are left out.
void plan_spheres(const RenderScene& scene, const ViewSetup& view, DrawPlan& plan);

}  // namespace tumble
