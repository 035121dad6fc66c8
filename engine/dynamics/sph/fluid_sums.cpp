// Sums over the neighbours of one particle, eight at a time.
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

using FluidTag = hn::CappedTag<double, 8>;
using FluidLanes = hn::Vec<FluidTag>;
constexpr size_t fluid_batch = 8;
constexpr size_t fluid_parts = fluid_batch / hn::MaxLanes(FluidTag());

HWY_INLINE FluidLanes every(double v) {
  return hn::Set(FluidTag(), v);
}

/// A sum over lists: eight of them side by side.
struct LaneSum {
  FluidLanes parts[fluid_parts];
  LaneSum() {
    for (FluidLanes& p : parts) p = every(0);
  }
  HWY_INLINE void add(size_t part, FluidLanes v) { parts[part] = hn::Add(parts[part], v); }
  double total() const {
    const FluidTag d;
    HWY_ALIGN double v[fluid_batch];
    for (size_t k = 0; k < fluid_parts; ++k) hn::Store(parts[k], d, v + k * hn::Lanes(d));
    return ((v[0] + v[4]) + (v[2] + v[6])) + ((v[1] + v[5]) + (v[3] + v[7]));
  }
};
struct VectorSum {
  LaneSum x, y, z;
  HWY_INLINE void add(size_t part, FluidLanes factor, FluidLanes dx, FluidLanes dy, FluidLanes dz) {
    x.add(part, hn::Mul(factor, dx));
    y.add(part, hn::Mul(factor, dy));
    z.add(part, hn::Mul(factor, dz));
  }
  Vec3 total() const { return {x.total(), y.total(), z.total()}; }
};

/// Neighbours of a batch: where they are, and how to have what else they have.
struct Others {
  using Index = hn::Vec<hn::RebindToSigned<FluidTag>>;
  Index at;
  FluidLanes dx, dy, dz;
  HWY_INLINE FluidLanes of(const double* values) const {
    return hn::GatherIndex(FluidTag(), values, at);
  }
  HWY_INLINE FluidLanes squared() const {
    return hn::Add(hn::Add(hn::Mul(dx, dx), hn::Mul(dy, dy)), hn::Mul(dz, dz));
  }
};

/// visit(part, place in the list, others) for all neighbours.
template <class Visit>
HWY_INLINE void each_batch(const FluidPoints& p, const FluidList& list, const Visit& visit) {
  const FluidTag d;
  const hn::Rebind<int32_t, FluidTag> narrow;  // places are far below 2^31
  const hn::RebindToSigned<FluidTag> index;
  const FluidLanes x = every(p.x[list.place]), y = every(p.y[list.place]),
                   z = every(p.z[list.place]);
  const auto* places = reinterpret_cast<const int32_t*>(list.others.data());
  for (size_t k = 0; k < list.others.size(); k += fluid_batch)
    for (size_t part = 0; part < fluid_parts; ++part) {
      const size_t first = k + part * hn::Lanes(d);
      Others o;
      o.at = hn::PromoteTo(index, hn::LoadU(narrow, places + first));
      o.dx = hn::Sub(x, o.of(p.x)), o.dy = hn::Sub(y, o.of(p.y)), o.dz = hn::Sub(z, o.of(p.z));
      visit(part, first, o);
    }
}

/// visit(part, others without their ways, V f d) for all neighbours.
template <class Visit>
HWY_INLINE void each_gradient(const FluidList& list, const Visit& visit) {
  const FluidTag d;
  const hn::Rebind<int32_t, FluidTag> narrow;
  const hn::Rebind<float, FluidTag> single;
  const hn::RebindToSigned<FluidTag> index;
  const auto* places = reinterpret_cast<const int32_t*>(list.others.data());
  for (size_t k = 0; k < list.others.size(); k += fluid_batch)
    for (size_t part = 0; part < fluid_parts; ++part) {
      const size_t within = part * hn::Lanes(d);
      const float* g = list.gradients + 3 * k + within;
      const auto at = hn::PromoteTo(index, hn::LoadU(narrow, places + k + within));
      visit(part, at, hn::PromoteTo(d, hn::LoadU(single, g)),
            hn::PromoteTo(d, hn::LoadU(single, g + fluid_batch)),
            hn::PromoteTo(d, hn::LoadU(single, g + 2 * fluid_batch)));
    }
}

/// Parts of kernels: W / scale, and dW/dr reach / scale.
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

struct Distances {
  FluidLanes r, inverse, u, w;
  HWY_INLINE Distances(const Others& o, FluidLanes per_reach) {
    r = hn::Sqrt(o.squared());
    // Two at one place push each other nowhere.
    inverse = hn::IfThenElseZero(hn::Gt(r, every(0)), hn::Div(every(1), r));
    const FluidLanes q = hn::Mul(r, per_reach);
    u = hn::Max(every(0), hn::Sub(every(1), q));
    w = hn::Max(every(0), hn::Sub(every(0.5), q));
  }
};

template <class Kernel>
DensitySum densities(const SmoothingKernel& kernel, const FluidPoints& p, const double* volume,
                     const FluidList& list, float* gradients) {
  const FluidTag d;
  const hn::Rebind<float, FluidTag> single;
  const FluidLanes per_reach = every(1 / kernel.reach());
  const FluidLanes per_slope = every(kernel.scale() / kernel.reach());
  LaneSum share, squares;
  VectorSum gradient;
  each_batch(p, list, [&](size_t part, size_t first, const Others& o) {
    const Distances at(o, per_reach);
    const FluidLanes v = o.of(volume);
    share.add(part, hn::Mul(v, Kernel::value(at.u, at.w)));
    const FluidLanes slope = hn::Mul(per_slope, Kernel::slope(at.u, at.w));
    const FluidLanes f = hn::Mul(v, hn::Mul(slope, at.inverse));
    float* to = gradients + 3 * (first / fluid_batch * fluid_batch) + first % fluid_batch;
    const auto store = [&](FluidLanes v, float* where) {
      const auto rounded = hn::DemoteTo(single, v);
      hn::StoreU(rounded, single, where);
      return hn::PromoteTo(d, rounded);
    };
    const FluidLanes one = every(1);
    gradient.add(part, one, store(hn::Mul(f, o.dx), to), store(hn::Mul(f, o.dy), to + fluid_batch),
                 store(hn::Mul(f, o.dz), to + 2 * fluid_batch));
    squares.add(part, hn::Mul(v, hn::Mul(slope, slope)));
  });
  const Vec3 g = gradient.total();
  return {kernel.scale() * share.total(), g[0], g[1], g[2], squares.total()};
}

template <class Kernel>
Vec3 differences(const SmoothingKernel& kernel, const FluidPoints& p, const double* volume,
                 const Vectors& u, const FluidList& list) {
  const FluidLanes per_reach = every(1 / kernel.reach());
  const FluidLanes ux = every(u.x[list.place]), uy = every(u.y[list.place]),
                   uz = every(u.z[list.place]);
  VectorSum sum;
  each_batch(p, list, [&](size_t part, size_t, const Others& o) {
    const Distances at(o, per_reach);
    sum.add(part, hn::Mul(o.of(volume), Kernel::value(at.u, at.w)), hn::Sub(o.of(u.x), ux),
            hn::Sub(o.of(u.y), uy), hn::Sub(o.of(u.z), uz));
  });
  return kernel.scale() * sum.total();
}

DensitySum densities_here(const SmoothingKernel& kernel, const FluidPoints& p, const double* volume,
                          const FluidList& list, float* gradients) {
  return kernel.kind() == FluidKernelKind::wendland
             ? densities<WendlandLanes>(kernel, p, volume, list, gradients)
             : densities<CubicLanes>(kernel, p, volume, list, gradients);
}
Vec3 differences_here(const SmoothingKernel& kernel, const FluidPoints& p, const double* volume,
                      const Vectors& u, const FluidList& list) {
  return kernel.kind() == FluidKernelKind::wendland
             ? differences<WendlandLanes>(kernel, p, volume, u, list)
             : differences<CubicLanes>(kernel, p, volume, u, list);
}
Vec3 gradients_here(const double* value, const FluidList& list) {
  const FluidTag d;
  const FluidLanes own = every(value[list.place]);
  VectorSum sum;
  each_gradient(list, [&](size_t part, auto at, FluidLanes gx, FluidLanes gy, FluidLanes gz) {
    sum.add(part, hn::Add(own, hn::GatherIndex(d, value, at)), gx, gy, gz);
  });
  return sum.total();
}

double rates_here(const Vectors& u, const FluidList& list) {
  const FluidTag d;
  const FluidLanes ux = every(u.x[list.place]), uy = every(u.y[list.place]),
                   uz = every(u.z[list.place]);
  LaneSum sum;
  each_gradient(list, [&](size_t part, auto at, FluidLanes gx, FluidLanes gy, FluidLanes gz) {
    const auto from = [&](FluidLanes own, const double* values) {
      return hn::Sub(own, hn::GatherIndex(d, values, at));
    };
    sum.add(part, hn::Add(hn::Add(hn::Mul(from(ux, u.x), gx), hn::Mul(from(uy, u.y), gy)),
                          hn::Mul(from(uz, u.z), gz)));
  });
  return sum.total();
}

template <class Kernel>
Vec3 diffused(const SmoothingKernel& kernel, const FluidPoints& p, const double* volume,
              const Vectors& u, const FluidList& list) {
  const FluidLanes per_reach = every(1 / kernel.reach());
  const FluidLanes ux = every(u.x[list.place]), uy = every(u.y[list.place]),
                   uz = every(u.z[list.place]);
  VectorSum sum;
  each_batch(p, list, [&](size_t part, size_t, const Others& o) {
    const Distances at(o, per_reach);
    const FluidLanes f = hn::Mul(o.of(volume), hn::Mul(Kernel::slope(at.u, at.w), at.inverse));
    sum.add(part, f, hn::Sub(ux, o.of(u.x)), hn::Sub(uy, o.of(u.y)), hn::Sub(uz, o.of(u.z)));
  });
  return kernel.scale() / kernel.reach() * sum.total();
}

template <class Kernel>
double slopes(const SmoothingKernel& kernel, const FluidPoints& p, const double* volume,
              const FluidList& list) {
  const FluidLanes per_reach = every(1 / kernel.reach());
  LaneSum sum;
  each_batch(p, list, [&](size_t part, size_t, const Others& o) {
    const Distances at(o, per_reach);
    sum.add(part, hn::Mul(o.of(volume), hn::Mul(Kernel::slope(at.u, at.w), at.inverse)));
  });
  return kernel.scale() / kernel.reach() * sum.total();
}

Vec3 diffused_here(const SmoothingKernel& kernel, const FluidPoints& p, const double* volume,
                   const Vectors& u, const FluidList& list) {
  return kernel.kind() == FluidKernelKind::wendland
             ? diffused<WendlandLanes>(kernel, p, volume, u, list)
             : diffused<CubicLanes>(kernel, p, volume, u, list);
}
double slopes_here(const SmoothingKernel& kernel, const FluidPoints& p, const double* volume,
                   const FluidList& list) {
  return kernel.kind() == FluidKernelKind::wendland ? slopes<WendlandLanes>(kernel, p, volume, list)
                                                    : slopes<CubicLanes>(kernel, p, volume, list);
}

}  // namespace tumble::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tumble {
HWY_EXPORT(densities_here);
HWY_EXPORT(differences_here);
HWY_EXPORT(gradients_here);
HWY_EXPORT(rates_here);
HWY_EXPORT(diffused_here);
HWY_EXPORT(slopes_here);

DensitySum sum_densities(const SmoothingKernel& kernel, const FluidPoints& points,
                         const double* volume, const FluidList& list, float* gradients) {
  return HWY_DYNAMIC_DISPATCH(densities_here)(kernel, points, volume, list, gradients);
}
Vec3 sum_gradients(const double* value, const FluidList& list) {
  return HWY_DYNAMIC_DISPATCH(gradients_here)(value, list);
}
double sum_rates(const Vectors& u, const FluidList& list) {
  return HWY_DYNAMIC_DISPATCH(rates_here)(u, list);
}
Vec3 sum_diffused(const SmoothingKernel& kernel, const FluidPoints& points, const double* volume,
                  const Vectors& u, const FluidList& list) {
  return HWY_DYNAMIC_DISPATCH(diffused_here)(kernel, points, volume, u, list);
}
double sum_slopes(const SmoothingKernel& kernel, const FluidPoints& points, const double* volume,
                  const FluidList& list) {
  return HWY_DYNAMIC_DISPATCH(slopes_here)(kernel, points, volume, list);
}
Vec3 sum_differences(const SmoothingKernel& kernel, const FluidPoints& points, const double* volume,
                     const Vectors& u, const FluidList& list) {
  return HWY_DYNAMIC_DISPATCH(differences_here)(kernel, points, volume, u, list);
}
}  // namespace tumble
#endif
