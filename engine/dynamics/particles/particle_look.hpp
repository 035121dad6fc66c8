#pragma once
#include "engine/core/bytes.hpp"
#include "engine/core/result.hpp"

#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

namespace tumble {

/// How particles are drawn.
enum class ParticleStyle : uint8_t {
  spheres,  ///< a lit sphere for each
  surface,  ///< together, as the smooth surface of a clear liquid
  smoke,    ///< soft puffs, with `opacity` at their centre
};

/// Quantity that the colour of a sphere shows.
enum class ParticleQuantity : uint8_t {
  none,      ///< its own colour
  speed,     ///< [m/s]
  age,       ///< [s]
  density,   ///< of fluids [kg/m3]
  pressure,  ///< of fluids [Pa]
};

/// Appearance of the particles of a system, for the viewer; no effect on the motion.
struct ParticleLook {
  ParticleStyle style = ParticleStyle::spheres;
  ParticleQuantity colour_by = ParticleQuantity::none;
  /// Values at the two ends of the colour map; if equal, the least and greatest values since the
  /// start, see ParticleSystem::seen.
  double low = 0, high = 0;
  /// For a surface: length of the path through the liquid after which light takes on its colour
  /// [m]; 0: twenty particle radii.
  double clarity = 0;
  double foam = 1;       ///< for a surface: how white broken liquid is, 0..1
  double opacity = 0.4;  ///< for smoke: at the centre of a puff, 0..1
  double trail = 0;      ///< length of the path that is drawn behind each; 0: none [s]

  bool finds_range() const { return colour_by != ParticleQuantity::none && low == high; }
};

/// The smallest range that contains all included values; empty at first.
struct ValueRange {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();
  bool empty() const { return !(low <= high); }
  void include(double x) {
    if (x < low) low = x;
    if (x > high) high = x;
  }
};

/// Such as "speed", "m/s".
struct QuantityName {
  std::string_view name, unit;
};
QuantityName name_of(ParticleQuantity quantity);

/// `fluid`: whether the system is one.
Status validate(const ParticleLook& look, bool fluid);

/// Exact copies of all numbers; load does not check them.
void save(ByteWriter& out, const ParticleLook& look);
ParticleLook load_particle_look(ByteReader& in);

struct ParticleSystem;
/// Writes a quantity of every particle to `out`; empty for `none`.
void quantity_values(const ParticleSystem& particles, ParticleQuantity quantity,
                     std::vector<float>& out);
/// Includes the present values in ParticleSystem::seen, if the look asks for that.
void note_quantity(ParticleSystem& particles);

}  // namespace tumble
