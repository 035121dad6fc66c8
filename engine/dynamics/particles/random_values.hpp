#pragma once
#include "engine/core/random.hpp"
#include "engine/math/types.hpp"

#include <cstdint>

namespace tumble {

/// A number that is drawn anew for every particle.
struct RandomNumber {
  enum class Kind : uint8_t {
    uniform,  ///< mean - spread .. mean + spread
    normal,   ///< standard deviation `spread`; what is further than four of them is drawn again
  };
  double mean = 0;
  double spread = 0;  ///< 0: always the mean, for which nothing is drawn
  Kind kind = Kind::uniform;

  double draw(Random& random) const;
  double least() const { return mean - reach(); }
  double most() const { return mean + reach(); }

 private:
  double reach() const;
};

/// The draws of number `n` of a series: seeds of neighbouring numbers have nothing in common
/// (SplitMix64, Steele et al. 2014), so that what number n draws depends on nothing but the seed
/// and n.
Random numbered_random(uint64_t seed, uint64_t n);

/// Of mean 0 and standard deviation 1, within four (Box and Muller 1958).
double standard_normal(Random& random);

/// Unit vectors, all as likely: within the angle whose cosine is given of the unit vector `axis`.
Vec3 direction_in_cone(Random& random, const Vec3& axis, double cosine);
Vec3 random_unit_vector(Random& random);
/// Rotations, all as likely (Shoemake 1992).
Quat random_orientation(Random& random);

}  // namespace tumble
