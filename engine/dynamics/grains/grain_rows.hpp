#pragma once
#include "engine/math/types.hpp"

#include <array>
#include <cstdint>

namespace tumble {

/// Velocity and inverse mass of a grain between the parts of a tick; one cache line.
struct alignas(64) GrainMover {
  Vec3 v = Vec3::Zero();      ///< of the centre [m/s]
  double inverse_mass = 0;    ///< 0 while it sleeps [1/kg]
  Vec3 spin = Vec3::Zero();   ///< angular velocity [rad/s]
  double inverse_moment = 0;  ///< inverse moment of inertia; 0 while asleep [1/(kg m2)]
};

/// Position and radius of a grain; half a cache line.
struct alignas(32) GrainPoint {
  Vec3 x = Vec3::Zero();  ///< [m]
  double radius = 0;      ///< [m]
};

/// The same while contacts are solved; half a cache line. Inverse masses are relative to a unit of
/// mass (GrainSystemRows::mass_unit), so that no product of small numbers leaves the range of
/// single precision.
struct alignas(32) GrainRow {
  std::array<float, 3> v{};     ///< [m/s]
  float inverse_mass = 0;       ///< of the unit of mass; 0 while it sleeps [-]
  std::array<float, 3> spin{};  ///< [rad/s]
  float inverse_moment = 0;     ///< times the unit of mass; 0 while asleep [1/m2]
};

/// How far a grain has moved since the beginning of the part: single precision resolves this a
/// thousand times better than a position.
struct alignas(16) GrainShift {
  std::array<float, 3> x{};  ///< [m]
  float inverse_mass = 0;    ///< as in GrainRow
};

/// A body that grains touch.
struct GrainBody {
  uint32_t slot = 0;
  bool gives_way = false;  ///< dynamic and awake: grains can move it
  double inverse_mass = 0;
  Vec3 x = Vec3::Zero(), v = Vec3::Zero(), omega = Vec3::Zero();
  Mat3 inverse_inertia = Mat3::Zero();  ///< world axes
};

/// One contact of a grain with a shape of a body. Impulses are on the body, of the present
/// sub-step; `n` points from the grain to the shape. (Contacts of two grains are lanes of a
/// GrainBundle.).
struct GrainBodyRow {
  uint32_t a = 0, b = 0;  ///< place of the grain; index of the body
  uint64_t key = 0;       ///< of the shape: shape_key()
  Vec3 n = Vec3::UnitY();
  double gap = 0;    ///< negative where they overlap [m]
  double arm_a = 0;  ///< from the grain's centre along n [m]
  double normal_mass = 0, slip_mass = 0,
         turn_mass = 0;  ///< effective masses: normal, tangential, rotational [kg], [kg], [kg m2]
  double friction = 0;   ///< [-]
  double rolling = 0, twisting = 0;  ///< lever arms of rolling and torsional friction [m]
  double restitution = 0;            ///< [-]
  double approach = 0;               ///< speed at the beginning of the part, negative towards
                                     ///< each other [m/s]
  double push = 0;                   ///< normal impulse [N s]
  Vec3 rub = Vec3::Zero(),
       turn = Vec3::Zero();     ///< friction impulse [N s]; angular impulse [N m s]
  double most = 0;              ///< greatest normal impulse in the part [N s]
  double lift = 0;              ///< separation speed per overlap [1/s]
  double slop = 0;              ///< overlap that is not corrected [m]
  double lost = 0, rubbed = 0;  ///< work of the normal impulse, and of the
                                ///< others, in the part [J]
  Vec3 from = Vec3::Zero();     ///< the grain's centre at the start of the part [m]
  double gap_from = 0;          ///< gap at that time [m]
  double drift = 0;             ///< velocity of the shape's surface along n in the part [m/s]
  Vec3 arm = Vec3::Zero();      ///< from the body's centre of mass to the contact [m]
  Vec3 belt = Vec3::Zero();     ///< velocity of the surface relative to the body (belts) [m/s]
  Vec3 given = Vec3::Zero();    ///< normal impulse over the part [N s]
  Vec3 rubbing = Vec3::Zero(),
       turning = Vec3::Zero();  ///< friction and angular impulse over the part
};

}  // namespace tumble
