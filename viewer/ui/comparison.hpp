#pragma once
#include "engine/dynamics/bodies/body.hpp"
#include "engine/world/settings.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace tumble {

/// How world B is drawn: transparently in the picture of A, in a picture of its own beside it, or
/// not.
enum class ComparedAs : uint8_t { ghost, beside, hidden };

/// Choices with which a world of a scene is made; the second world of a comparison has other ones.
struct WorldChoice {
  WorldSettings settings;
  /// Numbers that the scene declares, by name.
  std::vector<std::pair<std::string, double>> numbers;
  int threads = 0;   ///< 0: one per core
  std::string simd;  ///< of simd_targets(); "": the best one
};

/// A setting whose value differs between two worlds.
struct WorldDifference {
  std::string path;  ///< as the option --set names it: "settings.stepper", "parameters.balls";
                     ///< "threads" and "simd" do not belong to a scene
  std::string value_a, value_b;  ///< as the option --set takes them
  std::string words_a, words_b;  ///< for display: "event", "gravity 0 -1.6 0 m/s2"
};

/// A contact that differs between two worlds.
struct ContactDifference {
  BodyId a, b;
  Vec3 x_world = Vec3::Zero();  ///< [m]
  std::string what;             ///< "ball and floor: only in A"
  uint64_t tick = 0;            ///< of A
};

/// Comparison of world A, which is shown, with world B, which differs by its choice; read by
/// panels.
struct WorldComparison {
  WorldChoice choice;                        ///< of B
  std::vector<WorldDifference> differences;  ///< present differences in settings
  bool from_start = false;    ///< B has other numbers, so both began at the start of the scene
  bool opening = false;       ///< B is being made
  bool alone = false;         ///< B has other bodies than A:
                              ///< commands to A are not applied to it
  std::vector<double> times;  ///< the latest times that both worlds have reached [s]
  /// Greatest distance at these times, over bodies and particles [m].
  std::vector<float> distances;
  double distance = 0, angle = 0;  ///< greatest at present [m], [rad]
  double worst = 0;                ///< greatest since the beginning [m]
  std::string what;  ///< the body or particle with the greatest present distance; "": none
  std::optional<uint64_t> first_tick;  ///< first tick of A at which they differ; none: they do not
  std::string first_what;              ///< what differed first
  BodyId first_body;                   ///< null if it is not a body, or no longer exists
  /// First contact that differs; none: all are the same.
  std::optional<ContactDifference> first_contact;
  std::string fault;  ///< why B has stopped; "": it runs
};

}  // namespace tumble
