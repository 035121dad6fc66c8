#pragma once
#include "engine/world/frame.hpp"
#include "viewer/render/overlays.hpp"
#include "viewer/render/render_scene.hpp"

#include <string>
#include <vector>

namespace tumble {

/// Adds an arrow that is slender, so that it does not hide its object; inside bodies it is drawn as
/// a line. `size`: size of the object it belongs to [m].
void add_thin_arrow(RenderScene& out, const Vec3& from, Vec3 along, double size,
                    const Vec4f& colour, Occlusion within = Occlusion::faint);

/// The value that an arrow of one metre stands for. Round numbers that depend only on sizes, masses
/// and gravity, so that the scale does not change while things move.
struct VectorScales {
  double velocity = 4;  ///< [m/s]
  double momentum = 1;  ///< [kg m/s]
  /// Of particles, which may have a millionth of the mass of a body [kg m/s].
  double particle_momentum = 1;
  double force = 1;  ///< [N]
};
VectorScales vector_scales(const Frame& frame, const Overlays& overlays);

/// Text for the legend such as "1 m is 20 N".
std::string velocity_scale(const Frame& frame, const Overlays& overlays);
std::string momentum_scale(const Frame& frame, const Overlays& overlays);
/// The same for particles, with the number of those that have arrows if not all have.
std::string particle_velocity_scale(const Frame& frame, const Overlays& overlays);
std::string particle_momentum_scale(const Frame& frame, const Overlays& overlays);
std::string force_scale_words(const Frame& frame, const Overlays& overlays);

/// Mean total force on a body, contacts and constraints included, over the tick between two frames
/// [N]: the change of its momentum over the length of the tick. Empty for bodies that did not exist
/// in both frames, were moved by hand, or do not move freely (static, kinematic).
std::optional<Vec3> mean_total_force(const Frame& before, const Frame& now, size_t slot);

/// Adds velocities, momenta and total forces of bodies, and velocities and momenta of at most a
/// thousand particles. `before`: the frame of the tick before; if it is null, total forces and the
/// arrows of particles are left out.
void add_vectors(const Frame& frame, const Frame* before, const std::vector<Pose>& poses,
                 const Overlays& overlays, RenderScene& out);

}  // namespace tumble
