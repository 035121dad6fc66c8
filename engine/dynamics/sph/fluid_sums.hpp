#pragma once
#include "engine/dynamics/sph/smoothing_kernel.hpp"
#include "engine/math/types.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace tumble {

/// A vector and one number more, which load at once.
struct alignas(32) FluidVector {
  double x = 0, y = 0, z = 0;
  double w = 0;  ///< of a place: the particle's volume [m3]; else zero
  Vec3 vector() const { return {x, y, z}; }
};
static_assert(sizeof(FluidVector) == 4 * sizeof(double));

/// The same in single precision, where half the memory is twice the speed.
struct alignas(16) FluidVectorSingle {
  float x = 0, y = 0, z = 0, w = 0;
};
static_assert(sizeof(FluidVectorSingle) == 4 * sizeof(float));

/// Vectors by place: see NeighbourLists. The last place, which fills lists, has no volume.
class FluidVectors {
 public:
  /// The last one is zero; the others are anything.
  void resize(size_t n) {
    all_.resize(n);
    all_.back() = {};
  }
  void fill_zero(size_t n) { all_.assign(n, {}); }
  Vec3 operator[](size_t p) const { return all_[p].vector(); }
  void set(size_t p, const Vec3& v) { all_[p] = {v[0], v[1], v[2], 0}; }
  void set(size_t p, const Vec3& v, double w) { all_[p] = {v[0], v[1], v[2], w}; }
  const FluidVector* data() const { return all_.data(); }

 private:
  std::vector<FluidVector> all_;
};

/// What a particle has to do with the others in reach of it, pair by pair. d is the way from the
/// other particle to this one, V the volume of the other, f the slope of the kernel over the
/// distance, so that f d is the gradient of W. All is rounded to single precision, which halves
/// what the loops over pairs read; both particles of a pair round alike if their volumes are the
/// same, and then pairs keep the momentum exactly.
struct FluidList {
  size_t place = 0;
  size_t padded = 0;                 ///< entries: pairs, and pairs with nothing up to a whole batch
  const uint32_t* others = nullptr;  ///< places
  const float* gradients = nullptr;  ///< V f d: x, y, z, x, y, z... and one number that is not used
  const float* slopes = nullptr;     ///< V f [1/m2]
  const float* weights = nullptr;    ///< V W [-]
};

/// Room for such lists, one behind the other.
class FluidPairStore {
 public:
  static constexpr size_t batch = 4;
  struct Range {
    size_t first, padded;
  };
  /// Forgets what it holds and has room for `most` pairs, each list filled up.
  void clear(size_t most) {
    used_ = 0;
    if (others_.size() > most) return;
    others_.resize(most + 1), slopes_.resize(most + 1), weights_.resize(most + 1);
    gradients_.resize(3 * most + 4);
  }
  FluidList list(size_t place, Range r) const {
    return {place,
            r.padded,
            others_.data() + r.first,
            gradients_.data() + 3 * r.first,
            slopes_.data() + r.first,
            weights_.data() + r.first};
  }

  struct Pair {
    uint32_t other;
    float gx, gy, gz, slope, weight;
  };
  /// Writes a pair behind the others, where it stays if it is wanted: without a branch that the
  /// processor would have to guess.
  void append(const Pair& p, bool wanted) {
    others_[used_] = p.other;
    float* g = gradients_.data() + 3 * used_;
    g[0] = p.gx, g[1] = p.gy, g[2] = p.gz;
    slopes_[used_] = p.slope, weights_[used_] = p.weight;
    used_ += size_t(wanted);
  }
  size_t used() const { return used_; }

 private:
  size_t used_ = 0;
  std::vector<uint32_t> others_;
  std::vector<float> gradients_, slopes_, weights_;
};

struct FluidPairSums {
  FluidPairStore::Range range;
  size_t pairs;
  double share;       ///< sum of V W over the others [-]
  double gx, gy, gz;  ///< sum of V f d [1/m]
  double squares;     ///< sum of V |f d|^2 [1/m5]
  double slopes;      ///< sum of V f [1/m2]
};

// Each of these is sums side by side in an order that is the same for every instruction set.

/// Appends the list of the particle at `place` to the store. `candidates` are a multiple of eight
/// places, of which those that are in reach count; the last of points() fills the list up.
FluidPairSums find_pairs(const SmoothingKernel& kernel, std::span<const FluidVector> points,
                         size_t place, std::span<const uint32_t> candidates, FluidPairStore& store);
/// Sum of V f d (value + value of the other).
Vec3 sum_gradients(const double* value, const FluidList& list);
/// Sum of V f (u - u of the other) . d.
double sum_rates(const FluidVector* u, const FluidList& list);
double sum_rates(const FluidVectorSingle* u, const FluidList& list);
// What passes between two particles goes by the harmonic mean of a quantity q that each has, such
// as a viscosity, and which is not negative: own q times `of_mean`, which is exactly 1 where both
// have the same.
inline double of_mean(double own, double other) {
  const double both = own + other;
  return both > 0 ? 2 * other / both : 0;
}
/// Sum of V f of_mean (u - u of the other).
Vec3 sum_diffused(const FluidVector* u, const double* q, const FluidList& list);
/// Sum of V W of_mean (u of the other - u).
Vec3 sum_differences(const FluidVector* u, const double* q, const FluidList& list);

}  // namespace tumble
