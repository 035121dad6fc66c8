#pragma once
#include "viewer/render/disc_occlusion.hpp"
#include "viewer/render/draw_plan.hpp"

namespace tumble {

/// Sorts the scene's particles into the sphere runs of the plan and adds to its counts. Spheres
/// that are not drawable(), or contain the eye, are left out.
void plan_spheres(const RenderScene& scene, const ViewSetup& view, DrawPlan& plan);

/// The discs of a sphere in the camera's view. The great circle perpendicular to the direction of
/// view projects to a true circle, which the sphere covers; the outline is bounded by means of the
/// sphere's nearest point. A sphere around the eye has no outline, and gives an empty disc.
ProjectedDisc disc_in_picture(const ViewSetup& view, const Vec3& centre, double radius,
                              bool covers);
/// Calls DiscOcclusion with cells that suit the size of the discs, which are converted to cells in
/// place. `discs` must not be empty.
void find_hidden(DiscOcclusion& occlusion, std::vector<ProjectedDisc>& discs, int width, int height,
                 std::vector<uint8_t>& hidden);

}  // namespace tumble
