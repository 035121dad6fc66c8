#pragma once
#include "engine/dynamics/particles/neighbours/neighbour_lists.hpp"
#include "engine/dynamics/sph/smoothing_kernel.hpp"
#include "engine/math/types.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <hwy/cache_control.h>

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

/// A vector in single precision and one number more.
struct alignas(16) SingleVector {
  float x = 0, y = 0, z = 0, w = 0;
};

/// A symmetric matrix as two vectors, its diagonal and what is beside it.
template <class T>
struct alignas(8 * sizeof(T)) SymmetricRow {
  T xx = 0, yy = 0, zz = 0, unused = 0;
  T yz = 0, zx = 0, xy = 0, spare = 0;
  static SymmetricRow of(const Mat3& m) {
    return {T(m(0, 0)), T(m(1, 1)), T(m(2, 2)), 0, T(m(1, 2)), T(m(2, 0)), T(m(0, 1)), 0};
  }
  SymmetricRow times(T k) const { return {k * xx, k * yy, k * zz, 0, k * yz, k * zx, k * xy, 0}; }
};

/// Up to four particles whose places follow each other, and the list that they have in common, of
/// what is in reach of any of them and of themselves (NeighbourLists). A pair has the kernel W and
/// its slope over the distance f, so that f times the way from the other particle to this one is
/// the gradient of W; zero where they are not in reach of each other, and f of a particle with
/// itself. Both are rounded to single precision, alike for both particles of a pair, and lie by
/// neighbour, four particles each: what is read of a neighbour serves all four.
struct FluidGroup {
  static constexpr size_t size = NeighbourLists::group_size;
  uint32_t first, count;   ///< places of the particles
  size_t padded;           ///< neighbours, a multiple of four
  const uint32_t* others;  ///< by neighbour: place
  const float* slopes;     ///< by neighbour and particle: f [slope units]
  const float* weights;    ///< likewise W [weight units]; null: nobody asked for it
  const int16_t* rounded;  ///< likewise f [rounded units]
  /// Fetches the row of a neighbour that comes up soon, out of an array by place: rows are in no
  /// near cache when a list comes to what no list before it had.
  template <class Row>
  static void fetch(const Row* rows, const uint32_t* other) {
    hwy::Prefetch(rows + other[NeighbourLists::look_ahead]);
  }
  /// The n-th particle; of those that are missing the last one.
  size_t place(size_t n) const { return first + (n < count ? n : count - 1); }
};

/// The pairs of all groups.
class FluidPairs {
 public:
  /// Forgets what it holds and has room for the pairs of these lists, which are to last as long.
  void make_room(const NeighbourLists& lists, const SmoothingKernel& kernel, bool weights);
  size_t groups() const { return lists_ ? lists_->groups().size() : 0; }
  FluidGroup group(size_t g) const {
    const NeighbourLists::Group& of = lists_->groups()[g];
    const size_t at = firsts_[g];
    return {of.first,
            of.count,
            of.padded,
            lists_->of(of).data(),
            slopes_.data() + at,
            weights_.empty() ? nullptr : weights_.data() + at,
            rounded_.data() + at};
  }
  /// Where the pairs of a group are written.
  struct Room {
    float *slopes, *weights;
    int16_t* rounded;
  };
  Room room(size_t g) {
    const size_t at = firsts_[g];
    return {slopes_.data() + at, weights_.empty() ? nullptr : weights_.data() + at,
            rounded_.data() + at};
  }
  double slope_unit() const { return slope_unit_; }      ///< [1/m5]
  double weight_unit() const { return weight_unit_; }    ///< [1/m3]
  double rounded_unit() const { return rounded_unit_; }  ///< [slope units]

 private:
  const NeighbourLists* lists_ = nullptr;
  double slope_unit_ = 1, weight_unit_ = 1, rounded_unit_ = 1;
  std::vector<size_t> firsts_;  ///< by group
  std::vector<float> slopes_, weights_;
  std::vector<int16_t> rounded_;
};

/// Sums over the pairs of a particle.
struct FluidPairSums {
  size_t pairs;
  double share;       ///< sum of V W over the others and itself [-]
  double gx, gy, gz;  ///< sum of V f d, d the way from the other [1/m]
  double slopes;      ///< sum of V f [1/m2]
  double squares;     ///< sum of V |f d|^2 over the other's density [1/(kg m2)]
  // Where they are asked for, matrices; they are symmetric:
  Mat3 moment;         ///< sum of -V f d d^T [-]
  Mat3 square_matrix;  ///< sum of V f^2 d d^T over the density, whose trace `squares` is
};
enum class FluidMoments : bool { left_out, found };

/// By place: where particles are [m] and as w their volumes [m3]; and in single precision as x the
/// volume [m3], as y the volume over the density [m6/kg].
struct FluidPoints {
  const FluidVector* at;
  const SingleVector* volumes;
};

// Each of these is sums side by side in an order that is the same for every instruction set. They
// are for the particles of the groups from `first` to `end`, by place from the first one's on.

/// Finds the pairs, and their sums.
void find_pairs(const SmoothingKernel& kernel, FluidMoments moments, const FluidPoints& points,
                FluidPairs& pairs, size_t first, size_t end, FluidPairSums* sums);

// What passes between two particles goes by the harmonic mean of a quantity q that each has, such
// as a viscosity, and which is not negative: own q times `of_mean`, which is exactly 1 where both
// have the same.
inline double of_mean(double own, double other) {
  const double both = own + other;
  return both > 0 ? 2 * other / both : 0;
}

/// By what the terms of a sum over pairs are multiplied.
enum class FluidFactor : uint8_t { slope, weight };

/// The sum of f y or of W y over the others, and with `q` of f of_mean y. Most sums of a fluid are
/// such sums of four numbers of the others (fluid_state), so that pairs need not keep their
/// directions; those of corrected pressures find them anew. A particle is itself among those of its
/// list, where W is not zero.
void sum_pairs(const FluidPairs& pairs, FluidFactor factor, size_t first, size_t end,
               const FluidVector* y, const double* q, FluidVector* sums);

/// The sum of f T d over the others, T their matrices and d the ways from them.
void push_exactly(const FluidPairs& pairs, size_t first, size_t end, const FluidVector* at,
                  const SymmetricRow<double>* stresses, FluidVector* sums);

}  // namespace tumble
