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
  double w = 0;  ///< of a place: the particle's volume [m3]
  Vec3 vector() const { return {x, y, z}; }
};
static_assert(sizeof(FluidVector) == 4 * sizeof(double));

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
  void put(size_t p, const FluidVector& v) { all_[p] = v; }
  const FluidVector* data() const { return all_.data(); }

 private:
  std::vector<FluidVector> all_;
};

/// What a particle has to do with the others in reach of it, pair by pair: the kernel W and its
/// slope over the distance f, so that f times the way from the other particle to this one is the
/// gradient of W. Both in parts of a unit of the store and rounded to single precision, alike for
/// both particles of a pair: loops over pairs are bound by what they read, and so read two numbers.
struct FluidList {
  size_t padded = 0;                 ///< entries: pairs, and pairs with nothing up to a whole batch
  const uint32_t* others = nullptr;  ///< places
  const float* slopes = nullptr;     ///< f [slope units]
  const float* weights = nullptr;    ///< W [weight units]
};

/// Room for such lists, one behind the other.
class FluidPairStore {
 public:
  static constexpr size_t batch = 4;
  static constexpr size_t spare = 8;  ///< of the room: what is written at once
  struct Range {
    size_t first, padded;
  };
  /// Forgets what it holds and has room for `most` pairs, each list filled up.
  void clear(const SmoothingKernel& kernel, size_t most) {
    slope_unit_ = kernel.scale() / (kernel.reach() * kernel.reach());
    weight_unit_ = kernel.scale();
    used_ = 0;
    const size_t room = most + spare;
    if (others_.size() >= room) return;
    others_.resize(room), slopes_.resize(room), weights_.resize(room);
  }
  FluidList list(Range r) const {
    return {r.padded, others_.data() + r.first, slopes_.data() + r.first,
            weights_.data() + r.first};
  }
  double slope_unit() const { return slope_unit_; }    ///< [1/m5]
  double weight_unit() const { return weight_unit_; }  ///< [1/m3]

  /// Where the next pairs are written, with room for a few more than are kept; and how many are.
  struct End {
    uint32_t* others;
    float *slopes, *weights;
  };
  End end() { return {others_.data() + used_, slopes_.data() + used_, weights_.data() + used_}; }
  void keep(size_t n) { used_ += n; }
  size_t used() const { return used_; }

 private:
  size_t used_ = 0;
  double slope_unit_ = 1, weight_unit_ = 1;
  std::vector<uint32_t> others_;
  std::vector<float> slopes_, weights_;
};

struct FluidPairSums {
  FluidPairStore::Range range;
  size_t pairs;
  double share;       ///< sum of V W over the others [-]
  double gx, gy, gz;  ///< sum of V f d, d the way from the other [1/m]
  double slopes;      ///< sum of V f [1/m2]
  double squares;     ///< sum of V |f d|^2 [1/m5]
  // Where they are asked for, matrices; they are symmetric:
  Mat3 moment;         ///< sum of -V f d d^T [-]
  Mat3 square_matrix;  ///< sum of V f^2 d d^T, whose trace `squares` is [1/m5]
};
enum class FluidMoments : bool { left_out, found };

// Each of these is sums side by side in an order that is the same for every instruction set.

/// Appends the list of the particle at `place` to the store. `candidates` are a multiple of eight
/// places, of which those that are in reach count; the last of points() fills the list up.
FluidPairSums find_pairs(const SmoothingKernel& kernel, FluidMoments moments,
                         std::span<const FluidVector> points, size_t place,
                         std::span<const uint32_t> candidates, FluidPairStore& store);

// What passes between two particles goes by the harmonic mean of a quantity q that each has, such
// as a viscosity, and which is not negative: own q times `of_mean`, which is exactly 1 where both
// have the same.
inline double of_mean(double own, double other) {
  const double both = own + other;
  return both > 0 ? 2 * other / both : 0;
}

/// By what the terms of a sum over pairs are multiplied.
enum class FluidFactor : uint8_t { slope, weight };

/// For each of some particles that follow each other, with lists in one store: the sum of f y or of
/// W y over the others, and with `q` of f of_mean y. All sums of a fluid are such sums of four
/// numbers of the others (fluid_state), so that pairs need not keep their directions.
void sum_pairs(const FluidPairStore& store, FluidFactor factor, size_t first_place,
               std::span<const FluidPairStore::Range> ranges, const FluidVector* y, const double* q,
               FluidVector* sums);

}  // namespace tumble
