#pragma once
#include "engine/core/bytes.hpp"
#include "engine/core/result.hpp"

#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

namespace tumble {

/// As what particles are drawn.
enum class ParticleStyle : uint8_t {
  spheres,  ///< one lit sphere each
  surface,  ///< all together as the smooth surface of a clear liquid
  smoke,    ///< soft puffs, of `opacity` in their middle
};

/// What the colour of a sphere may tell.
enum class ParticleQuantity : uint8_t {
  none,      ///< its own colour
  speed,     ///< [m/s]
  age,       ///< [s]
  density,   ///< of fluids [kg/m3]
  pressure,  ///< of fluids [Pa]
};

/// How the particles of a system look; carried for the viewer, without effect on the motion.
struct ParticleLook {
  ParticleStyle style = ParticleStyle::spheres;
  ParticleQuantity colour_by = ParticleQuantity::none;
  /// Values at the two ends of the colour map; equal: the least and the greatest that there have
  /// been since the start, see ParticleSystem::seen.
  double low = 0, high = 0;
  /// Of a surface: the way through the liquid on which light takes on its colour [m]; 0: twenty
  /// radii of a particle.
  double clarity = 0;
  double foam = 1;       ///< of a surface: how white broken liquid is, 0..1
  double opacity = 0.4;  ///< of smoke, in the middle of a puff, 0..1
  double trail = 0;      ///< length of the path that is drawn behind each; 0: none [s]

  bool finds_range() const { return colour_by != ParticleQuantity::none && low == high; }
};

/// The smallest range that holds what it was given; empty at first.
struct ValueRange {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();
  bool empty() const { return !(low <= high); }
  void include(double x) {
    if (x < low) low = x;
    if (x > high) high = x;
  }
};

/// "speed", "m/s".
struct QuantityName {
  std::string_view name, unit;
};
QuantityName name_of(ParticleQuantity quantity);

/// `fluid`: of a system that is one.
Status validate(const ParticleLook& look, bool fluid);

/// Exactly: all numbers as they are, and back; not checked.
void save(ByteWriter& out, const ParticleLook& look);
ParticleLook load_particle_look(ByteReader& in);

struct ParticleSystem;
/// A quantity of every particle, over what `out` held; empty for `none`.
void quantity_values(const ParticleSystem& particles, ParticleQuantity quantity,
                     std::vector<float>& out);
/// ParticleSystem::seen takes in the present values, where the look asks for that.
void note_quantity(ParticleSystem& particles);

}  // namespace tumble
