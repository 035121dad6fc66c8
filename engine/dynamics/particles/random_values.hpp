#pragma once
#include "engine/core/random.hpp"
#include "engine/math/types.hpp"

#include <cstdint>

namespace tumble {

/// A number that is drawn for each particle.
struct RandomNumber {
  enum class Kind : uint8_t {
    uniform,  ///< mean - spread .. mean + spread
    normal,   ///< normal distribution of standard deviation `spread`, truncated at four of these
  };
  double mean = 0;
  double spread = 0;  ///< 0: always the mean, without a draw
  Kind kind = Kind::uniform;

  double draw(Random& random) const;
  double least() const { return mean - reach(); }
  double most() const { return mean + reach(); }

 private:
  double reach() const;
};

/// The random numbers for element `n` of a series: seeds of neighbouring elements are unrelated
/// (SplitMix64, Steele et al. 2014), and the result depends on the seed and n only.
Random numbered_random(uint64_t seed, uint64_t n);

/// Normally distributed, with mean 0 and standard deviation 1, truncated at four (Box and Muller
/// 1958).
double standard_normal(Random& random);

/// Uniformly distributed unit vectors whose angle with the unit vector `axis` has at least this
/// cosine.
Vec3 direction_in_cone(Random& random, const Vec3& axis, double cosine);
Vec3 random_unit_vector(Random& random);
/// Uniformly distributed rotations (Shoemake 1992).
Quat random_orientation(Random& random);

}  // namespace tumble
