// Sums over the neighbours of one particle: pairs are found eight at a time, and then summed one
// after the other, the four numbers of a neighbour side by side. Gathering numbers one by one from
// all over memory would take several times as long.
#include "engine/dynamics/sph/fluid_sums.hpp"

// This file once per instruction set, then what each time needs.
// clang-format off
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "engine/dynamics/sph/fluid_sums.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "engine/math/compress-inl.hpp"
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace tumble::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using FluidTag = hn::CappedTag<double, 4>;
using FluidHalf = hn::Rebind<float, FluidTag>;  ///< as many numbers in single precision
using FluidLanes = hn::Vec<FluidTag>;
constexpr size_t fluid_parts = 4 / hn::MaxLanes(FluidTag());

/// Four numbers in double.
struct FluidFour {
  FluidLanes parts[fluid_parts];
  static HWY_INLINE FluidFour zero() {
    FluidFour f;
    for (FluidLanes& p : f.parts) p = hn::Zero(FluidTag());
    return f;
  }
  static HWY_INLINE FluidFour load(const double* from) {
    FluidFour f;
    for (size_t k = 0; k < fluid_parts; ++k)
      f.parts[k] = hn::LoadU(FluidTag(), from + k * hn::MaxLanes(FluidTag()));
    return f;
  }
  static HWY_INLINE FluidFour load(const float* from) {
    FluidFour f;
    for (size_t k = 0; k < fluid_parts; ++k)
      f.parts[k] =
          hn::PromoteTo(FluidTag(), hn::LoadU(FluidHalf(), from + k * hn::MaxLanes(FluidTag())));
    return f;
  }
  HWY_INLINE void store(double* to) const {
    for (size_t k = 0; k < fluid_parts; ++k)
      hn::StoreU(parts[k], FluidTag(), to + k * hn::MaxLanes(FluidTag()));
  }
  HWY_INLINE void store_single(float* to) const {
    for (size_t k = 0; k < fluid_parts; ++k)
      hn::StoreU(hn::DemoteTo(FluidHalf(), parts[k]), FluidHalf(),
                 to + k * hn::MaxLanes(FluidTag()));
  }
};
HWY_INLINE FluidFour operator+(const FluidFour& a, const FluidFour& b) {
  FluidFour f;
  for (size_t k = 0; k < fluid_parts; ++k) f.parts[k] = hn::Add(a.parts[k], b.parts[k]);
  return f;
}
HWY_INLINE FluidFour operator-(const FluidFour& a, const FluidFour& b) {
  FluidFour f;
  for (size_t k = 0; k < fluid_parts; ++k) f.parts[k] = hn::Sub(a.parts[k], b.parts[k]);
  return f;
}
HWY_INLINE FluidFour operator*(double a, const FluidFour& b) {
  FluidFour f;
  const FluidLanes every = hn::Set(FluidTag(), a);
  for (size_t k = 0; k < fluid_parts; ++k) f.parts[k] = hn::Mul(every, b.parts[k]);
  return f;
}

// -- finding pairs, in single precision

using SingleTag = hn::CappedTag<float, 8>;
using SingleLanes = hn::Vec<SingleTag>;
using PlaceTag = hn::Rebind<uint32_t, SingleTag>;
constexpr size_t single_lanes = hn::MaxLanes(SingleTag());

HWY_INLINE SingleLanes every(float v) {
  return hn::Set(SingleTag(), v);
}

/// Parts of kernels, of u and w as in SmoothingKernel: W / scale, and dW/dr reach / scale.
struct CubicLanes {
  static HWY_INLINE SingleLanes value(SingleLanes u, SingleLanes w) {
    return hn::Sub(hn::Mul(every(2), hn::Mul(hn::Mul(u, u), u)),
                   hn::Mul(every(8), hn::Mul(hn::Mul(w, w), w)));
  }
  static HWY_INLINE SingleLanes slope(SingleLanes u, SingleLanes w) {
    return hn::Sub(hn::Mul(every(24), hn::Mul(w, w)), hn::Mul(every(6), hn::Mul(u, u)));
  }
};
struct WendlandLanes {
  static HWY_INLINE SingleLanes value(SingleLanes u, SingleLanes) {
    const SingleLanes u2 = hn::Mul(u, u);
    return hn::Mul(hn::Mul(u2, u2), hn::Sub(every(5), hn::Mul(every(4), u)));
  }
  static HWY_INLINE SingleLanes slope(SingleLanes u, SingleLanes) {
    return hn::Mul(hn::Mul(every(-20), hn::Sub(every(1), u)), hn::Mul(u, hn::Mul(u, u)));
  }
};

/// The particle whose list is made, and its sums.
template <class Kernel, bool moments>
class PairFinder {
 public:
  HWY_INLINE PairFinder(const SmoothingKernel& kernel, const FluidVector* points, size_t place)
      : points_(points),
        own_(FluidFour::load(&points[place].x)),
        per_reach_(float(1 / kernel.reach())) {
    for (size_t k = 0; k < single_parts; ++k) {
      share_[k] = squares_[k] = every(0);
      for (size_t n = 0; n < symmetric; ++n) moment_[n][k] = square_matrix_[n][k] = every(0);
    }
    for (FluidFour& g : gradient_) g = FluidFour::zero();
  }

  HWY_INLINE void eight(const uint32_t* others, FluidPairStore& store) {
    HWY_ALIGN double ways[4 * at_once];
    HWY_ALIGN float rows[4 * at_once];
    HWY_ALIGN float slopes[at_once];
    for (size_t k = 0; k < at_once; ++k) {
      const FluidFour way = own_ - FluidFour::load(&points_[others[k]].x);
      way.store(ways + 4 * k);
      way.store_single(rows + 4 * k);
      rows[4 * k + 3] = float(points_[others[k]].w);
    }
    for (size_t part = 0; part < single_parts; ++part) {
      const size_t at = part * single_lanes;
      SingleLanes x, y, z, v;
      hn::LoadInterleaved4(SingleTag(), rows + 4 * at, x, y, z, v);
      const SingleLanes r = hn::Sqrt(hn::Add(hn::Add(hn::Mul(x, x), hn::Mul(y, y)), hn::Mul(z, z)));
      const SingleLanes q = hn::Mul(r, every(per_reach_));
      const SingleLanes u = hn::Max(every(0), hn::Sub(every(1), q)),
                        w = hn::Max(every(0), hn::Sub(every(0.5f), q));
      const SingleLanes slope = Kernel::slope(u, w), value = Kernel::value(u, w);
      // Two at one place push each other nowhere.
      const SingleLanes f = hn::IfThenElseZero(hn::Gt(q, every(0)), hn::Div(slope, q));
      share_[part] = hn::Add(share_[part], hn::Mul(v, value));
      squares_[part] = hn::Add(squares_[part], hn::Mul(v, hn::Mul(slope, slope)));
      if constexpr (moments) {
        const SingleLanes push = hn::Mul(v, f);
        add_products(moment_, part, push, x, y, z);
        add_products(square_matrix_, part, hn::Mul(push, f), x, y, z);
      }
      hn::Store(f, SingleTag(), slopes + at);
      // Written as many as there are lanes, of which those in reach are kept.
      const Compressor<SingleTag> compress(hn::Lt(q, every(1)));
      const FluidPairStore::End end = store.end();
      hn::StoreU(compress(hn::LoadU(PlaceTag(), others + at)), PlaceTag(), end.others);
      hn::StoreU(compress(f), SingleTag(), end.slopes);
      hn::StoreU(compress(value), SingleTag(), end.weights);
      store.keep(compress.count());
    }
    for (size_t k = 0; k < at_once; ++k) {
      // Beyond the reach it is zero.
      const double f = double(slopes[k]) * points_[others[k]].w;
      gradient_[k % 4] = gradient_[k % 4] + f * FluidFour::load(ways + 4 * k);
      slopes_[k % 4] += f;
    }
  }
  HWY_INLINE void finish(const SmoothingKernel& kernel, FluidPairSums& out) const {
    const double per_reach = kernel.scale() / kernel.reach(), unit = per_reach / kernel.reach();
    double g[4];
    ((gradient_[0] + gradient_[2]) + (gradient_[1] + gradient_[3])).store(g);
    out.gx = unit * g[0], out.gy = unit * g[1], out.gz = unit * g[2];
    out.slopes = unit * ((slopes_[0] + slopes_[2]) + (slopes_[1] + slopes_[3]));
    out.share = kernel.scale() * total(share_);
    out.squares = per_reach * per_reach * total(squares_);
    if constexpr (moments) {
      out.moment = -unit * matrix(moment_);
      out.square_matrix = unit * unit * matrix(square_matrix_);
    }
  }

  static constexpr size_t at_once = 8;

 private:
  static constexpr size_t single_parts = at_once / single_lanes;
  static constexpr size_t symmetric = 6;  ///< numbers of a symmetric matrix
  using Products = SingleLanes[symmetric][single_parts];

  static HWY_INLINE void add_products(Products& to, size_t part, SingleLanes factor, SingleLanes x,
                                      SingleLanes y, SingleLanes z) {
    const SingleLanes fx = hn::Mul(factor, x), fy = hn::Mul(factor, y), fz = hn::Mul(factor, z);
    to[0][part] = hn::Add(to[0][part], hn::Mul(fx, x));
    to[1][part] = hn::Add(to[1][part], hn::Mul(fx, y));
    to[2][part] = hn::Add(to[2][part], hn::Mul(fx, z));
    to[3][part] = hn::Add(to[3][part], hn::Mul(fy, y));
    to[4][part] = hn::Add(to[4][part], hn::Mul(fy, z));
    to[5][part] = hn::Add(to[5][part], hn::Mul(fz, z));
  }
  static HWY_INLINE Mat3 matrix(const Products& from) {
    const double xx = total(from[0]), xy = total(from[1]), xz = total(from[2]), yy = total(from[3]),
                 yz = total(from[4]), zz = total(from[5]);
    return {xx, xy, xz, xy, yy, yz, xz, yz, zz};
  }
  static HWY_INLINE double total(const SingleLanes* parts) {
    HWY_ALIGN float v[at_once];
    for (size_t k = 0; k < single_parts; ++k)
      hn::Store(parts[k], SingleTag(), v + k * single_lanes);
    double t[4];
    for (size_t k = 0; k < 4; ++k) t[k] = double(v[k]) + double(v[k + 4]);
    return (t[0] + t[2]) + (t[1] + t[3]);
  }

  const FluidVector* points_;
  FluidFour own_;
  float per_reach_;
  SingleLanes share_[single_parts], squares_[single_parts];
  Products moment_, square_matrix_;
  FluidFour gradient_[4];
  double slopes_[4] = {};
};

template <class Kernel, bool moments>
FluidPairSums pairs_of(const SmoothingKernel& kernel, std::span<const FluidVector> points,
                       size_t place, std::span<const uint32_t> candidates, FluidPairStore& store) {
  using Finder = PairFinder<Kernel, moments>;
  Finder finder(kernel, points.data(), place);
  FluidPairSums out{};
  out.range.first = store.used();
  for (size_t k = 0; k < candidates.size(); k += Finder::at_once)
    finder.eight(candidates.data() + k, store);
  out.pairs = store.used() - out.range.first;
  while ((store.used() - out.range.first) % FluidPairStore::batch != 0) {
    const FluidPairStore::End end = store.end();
    *end.others = uint32_t(points.size() - 1);
    *end.slopes = *end.weights = 0;
    store.keep(1);
  }
  out.range.padded = store.used() - out.range.first;
  finder.finish(kernel, out);
  return out;
}

template <class Kernel>
FluidPairSums pairs_by(FluidMoments moments, const SmoothingKernel& kernel,
                       std::span<const FluidVector> points, size_t place,
                       std::span<const uint32_t> candidates, FluidPairStore& store) {
  return moments == FluidMoments::found
             ? pairs_of<Kernel, true>(kernel, points, place, candidates, store)
             : pairs_of<Kernel, false>(kernel, points, place, candidates, store);
}

FluidPairSums pairs_here(const SmoothingKernel& kernel, FluidMoments moments,
                         std::span<const FluidVector> points, size_t place,
                         std::span<const uint32_t> candidates, FluidPairStore& store) {
  return kernel.kind() == FluidKernelKind::wendland
             ? pairs_by<WendlandLanes>(moments, kernel, points, place, candidates, store)
             : pairs_by<CubicLanes>(moments, kernel, points, place, candidates, store);
}

// -- sums over them

/// Of one particle: factors times means times y, of every fourth pair in a sum of its own.
template <class Mean>
HWY_INLINE FluidFour sum_of(const FluidList& list, const float* factors, const FluidVector* y,
                            const Mean& mean) {
  FluidFour sums[4] = {FluidFour::zero(), FluidFour::zero(), FluidFour::zero(), FluidFour::zero()};
  for (size_t k = 0; k < list.padded; k += 4) {
    HWY_ALIGN double f[4];
    FluidFour::load(factors + k).store(f);
    for (size_t n = 0; n < 4; ++n) {
      const size_t other = list.others[k + n];
      sums[n] = sums[n] + mean(f[n], other) * FluidFour::load(&y[other].x);
    }
  }
  return (sums[0] + sums[2]) + (sums[1] + sums[3]);
}

void sums_here(const FluidPairStore& store, FluidFactor factor, size_t first_place,
               std::span<const FluidPairStore::Range> ranges, const FluidVector* y, const double* q,
               FluidVector* sums) {
  const bool slopes = factor == FluidFactor::slope;
  const double unit = slopes ? store.slope_unit() : store.weight_unit();
  for (size_t p = 0; p < ranges.size(); ++p) {
    const FluidList list = store.list(ranges[p]);
    const float* factors = slopes ? list.slopes : list.weights;
    FluidFour sum;
    if (q) {
      const double own = q[first_place + p];
      sum = sum_of(list, factors, y, [own, q](double f, size_t other) HWY_ATTR {
        return f * of_mean(own, q[other]);
      });
    } else {
      sum = sum_of(list, factors, y, [](double f, size_t) HWY_ATTR { return f; });
    }
    (unit * sum).store(&sums[p].x);
  }
}

}  // namespace tumble::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tumble {
HWY_EXPORT(pairs_here);
HWY_EXPORT(sums_here);

FluidPairSums find_pairs(const SmoothingKernel& kernel, FluidMoments moments,
                         std::span<const FluidVector> points, size_t place,
                         std::span<const uint32_t> candidates, FluidPairStore& store) {
  return HWY_DYNAMIC_DISPATCH(pairs_here)(kernel, moments, points, place, candidates, store);
}
void sum_pairs(const FluidPairStore& store, FluidFactor factor, size_t first_place,
               std::span<const FluidPairStore::Range> ranges, const FluidVector* y, const double* q,
               FluidVector* sums) {
  HWY_DYNAMIC_DISPATCH(sums_here)(store, factor, first_place, ranges, y, q, sums);
}
}  // namespace tumble
#endif
