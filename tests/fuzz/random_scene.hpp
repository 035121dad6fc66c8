#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace tumble {

/// A random but valid scene of 2 to 10 bodies in a closed box, as the text of a scene file.
struct RandomScene {
  std::string text;
  /// No size, speed or stiffness is extreme: cells of 0.1 to 1 m, at most 3 m/s, soft springs.
  bool ordinary = false;
  double half_room = 0;       ///< from the centre of the box, which is the origin, to its walls [m]
  std::vector<double> radii;  ///< of a sphere that holds body b0, b1, ... [m]
  bool explicit_euler = false;  ///< the integrator whose error of energy is of first order
};

/// The scene of a seed for a stepper (`realtime` or `event`): the same text on every machine.
/// Bodies have every kind of shape (all_shapes()), meshes of assets/meshes and several shapes;
/// there may be joints of every kind, springs, fields, and particles with and without springs
/// between them; settings of both steppers and of every stage are drawn. Every body begins in a
/// cell of its own, so nothing overlaps. Springs that an explicit integrator cannot follow, of
/// omega h above 0.2, are drawn for `realtime` and for implicit integrators only: the others'
/// breakdown is no fault of the engine.
RandomScene random_scene(uint64_t seed, const std::string& stepper);

}  // namespace tumble
