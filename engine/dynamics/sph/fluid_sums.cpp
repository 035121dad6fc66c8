// Sums over the neighbours of one particle: pairs are found four at a time, and then summed one
// after the other, the components of a vector side by side. Gathering components from all over
// memory would take several times as long.
#include "engine/dynamics/sph/fluid_sums.hpp"

// This file once per instruction set, then what each time needs.
// clang-format off
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "engine/dynamics/sph/fluid_sums.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace tumble::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using FluidTag = hn::CappedTag<double, 4>;
using FluidSingle = hn::Rebind<float, FluidTag>;
using FluidLanes = hn::Vec<FluidTag>;
constexpr size_t fluid_batch = FluidPairStore::batch;
constexpr size_t fluid_parts = fluid_batch / hn::MaxLanes(FluidTag());

HWY_INLINE FluidLanes every(double v) {
  return hn::Set(FluidTag(), v);
}

/// Four numbers: a vector, or one number of each of four particles.
struct FluidFour {
  FluidLanes parts[fluid_parts];
  FluidFour() {
    for (FluidLanes& p : parts) p = every(0);
  }
  static HWY_INLINE FluidFour load(const double* from) {
    FluidFour f;
    for (size_t k = 0; k < fluid_parts; ++k)
      f.parts[k] = hn::LoadU(FluidTag(), from + k * hn::Lanes(FluidTag()));
    return f;
  }
  static HWY_INLINE FluidFour load(const float* from) {
    FluidFour f;
    for (size_t k = 0; k < fluid_parts; ++k)
      f.parts[k] =
          hn::PromoteTo(FluidTag(), hn::LoadU(FluidSingle(), from + k * hn::Lanes(FluidTag())));
    return f;
  }
  HWY_INLINE void store(double* to) const {
    for (size_t k = 0; k < fluid_parts; ++k)
      hn::StoreU(parts[k], FluidTag(), to + k * hn::Lanes(FluidTag()));
  }
  HWY_INLINE double total() const {
    HWY_ALIGN double v[fluid_batch];
    store(v);
    return (v[0] + v[2]) + (v[1] + v[3]);
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
HWY_INLINE FluidFour operator*(const FluidFour& a, const FluidFour& b) {
  FluidFour f;
  for (size_t k = 0; k < fluid_parts; ++k) f.parts[k] = hn::Mul(a.parts[k], b.parts[k]);
  return f;
}
HWY_INLINE FluidFour operator*(double a, const FluidFour& b) {
  FluidFour f;
  for (size_t k = 0; k < fluid_parts; ++k) f.parts[k] = hn::Mul(every(a), b.parts[k]);
  return f;
}
HWY_INLINE FluidFour same(double v) {
  FluidFour f;
  for (FluidLanes& p : f.parts) p = every(v);
  return f;
}

/// Parts of kernels, of u and w as in SmoothingKernel: W / scale, and dW/dr reach / scale.
struct CubicLanes {
  static HWY_INLINE FluidLanes value(FluidLanes u, FluidLanes w) {
    return hn::Sub(hn::Mul(every(2), hn::Mul(hn::Mul(u, u), u)),
                   hn::Mul(every(8), hn::Mul(hn::Mul(w, w), w)));
  }
  static HWY_INLINE FluidLanes slope(FluidLanes u, FluidLanes w) {
    return hn::Sub(hn::Mul(every(24), hn::Mul(w, w)), hn::Mul(every(6), hn::Mul(u, u)));
  }
};
struct WendlandLanes {
  static HWY_INLINE FluidLanes value(FluidLanes u, FluidLanes) {
    const FluidLanes u2 = hn::Mul(u, u);
    return hn::Mul(hn::Mul(u2, u2), hn::Sub(every(5), hn::Mul(every(4), u)));
  }
  static HWY_INLINE FluidLanes slope(FluidLanes u, FluidLanes) {
    return hn::Mul(hn::Mul(every(-20), hn::Sub(every(1), u)), hn::Mul(u, hn::Mul(u, u)));
  }
};

/// Four candidates: how far they are, V f d, V f and V W.
struct FluidFound {
  double r[fluid_batch];
  float gx[fluid_batch], gy[fluid_batch], gz[fluid_batch], slope[fluid_batch], weight[fluid_batch];
};

/// The particle whose list is made, and its sums.
template <class Kernel>
class PairFinder {
 public:
  HWY_INLINE PairFinder(const SmoothingKernel& kernel, const FluidVector* points, size_t place)
      : points_(points),
        own_(points[place]),
        per_reach_(1 / kernel.reach()),
        scale_(kernel.scale()),
        per_slope_(kernel.scale() / kernel.reach()) {}

  HWY_INLINE void four(const uint32_t* others, FluidFound& out) {
    const FluidTag d;
    constexpr size_t lanes = hn::MaxLanes(FluidTag());
    HWY_ALIGN double rows[4 * fluid_batch];
    for (size_t k = 0; k < fluid_batch; ++k)
      FluidFour::load(&points_[others[k]].x).store(rows + 4 * k);
    for (size_t part = 0; part < fluid_parts; ++part) {
      FluidLanes x, y, z, v;
      hn::LoadInterleaved4(d, rows + 4 * lanes * part, x, y, z, v);
      const FluidLanes dx = hn::Sub(every(own_.x), x), dy = hn::Sub(every(own_.y), y),
                       dz = hn::Sub(every(own_.z), z);
      const FluidLanes r =
          hn::Sqrt(hn::Add(hn::Add(hn::Mul(dx, dx), hn::Mul(dy, dy)), hn::Mul(dz, dz)));
      const FluidLanes q = hn::Mul(r, every(per_reach_));
      const FluidLanes u = hn::Max(every(0), hn::Sub(every(1), q)),
                       w = hn::Max(every(0), hn::Sub(every(0.5), q));
      const FluidLanes slope = hn::Mul(every(per_slope_), Kernel::slope(u, w));
      // Two at one place push each other nowhere.
      const FluidLanes f = hn::IfThenElseZero(hn::Gt(r, every(0)), hn::Div(hn::Mul(v, slope), r));
      const FluidLanes weight = hn::Mul(every(scale_), hn::Mul(v, Kernel::value(u, w)));
      share_.parts[part] = hn::Add(share_.parts[part], weight);
      squares_.parts[part] = hn::Add(squares_.parts[part], hn::Mul(v, hn::Mul(slope, slope)));
      slopes_.parts[part] = hn::Add(slopes_.parts[part], f);
      const size_t at = part * lanes;
      hn::StoreU(r, d, out.r + at);
      const auto store = [&](FluidLanes value, float* to) HWY_ATTR {
        hn::StoreU(hn::DemoteTo(FluidSingle(), value), FluidSingle(), to + at);
      };
      store(hn::Mul(f, dx), out.gx), store(hn::Mul(f, dy), out.gy), store(hn::Mul(f, dz), out.gz);
      store(f, out.slope), store(weight, out.weight);
    }
  }
  double share() const { return share_.total(); }
  double squares() const { return squares_.total(); }
  double slopes() const { return slopes_.total(); }

 private:
  const FluidVector* points_;
  FluidVector own_;
  double per_reach_, scale_, per_slope_;
  FluidFour share_, squares_, slopes_;
};

template <class Kernel>
FluidPairSums pairs_of(const SmoothingKernel& kernel, std::span<const FluidVector> points,
                       size_t place, std::span<const uint32_t> candidates, FluidPairStore& store) {
  PairFinder<Kernel> finder(kernel, points.data(), place);
  const double reach = kernel.reach();
  FluidPairSums out{};
  out.range.first = store.used();
  for (size_t k = 0; k < candidates.size(); k += fluid_batch) {
    FluidFound found;
    finder.four(candidates.data() + k, found);
    for (size_t n = 0; n < fluid_batch; ++n) {
      const bool in = found.r[n] < reach;
      store.append({candidates[k + n], found.gx[n], found.gy[n], found.gz[n], found.slope[n],
                    found.weight[n]},
                   in);
      // Beyond the reach these are zero.
      out.gx += double(found.gx[n]), out.gy += double(found.gy[n]), out.gz += double(found.gz[n]);
    }
  }
  out.pairs = store.used() - out.range.first;
  while ((store.used() - out.range.first) % fluid_batch != 0)
    store.append({uint32_t(points.size() - 1), 0, 0, 0, 0, 0}, true);
  out.range.padded = store.used() - out.range.first;
  out.share = finder.share(), out.squares = finder.squares(), out.slopes = finder.slopes();
  return out;
}

/// Four sums of vectors side by side, of every fourth pair each.
struct VectorSums {
  FluidFour sums[fluid_batch];
  HWY_INLINE FluidVector total() const {
    FluidVector v;
    ((sums[0] + sums[2]) + (sums[1] + sums[3])).store(&v.x);
    return v;
  }
};
/// term(pair) summed over a list.
template <class Term>
HWY_INLINE FluidVector sum_pairs(const FluidList& list, const Term& term) {
  VectorSums s;
  for (size_t k = 0; k < list.padded; k += fluid_batch)
    for (size_t n = 0; n < fluid_batch; ++n) s.sums[n] = s.sums[n] + term(k + n);
  return s.total();
}

FluidPairSums pairs_here(const SmoothingKernel& kernel, std::span<const FluidVector> points,
                         size_t place, std::span<const uint32_t> candidates,
                         FluidPairStore& store) {
  return kernel.kind() == FluidKernelKind::wendland
             ? pairs_of<WendlandLanes>(kernel, points, place, candidates, store)
             : pairs_of<CubicLanes>(kernel, points, place, candidates, store);
}
Vec3 gradients_here(const double* value, const FluidList& list) {
  const double own = value[list.place];
  return sum_pairs(list,
                   [&](size_t k) HWY_ATTR {
                     return (own + value[list.others[k]]) * FluidFour::load(list.gradients + 3 * k);
                   })
      .vector();
}
double rates_here(const FluidVector* u, const FluidList& list) {
  const FluidFour own = FluidFour::load(&u[list.place].x);
  const FluidVector sum = sum_pairs(list, [&](size_t k) HWY_ATTR {
    return (own - FluidFour::load(&u[list.others[k]].x)) * FluidFour::load(list.gradients + 3 * k);
  });
  return (sum.x + sum.y) + sum.z;
}
/// Differences in single precision, sums in double.
double single_rates_here(const FluidVectorSingle* u, const FluidList& list) {
  const FluidSingle d;
  constexpr size_t lanes = hn::MaxLanes(FluidTag());
  const float* mine = &u[list.place].x;
  const FluidVector sum = sum_pairs(list, [&](size_t k) HWY_ATTR {
    const float* other = &u[list.others[k]].x;
    const float* gradient = list.gradients + 3 * k;
    FluidFour f;
    for (size_t part = 0; part < fluid_parts; ++part) {
      const size_t at = part * lanes;
      const auto way = hn::Sub(hn::LoadU(d, mine + at), hn::LoadU(d, other + at));
      f.parts[part] = hn::PromoteTo(FluidTag(), hn::Mul(way, hn::LoadU(d, gradient + at)));
    }
    return f;
  });
  return (sum.x + sum.y) + sum.z;
}
Vec3 diffused_here(const FluidVector* u, const double* q, const FluidList& list) {
  const FluidFour own = FluidFour::load(&u[list.place].x);
  const double mine = q[list.place];
  return sum_pairs(list,
                   [&](size_t k) HWY_ATTR {
                     const double slope = double(list.slopes[k]) * of_mean(mine, q[list.others[k]]);
                     return slope * (own - FluidFour::load(&u[list.others[k]].x));
                   })
      .vector();
}
Vec3 differences_here(const FluidVector* u, const double* q, const FluidList& list) {
  const FluidFour own = FluidFour::load(&u[list.place].x);
  const double mine = q[list.place];
  return sum_pairs(list,
                   [&](size_t k) HWY_ATTR {
                     const double weight =
                         double(list.weights[k]) * of_mean(mine, q[list.others[k]]);
                     return weight * (FluidFour::load(&u[list.others[k]].x) - own);
                   })
      .vector();
}

}  // namespace tumble::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tumble {
HWY_EXPORT(pairs_here);
HWY_EXPORT(gradients_here);
HWY_EXPORT(rates_here);
HWY_EXPORT(single_rates_here);
HWY_EXPORT(diffused_here);
HWY_EXPORT(differences_here);

FluidPairSums find_pairs(const SmoothingKernel& kernel, std::span<const FluidVector> points,
                         size_t place, std::span<const uint32_t> candidates,
                         FluidPairStore& store) {
  return HWY_DYNAMIC_DISPATCH(pairs_here)(kernel, points, place, candidates, store);
}
Vec3 sum_gradients(const double* value, const FluidList& list) {
  return HWY_DYNAMIC_DISPATCH(gradients_here)(value, list);
}
double sum_rates(const FluidVector* u, const FluidList& list) {
  return HWY_DYNAMIC_DISPATCH(rates_here)(u, list);
}
double sum_rates(const FluidVectorSingle* u, const FluidList& list) {
  return HWY_DYNAMIC_DISPATCH(single_rates_here)(u, list);
}
Vec3 sum_diffused(const FluidVector* u, const double* q, const FluidList& list) {
  return HWY_DYNAMIC_DISPATCH(diffused_here)(u, q, list);
}
Vec3 sum_differences(const FluidVector* u, const double* q, const FluidList& list) {
  return HWY_DYNAMIC_DISPATCH(differences_here)(u, q, list);
}
}  // namespace tumble
#endif
