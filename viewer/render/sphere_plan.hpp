#pragma once
#include "viewer/render/disc_occlusion.hpp"
#include "viewer/render/draw_plan.hpp"

namespace tumble {

/// Sorts the scene's particles into the plan's sphere runs and adds to its counts. Spheres that are
/// not drawable() or hold the eye are left out.
void plan_spheres(const RenderScene& scene, const ViewSetup& view, DrawPlan& plan);

/// A sphere as the camera sees it. The disc through the centre across the view lies inside the
/// sphere and shows as a true circle; the outline is bounded by the sphere's nearest point. Without
/// an outline for a sphere around the eye.
ProjectedDisc disc_in_picture(const ViewSetup& view, const Vec3& centre, double radius,
                              bool covers);
/// DiscOcclusion in cells that suit the discs, which are changed by that; there must be some.
void find_hidden(DiscOcclusion& occlusion, std::vector<ProjectedDisc>& discs, int width, int height,
                 std::vector<uint8_t>& hidden);

}  // namespace tumble
