#pragma once
#include "engine/world/frame.hpp"
#include "viewer/render/overlays.hpp"
#include "viewer/render/render_scene.hpp"

#include <string>
#include <vector>

namespace tumble {

/// A slender arrow, so that it does not hide what it is of; within bodies a line stands for it.
/// `size`: of what it belongs to [m].
void add_thin_arrow(RenderScene& out, const Vec3& from, Vec3 along, double size,
                    const Vec4f& colour, Occlusion within = Occlusion::faint);

/// What an arrow of one metre stands for. Round numbers that follow from sizes, masses and gravity
/// alone: while things move the scale stays.
struct VectorScales {
  double velocity = 4;           ///< [m/s]
  double momentum = 1;           ///< [kg m/s]
  double particle_momentum = 1;  ///< of particles, which may weigh a millionth of a body [kg m/s]
  double force = 1;              ///< [N]
};
VectorScales vector_scales(const Frame& frame, const Overlays& overlays);

/// "1 m is 20 N", for the legend.
std::string velocity_scale(const Frame& frame, const Overlays& overlays);
std::string momentum_scale(const Frame& frame, const Overlays& overlays);
/// Of particles, with how many of them have arrows where not all do.
std::string particle_velocity_scale(const Frame& frame, const Overlays& overlays);
std::string particle_momentum_scale(const Frame& frame, const Overlays& overlays);
std::string force_scale_words(const Frame& frame, const Overlays& overlays);

/// The force that everything together exerted on a body, contacts and joints included, in the mean
/// of the tick between two frames [N]: by which its momentum changed. Nothing of bodies that were
/// not there, or were put elsewhere, and of those that do not move freely.
std::optional<Vec3> mean_total_force(const Frame& before, const Frame& now, size_t slot);

/// Velocities, momenta and total forces of bodies, velocities and momenta of particles, of which no
/// more than a thousand have arrows. `before`: the frame of the tick before, null where it is not
/// known; then there are no forces, and no arrows of particles.
void add_vectors(const Frame& frame, const Frame* before, const std::vector<Pose>& poses,
                 const Overlays& overlays, RenderScene& out);

}  // namespace tumble
