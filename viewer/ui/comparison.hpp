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
  std::vector<WorldDifference> differences;  ///< in what A and B differ now
  bool from_start = false;                   ///< B has other numbers: both began at the start
  bool opening = false;                      ///< B is being made
  double behind = 0;                   ///< how far B is from A's moment while it catches up [s]
  bool alone = false;                  ///< it is not made of the same bodies as A:
                                       ///< what is done to A is not done to it
  std::vector<double> times;           ///< of the latest moments that both have [s]
  std::vector<float> distances;        ///< greatest, then, of bodies and particles [m]
  double distance = 0, angle = 0;      ///< now [m], [rad]
  double worst = 0;                    ///< greatest so far [m]
  std::string what;                    ///< where it is greatest now; "": nowhere
  std::optional<uint64_t> first_tick;  ///< of A, from which on they differ; none: they do not
  std::string first_what;              ///< what differed first
  BodyId first_body;                   ///< null when that is no body, or gone
  std::optional<ContactDifference> first_contact;  ///< that differed; none: all are the same
  std::string fault;                               ///< why B has stopped; "": it has not
};

}  // namespace tumble
