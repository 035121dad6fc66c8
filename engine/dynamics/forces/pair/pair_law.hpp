#pragma once
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace tumble {

/// How a pair potential U ends at its cut-off rc.
enum class Truncation : uint8_t {
  truncated,  ///< U up to rc, nothing beyond: energy jumps there by U(rc)
  shifted,    ///< U - U(rc): energy is continuous, the force jumps
  smoothed,   ///< U times a polynomial that falls from 1 at `smooth_from` to 0 at rc with two
              ///< continuous derivatives: 1 - 10 s^3 + 15 s^4 - 6 s^5
};

/// A natural cubic spline through the points of a table.
struct PairTable {
  std::vector<double> r, energy, curvature;  ///< [m], [J], [J/m2]; r ascends

  PairTable() = default;
  PairTable(std::vector<double> r, std::vector<double> energy);
};

/// The energy of two points at a distance r, for weights of one: times the product of the points'
/// weights (charges, masses) it is theirs. A value for the kernels that sum over pairs.
struct PairLaw {
  enum class Kind : uint8_t {
    lennard_jones,     ///< 4 strength ((length/r)^12 - (length/r)^6)
    inverse_distance,  ///< strength / sqrt(r^2 + length^2)
    morse,             ///< strength (exp(-2 a (r - length)) - 2 exp(-a (r - length)))
    table,
  };
  Kind kind = Kind::lennard_jones;
  double strength = 1;   ///< [J], of inverse_distance [J m]
  double length = 1;     ///< [m]
  double steepness = 1;  ///< a of Morse [1/m]
  PairTable table = {};
  double cutoff = std::numeric_limits<double>::infinity();  ///< rc [m]
  Truncation truncation = Truncation::truncated;
  double smooth_from = 0;  ///< [m]

  bool ends() const { return cutoff < std::numeric_limits<double>::infinity(); }

  /// What two points with a squared distance r2 > 0 do to each other.
  struct Value {
    double energy = 0;  ///< [J]
    /// -U'(r) / r: times the vector from one point to the other it is the force on the other [N/m].
    double push = 0;
  };
  /// With its end, by scalar arithmetic.
  Value at(double r2) const;
  /// As if it had no end.
  Value endless(double r2) const;
};

}  // namespace tumble
