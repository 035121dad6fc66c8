// Pairs are found sixteen at a time, four particles with four neighbours, and summed in double four
// at a time. What is read of a neighbour serves four particles; gathering numbers one by one from
// all over memory would take several times as long.
#include "engine/dynamics/sph/fluid_sums.hpp"

// This file once per instruction set, then what each time needs.
// clang-format off
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "engine/dynamics/sph/fluid_sums.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "engine/dynamics/sph/group_lanes-inl.hpp"
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace tumble::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// -- finding pairs

HWY_INLINE SixteenSingle every(float v) {
  return SixteenSingle::of(v);
}
HWY_INLINE SixteenSingle not_below_zero(const SixteenSingle& a) {
  SixteenSingle s;
  for (size_t k = 0; k < s.count; ++k)
    s.parts[k] = hn::Max(hn::Zero(SixteenSingle::Tag()), a.parts[k]);
  return s;
}
HWY_INLINE SixteenSingle root(const SixteenSingle& a) {
  SixteenSingle s;
  for (size_t k = 0; k < s.count; ++k) s.parts[k] = hn::Sqrt(a.parts[k]);
  return s;
}
/// a / b; where b is zero, zero.
HWY_INLINE SixteenSingle over(const SixteenSingle& a, const SixteenSingle& b) {
  SixteenSingle s;
  for (size_t k = 0; k < s.count; ++k)
    s.parts[k] = hn::IfThenElseZero(hn::Gt(b.parts[k], hn::Zero(SixteenSingle::Tag())),
                                    hn::Div(a.parts[k], b.parts[k]));
  return s;
}
/// 1 where a is less than 1, else 0.
HWY_INLINE SixteenSingle below_one(const SixteenSingle& a) {
  SixteenSingle s;
  const auto one = hn::Set(SixteenSingle::Tag(), 1.0f);
  for (size_t k = 0; k < s.count; ++k)
    s.parts[k] = hn::IfThenElseZero(hn::Lt(a.parts[k], one), one);
  return s;
}

/// Parts of kernels, of u and w as in SmoothingKernel: W / scale, and dW/dr reach / scale.
struct CubicLanes {
  static HWY_INLINE SixteenSingle value(const SixteenSingle& u, const SixteenSingle& w) {
    return every(2) * (u * u * u) - every(8) * (w * w * w);
  }
  static HWY_INLINE SixteenSingle slope(const SixteenSingle& u, const SixteenSingle& w) {
    return every(24) * (w * w) - every(6) * (u * u);
  }
};
struct WendlandLanes {
  static HWY_INLINE SixteenSingle value(const SixteenSingle& u, const SixteenSingle&) {
    const SixteenSingle u2 = u * u;
    return (u2 * u2) * (every(5) - every(4) * u);
  }
  static HWY_INLINE SixteenSingle slope(const SixteenSingle& u, const SixteenSingle&) {
    return (every(-20) * (every(1) - u)) * (u * (u * u));
  }
};

/// The particles of a group, and their sums.
template <class Kernel, bool moments>
class PairFinder {
 public:
  HWY_INLINE PairFinder(const SmoothingKernel& kernel, const FluidPoints& points,
                        const FluidGroup& group, float per_rounded)
      : points_(points), per_reach_(float(1 / kernel.reach())), per_rounded_(per_rounded) {
    HWY_ALIGN double own[3][FluidGroup::size];
    for (size_t n = 0; n < FluidGroup::size; ++n) {
      const FluidVector& at = points.at[group.place(n)];
      own[0][n] = at.x, own[1][n] = at.y, own[2][n] = at.z;
    }
    for (size_t c = 0; c < 3; ++c) own_[c] = GroupFour::load(own[c]), gradient_[c] = {};
    for (size_t c = 0; c < 3; ++c) gradient_[c] = GroupFour::of(0);
    slopes_ = GroupFour::of(0);
    share_ = squares_ = pairs_ = every(0);
    for (size_t n = 0; n < symmetric; ++n) moment_[n] = square_matrix_[n] = every(0);
  }

  /// With four neighbours.
  HWY_INLINE void four(const uint32_t* others, float* slopes, float* weights, int16_t* rounded) {
    HWY_ALIGN double ways[3][16];
    HWY_ALIGN float singles[3][16];
    for (size_t k = 0; k < 4; ++k) {
      FluidGroup::fetch(points_.at, others + k);
      const FluidVector& at = points_.at[others[k]];
      const GroupFour way[3] = {own_[0] - GroupFour::of(at.x), own_[1] - GroupFour::of(at.y),
                                own_[2] - GroupFour::of(at.z)};
      for (size_t c = 0; c < 3; ++c) {
        way[c].store(ways[c] + 4 * k);
        way[c].store_single(singles[c] + 4 * k);
      }
    }
    const SixteenSingle x = SixteenSingle::load(singles[0]), y = SixteenSingle::load(singles[1]),
                        z = SixteenSingle::load(singles[2]);
    const SixteenSingle q = root((x * x + y * y) + z * z) * every(per_reach_);
    const SixteenSingle u = not_below_zero(every(1) - q), w = not_below_zero(every(0.5f) - q);
    const SixteenSingle slope = Kernel::slope(u, w), value = Kernel::value(u, w);
    // Two at one place push each other nowhere.
    const SixteenSingle f = over(slope, q);
    f.store(slopes);
    if (weights) value.store(weights);
    store_rounded(f * every(per_rounded_), rounded);
    const SixteenSingle volumes = SixteenSingle::rows(&points_.volumes->x, 4, others);
    const SixteenSingle v = volumes.each<0>(), per_density = volumes.each<1>();
    pairs_ = pairs_ + below_one(q);
    share_ = share_ + v * value;
    squares_ = squares_ + per_density * (slope * slope);
    if constexpr (moments) {
      add_products(moment_, v * f, x, y, z);
      add_products(square_matrix_, per_density * (f * f), x, y, z);
    }
    for (size_t k = 0; k < 4; ++k) {
      const GroupFour each =
          GroupFour::load(slopes + 4 * k) * GroupFour::of(points_.at[others[k]].w);
      for (size_t c = 0; c < 3; ++c)
        gradient_[c] = gradient_[c] + each * GroupFour::load(ways[c] + 4 * k);
      slopes_ = slopes_ + each;
    }
  }
  HWY_INLINE void finish(const SmoothingKernel& kernel, size_t count, FluidPairSums* out) const {
    const double per_reach = kernel.scale() / kernel.reach(), unit = per_reach / kernel.reach();
    double gradients[3][4], slopes[4];
    for (size_t c = 0; c < 3; ++c) gradient_[c].store(gradients[c]);
    slopes_.store(slopes);
    float pairs[4], share[4], squares[4];
    pairs_.total(pairs), share_.total(share), squares_.total(squares);
    for (size_t n = 0; n < count; ++n) {
      FluidPairSums& to = out[n];
      to.pairs = size_t(pairs[n]) - 1;
      to.gx = unit * gradients[0][n];
      to.gy = unit * gradients[1][n];
      to.gz = unit * gradients[2][n];
      to.slopes = unit * slopes[n];
      to.share = kernel.scale() * double(share[n]);
      to.squares = per_reach * per_reach * double(squares[n]);
    }
    if constexpr (moments) {
      float moment[symmetric][4], square[symmetric][4];
      for (size_t k = 0; k < symmetric; ++k)
        moment_[k].total(moment[k]), square_matrix_[k].total(square[k]);
      for (size_t n = 0; n < count; ++n) {
        out[n].moment = matrix(-unit, moment, n);
        out[n].square_matrix = matrix(unit * unit, square, n);
      }
    }
  }

 private:
  static constexpr size_t symmetric = 6;  ///< numbers of a symmetric matrix
  using Products = SixteenSingle[symmetric];

  static HWY_INLINE void add_products(Products& to, const SixteenSingle& factor,
                                      const SixteenSingle& x, const SixteenSingle& y,
                                      const SixteenSingle& z) {
    const SixteenSingle fx = factor * x, fy = factor * y, fz = factor * z;
    to[0] = to[0] + fx * x;
    to[1] = to[1] + fx * y;
    to[2] = to[2] + fx * z;
    to[3] = to[3] + fy * y;
    to[4] = to[4] + fy * z;
    to[5] = to[5] + fz * z;
  }
  static Mat3 matrix(double unit, const float (&from)[symmetric][4], size_t n) {
    double v[symmetric];
    for (size_t k = 0; k < symmetric; ++k) v[k] = unit * double(from[k][n]);
    return {v[0], v[1], v[2], v[1], v[3], v[4], v[2], v[4], v[5]};
  }

  const FluidPoints& points_;
  float per_reach_, per_rounded_;
  GroupFour own_[3], gradient_[3], slopes_;
  SixteenSingle share_, squares_, pairs_;
  Products moment_, square_matrix_;
};

template <class Kernel, bool moments>
void pairs_of(const SmoothingKernel& kernel, const FluidPoints& points, FluidPairs& pairs,
              size_t first, size_t end, FluidPairSums* sums) {
  const auto per_rounded = float(1 / pairs.rounded_unit());
  for (size_t g = first; g < end; ++g) {
    const FluidGroup group = pairs.group(g);
    const FluidPairs::Room room = pairs.room(g);
    PairFinder<Kernel, moments> finder(kernel, points, group, per_rounded);
    for (size_t k = 0; k < group.padded; k += 4)
      finder.four(group.others + k, room.slopes + 4 * k,
                  room.weights ? room.weights + 4 * k : nullptr, room.rounded + 4 * k);
    finder.finish(kernel, group.count, sums);
    sums += group.count;
  }
}

void pairs_here(const SmoothingKernel& kernel, FluidMoments moments, const FluidPoints& points,
                FluidPairs& pairs, size_t first, size_t end, FluidPairSums* sums) {
  const bool wendland = kernel.kind() == FluidKernelKind::wendland;
  if (moments == FluidMoments::found)
    (wendland ? pairs_of<WendlandLanes, true> : pairs_of<CubicLanes, true>)(kernel, points, pairs,
                                                                            first, end, sums);
  else
    (wendland ? pairs_of<WendlandLanes, false> : pairs_of<CubicLanes, false>)(kernel, points, pairs,
                                                                              first, end, sums);
}

// -- sums over them

/// Four vectors, of four particles each a number, to those of particles.
HWY_INLINE void write_vectors(const GroupFour (&from)[4], double unit, size_t count,
                              FluidVector* to) {
  double v[4][4];
  for (size_t c = 0; c < 4; ++c) from[c].store(v[c]);
  for (size_t n = 0; n < count; ++n)
    to[n] = {unit * v[0][n], unit * v[1][n], unit * v[2][n], unit * v[3][n]};
}

/// Of four particles: factors times means times y.
template <class Mean>
HWY_INLINE void sum_group(const FluidGroup& group, const float* factors, const FluidVector* y,
                          double unit, const Mean& mean, FluidVector* sums) {
  GroupFour all[4] = {GroupFour::of(0), GroupFour::of(0), GroupFour::of(0), GroupFour::of(0)};
  for (size_t k = 0; k < group.padded; ++k) {
    const size_t other = group.others[k];
    FluidGroup::fetch(y, group.others + k);
    const GroupFour f = mean(GroupFour::load(factors + 4 * k), other);
    const FluidVector& of = y[other];
    all[0] = all[0] + f * GroupFour::of(of.x);
    all[1] = all[1] + f * GroupFour::of(of.y);
    all[2] = all[2] + f * GroupFour::of(of.z);
    all[3] = all[3] + f * GroupFour::of(of.w);
  }
  write_vectors(all, unit, group.count, sums);
}

/// of_mean() of four particles.
HWY_INLINE GroupFour of_means(const GroupFour& own, double other) {
  GroupFour f;
  const auto two = hn::Set(GroupFour::Tag(), 2 * other);
  const GroupFour both = own + GroupFour::of(other);
  for (size_t k = 0; k < f.count; ++k)
    f.parts[k] = hn::IfThenElseZero(hn::Gt(both.parts[k], hn::Zero(GroupFour::Tag())),
                                    hn::Div(two, both.parts[k]));
  return f;
}

void sums_here(const FluidPairs& pairs, FluidFactor factor, size_t first, size_t end,
               const FluidVector* y, const double* q, FluidVector* sums) {
  const bool slopes = factor == FluidFactor::slope;
  const double unit = slopes ? pairs.slope_unit() : pairs.weight_unit();
  for (size_t g = first; g < end; ++g) {
    const FluidGroup group = pairs.group(g);
    const float* factors = slopes ? group.slopes : group.weights;
    if (q) {
      double own[FluidGroup::size];
      for (size_t n = 0; n < FluidGroup::size; ++n) own[n] = q[group.place(n)];
      const GroupFour owns = GroupFour::load(own);
      sum_group(
          group, factors, y, unit,
          [&](const GroupFour& f, size_t other) HWY_ATTR { return f * of_means(owns, q[other]); },
          sums);
    } else {
      sum_group(
          group, factors, y, unit, [](const GroupFour& f, size_t) HWY_ATTR { return f; }, sums);
    }
    sums += group.count;
  }
}

void exactly_here(const FluidPairs& pairs, size_t first, size_t end, const FluidVector* at,
                  const SymmetricRow<double>* stresses, FluidVector* sums) {
  for (size_t g = first; g < end; ++g) {
    const FluidGroup group = pairs.group(g);
    double own[3][FluidGroup::size];
    for (size_t n = 0; n < FluidGroup::size; ++n) {
      const FluidVector& from = at[group.place(n)];
      own[0][n] = from.x, own[1][n] = from.y, own[2][n] = from.z;
    }
    const GroupFour x = GroupFour::load(own[0]), y = GroupFour::load(own[1]),
                    z = GroupFour::load(own[2]);
    GroupFour all[4] = {GroupFour::of(0), GroupFour::of(0), GroupFour::of(0), GroupFour::of(0)};
    for (size_t k = 0; k < group.padded; ++k) {
      FluidGroup::fetch(at, group.others + k);
      FluidGroup::fetch(stresses, group.others + k);
      const FluidVector& other = at[group.others[k]];
      const SymmetricRow<double>& t = stresses[group.others[k]];
      const GroupFour f = GroupFour::load(group.slopes + 4 * k);
      const GroupFour gx = f * (x - GroupFour::of(other.x)), gy = f * (y - GroupFour::of(other.y)),
                      gz = f * (z - GroupFour::of(other.z));
      const GroupFour xy = GroupFour::of(t.xy), yz = GroupFour::of(t.yz), zx = GroupFour::of(t.zx);
      all[0] = all[0] + ((GroupFour::of(t.xx) * gx + xy * gy) + zx * gz);
      all[1] = all[1] + ((xy * gx + GroupFour::of(t.yy) * gy) + yz * gz);
      all[2] = all[2] + ((zx * gx + yz * gy) + GroupFour::of(t.zz) * gz);
    }
    write_vectors(all, pairs.slope_unit(), group.count, sums);
    sums += group.count;
  }
}

}  // namespace tumble::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tumble {
HWY_EXPORT(pairs_here);
HWY_EXPORT(sums_here);
HWY_EXPORT(exactly_here);

void FluidPairs::make_room(const NeighbourLists& lists, const SmoothingKernel& kernel,
                           bool weights) {
  lists_ = &lists;
  slope_unit_ = kernel.scale() / (kernel.reach() * kernel.reach());
  weight_unit_ = kernel.scale();
  rounded_unit_ = kernel.sharpest() / slope_unit_ / INT16_MAX;
  size_t used = 0;
  firsts_.resize(groups());
  for (size_t g = 0; g < groups(); ++g) {
    firsts_[g] = used;
    used += FluidGroup::size * lists.groups()[g].padded;
  }
  const auto grow = [used](auto& all) {
    if (all.size() < used) all.resize(used + used / 8);
  };
  grow(slopes_), grow(rounded_);
  if (weights)
    grow(weights_);
  else
    weights_.clear();
}

void find_pairs(const SmoothingKernel& kernel, FluidMoments moments, const FluidPoints& points,
                FluidPairs& pairs, size_t first, size_t end, FluidPairSums* sums) {
  HWY_DYNAMIC_DISPATCH(pairs_here)(kernel, moments, points, pairs, first, end, sums);
}
void sum_pairs(const FluidPairs& pairs, FluidFactor factor, size_t first, size_t end,
               const FluidVector* y, const double* q, FluidVector* sums) {
  HWY_DYNAMIC_DISPATCH(sums_here)(pairs, factor, first, end, y, q, sums);
}
void push_exactly(const FluidPairs& pairs, size_t first, size_t end, const FluidVector* at,
                  const SymmetricRow<double>* stresses, FluidVector* sums) {
  HWY_DYNAMIC_DISPATCH(exactly_here)(pairs, first, end, at, stresses, sums);
}
}  // namespace tumble
#endif
