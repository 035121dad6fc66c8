#pragma once
#include "tests/support/accuracy/case_world.hpp"

#include <array>

/// The cases A1 to A10: each runs its scene in an engine and gives the errors. A1, A3 and A10 are
/// those of SimBenchmark (Kang and Hwangbo 2018).
namespace tumble::test {

/// A1: 150 N pull a slab of 10 kg over the ground (friction 0.4), 25 balls of 1 kg roll on it
/// (0.8): a = (150 - 0.4 35 g) / (10 + 25 2/7), of the balls 2/7 of it. Relative to the exact
/// speeds, at the end.
struct RollingErrors {
  double slab = 0, ball = 0;
  double along = 0;  ///< speed of the slab along the force over the exact one
};
CaseScene rolling_scene();
RollingErrors a1_rolling(const CaseMaker& maker, int hz, const Vec3& direction, double seconds = 4);

/// A2: a ball of 10 kg and radius 0.1 m falls from 5 m and bounces with restitution 1.
struct BounceErrors {
  double energy_end = 0, energy_most = 0;  ///< of 10 g 4.9 J
  double height = 0;                       ///< greatest difference of y + v^2 / 2g from 5 m [m]
  double place = 0;  ///< greatest difference from the parabolas, at any tick [m]
};
BounceErrors a2_bounces(const CaseMaker& maker, int hz, double seconds = 20);

/// The block of 6 x 6 x 6 balls of 10 kg, radius 0.1 m, 0.21 m apart but for a little chance.
std::vector<CaseBody> block_of_balls(double lowest, double restitution, uint64_t draw = 42);

/// A3: the block falls on the floor, all elastic. A3z: its halves meet without gravity.
struct GasErrors {
  double energy_end = 0, energy_most = 0;  ///< of the energy at the start
  double momentum = 0;                     ///< A3z: greatest change, of 1080 kg m/s
};
CaseScene gas_scene(bool gravity);
GasErrors a3_gas(const CaseMaker& maker, int hz, bool gravity, double seconds);

/// A4: the first of five elastic unit balls in a row comes at 1 m/s, without gravity; the others
/// are `gap` apart.
struct CradleErrors {
  std::array<double, 5> v{};  ///< along the row, 3 s later [m/s]
  double velocity = 0;        ///< root of the sum of squares, against 0 0 0 0 1
  double energy = 0;          ///< over that at the start, less 1
};
CradleErrors a4_cradle(const CaseMaker& maker, int hz, double gap);

/// A5: two rods of 1 m and 1 kg on ball joints, released horizontally. Of 2 g 1 J.
struct PendulumErrors {
  double energy_10s = 0, energy_end = 0, energy_most = 0;
  double joint = 0;  ///< how far the joints came apart [m]
};
PendulumErrors a5_double_pendulum(const CaseMaker& maker, int hz, double seconds = 60);

/// A6: a body with inertia (0.5, 1, 1.3) kg m2 turns about its middle axis at 5 rad/s, a little
/// off.
struct HandleErrors {
  double momentum_end = 0, momentum_most = 0;  ///< angular, of that at the start
  double energy_end = 0, energy_most = 0;      ///< of that at the start
  int flips = 0, flips_wanted = 0;
};
HandleErrors a6_handle(const CaseMaker& maker, int hz, double seconds = 60);

/// A7: a cube of 10 kg, friction 0.5, rests for a second; then gravity tilts towards a horizontal
/// direction until its tangent is `slope`. How far it went along that direction, and how fast.
struct Slide {
  double distance = 0, speed = 0;  ///< along the direction [m], [m/s]
  double across = 0;               ///< how far to the side [m]
};
Slide a7_slide(const CaseMaker& maker, int hz, const Vec3& direction, double slope, double seconds);
struct FrictionErrors {
  double coefficient = 0;   ///< found by halving, from what slides more than 1 cm in 2 s
  double acceleration = 0;  ///< relative error at a slope of 0.8
  double creep = 0;         ///< in 5 s at a slope of 0.45 [m]
};
FrictionErrors a7_friction(const CaseMaker& maker, int hz, const Vec3& direction);

/// A8: a cube of 1 kg carries one of `mass` for 10 s.
struct SinkErrors {
  double end = 0, most = 0;  ///< how far the upper one sank [m]
  double speed = 0;          ///< of the upper one at the end [m/s]
};
SinkErrors a8_sink(const CaseMaker& maker, int hz, double mass);

/// A9: a house of cards, 5 storeys, leaning by 25 degrees, friction 0.7.
struct CardErrors {
  double moved_1s = 0, moved_end = 0;  ///< of the card that moved farthest [m]
  int fallen = 0, cards = 0;           ///< fallen: moved farther than 5 cm
  double kinetic = 0;                  ///< at the end [J]
};
CaseScene card_house(int storeys = 5);
CardErrors a9_cards(const CaseMaker& maker, int hz, double seconds = 10, int storeys = 5);

/// A10: the block of balls falls on the floor without any restitution or friction. Greatest overlap
/// of any two, at any tick [m]. Where the balls stand aside of each other at the start is drawn,
/// and much depends on it: over 100 draws the realtime stepper is at 0.3 to 13 mm, half of them
/// below 0.75 mm.
double a10_penetration(const CaseMaker& maker, int hz, double seconds = 3, uint64_t draw = 42);

}  // namespace tumble::test
