// Sums over the pairs of a block: three numbers of a pair and as many of its neighbour's row are
// one vector of four each, the last of which counts nothing.
#include "engine/dynamics/sph/block_sums.hpp"

#include <algorithm>
#include <cmath>

// This file once per instruction set, then what each time needs.
// clang-format off
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "engine/dynamics/sph/block_sums.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace tumble::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Four numbers of a type.
template <class T>
struct BlockFour {
  using Tag = hn::CappedTag<T, 4>;
  static constexpr size_t lanes = hn::MaxLanes(Tag()), count = 4 / lanes;
  hn::Vec<Tag> parts[count];

  static HWY_INLINE BlockFour of(T v) {
    BlockFour q;
    for (auto& part : q.parts) part = hn::Set(Tag(), v);
    return q;
  }
  static HWY_INLINE BlockFour load(const T* from) {
    BlockFour q;
    for (size_t k = 0; k < count; ++k) q.parts[k] = hn::LoadU(Tag(), from + k * lanes);
    return q;
  }
  HWY_INLINE void store(T* to) const {
    for (size_t k = 0; k < count; ++k) hn::StoreU(parts[k], Tag(), to + k * lanes);
  }
  /// Four times the number `k`.
  template <int k>
  HWY_INLINE BlockFour all() const {
    if constexpr (count == 1 && sizeof(T) == sizeof(float)) {
      return {{hn::Broadcast<k>(parts[0])}};
    } else {
      HWY_ALIGN T v[4];
      store(v);
      return of(v[k]);
    }
  }
};
template <class T>
HWY_INLINE BlockFour<T> operator+(const BlockFour<T>& a, const BlockFour<T>& b) {
  BlockFour<T> q;
  for (size_t k = 0; k < a.count; ++k) q.parts[k] = hn::Add(a.parts[k], b.parts[k]);
  return q;
}
template <class T>
HWY_INLINE BlockFour<T> operator-(const BlockFour<T>& a, const BlockFour<T>& b) {
  BlockFour<T> q;
  for (size_t k = 0; k < a.count; ++k) q.parts[k] = hn::Sub(a.parts[k], b.parts[k]);
  return q;
}
template <class T>
HWY_INLINE BlockFour<T> operator*(const BlockFour<T>& a, const BlockFour<T>& b) {
  BlockFour<T> q;
  for (size_t k = 0; k < a.count; ++k) q.parts[k] = hn::Mul(a.parts[k], b.parts[k]);
  return q;
}
using Quad = BlockFour<float>;
using Fours = BlockFour<double>;

/// Four numbers in single precision of four in double.
HWY_INLINE Quad demoted(const Fours& from) {
  using Half = hn::Rebind<float, Fours::Tag>;
  HWY_ALIGN float to[4];
  for (size_t k = 0; k < Fours::count; ++k)
    hn::StoreU(hn::DemoteTo(Half(), from.parts[k]), Half(), to + k * Fours::lanes);
  return Quad::load(to);
}
/// The sum of four sums of every fourth pair.
template <class T>
HWY_INLINE BlockFour<T> total(const BlockFour<T> (&sums)[4]) {
  return (sums[0] + sums[2]) + (sums[1] + sums[3]);
}

/// Columns of the matrix by which ways are multiplied [1/m], times a factor.
HWY_INLINE void find_columns(const BlockPoints& of, size_t place, double factor,
                             double (&columns)[3][4]) {
  const double unit = factor / of.length_unit;
  for (int c = 0; c < 3; ++c) {
    for (int r = 0; r < 3; ++r)
      columns[c][r] = of.corrections ? unit * of.corrections[place](r, c) : (r == c ? unit : 0);
    columns[c][3] = 0;
  }
}
/// A matrix by its columns, times the first three numbers of x.
template <class T>
HWY_INLINE BlockFour<T> times(const BlockFour<T> (&columns)[3], const BlockFour<T>& x) {
  return (columns[0] * x.template all<0>() + columns[1] * x.template all<1>()) +
         columns[2] * x.template all<2>();
}

/// Rounded to whole numbers, which are written.
HWY_INLINE Quad round_to(const Quad& from, int16_t* to) {
  using Whole = hn::RebindToSigned<Quad::Tag>;
  using Short = hn::Rebind<int16_t, Quad::Tag>;
  Quad q;
  for (size_t k = 0; k < from.count; ++k) {
    const auto whole = hn::NearestInt(from.parts[k]);
    hn::StoreU(hn::DemoteTo(Short(), whole), Short(), to + k * Quad::lanes);
    q.parts[k] = hn::ConvertTo(Quad::Tag(), hn::Vec<Whole>(whole));
  }
  return q;
}

/// No gradient's number is larger than this [1/length unit]: the longest row of the correction.
HWY_INLINE double most_of_gradient(const BlockPoints& of, size_t place) {
  if (!of.corrections) return of.steepest;
  double longest = 0;
  for (int r = 0; r < 3; ++r)
    longest = std::max(longest, of.corrections[place].row(r).squaredNorm());
  return of.steepest * std::sqrt(longest);
}

void make_here(const BlockPoints& of, const FluidBlock& block, const float* volumes,
               BlockPair* pairs, float* units, SingleVector* sums) {
  size_t k = 0;
  for (size_t p = 0; p < block.ends.size(); ++p) {
    const size_t place = block.first + p;
    const Fours at = Fours::load(&of.points[place].x);
    units[p] = float(most_of_gradient(of, place) / INT16_MAX);
    HWY_ALIGN double numbers[3][4];
    find_columns(of, place, 1 / double(units[p]), numbers);
    const Quad columns[3] = {demoted(Fours::load(numbers[0])), demoted(Fours::load(numbers[1])),
                             demoted(Fours::load(numbers[2]))};
    const Quad diagonal = columns[0] + columns[1] + columns[2];
    Quad sum = Quad::of(0);
    const auto keep = [&](size_t other, const Quad& gradient) HWY_ATTR {
      int16_t rounded[4];
      sum = sum + Quad::of(volumes[other]) * round_to(gradient, rounded);
      pairs[k] = {rounded[0], rounded[1], rounded[2], block.others[k]};
    };
    const auto way = [&](size_t other) HWY_ATTR {
      return Quad::of(block.slopes[k]) * demoted(at - Fours::load(&of.points[other].x));
    };
    if (of.corrections)
      for (; k < block.ends[p]; ++k) {
        const size_t other = block.rows[block.others[k]];
        keep(other, times(columns, way(other)));
      }
    else
      for (; k < block.ends[p]; ++k) {
        const size_t other = block.rows[block.others[k]];
        keep(other, diagonal * way(other));
      }
    (Quad::of(units[p]) * sum).store(&sums[p].x);
  }
}

/// f(particle, its first pair, and the last) for particles of a block.
template <class F>
HWY_INLINE void each_of_block(const FluidBlock& block, size_t first, size_t end, const F& f) {
  size_t k = first == 0 ? 0 : block.ends[first - 1];
  for (size_t p = first; p < end; ++p) {
    f(p, k, size_t(block.ends[p]));
    k = block.ends[p];
  }
}

/// Four pairs at once: vectors of as many numbers as there are, 4 for each pair.
template <class Tag>
class FourPairs {
 public:
  static constexpr size_t lanes = hn::MaxLanes(Tag()), count = 16 / lanes;
  HWY_INLINE FourPairs() {
    for (auto& sum : sums_) sum = hn::Zero(Tag());
  }
  HWY_INLINE void add(const BlockPair* pairs, const BlockRow* rows) {
    const hn::Rebind<int16_t, Tag> shorts;
    const hn::Rebind<int32_t, Tag> wholes;
    for (size_t k = 0; k < count; ++k) {
      const auto rounded = hn::PromoteTo(wholes, hn::LoadU(shorts, &pairs->x + k * lanes));
      sums_[k] = hn::Add(
          sums_[k], hn::Mul(flows(pairs + k * lanes / 4, rows, k), hn::ConvertTo(Tag(), rounded)));
    }
  }
  /// In the order of total().
  HWY_INLINE float sum_of_three() const {
    HWY_ALIGN float v[4];
#if HWY_TARGET != HWY_SCALAR
    if constexpr (lanes == 16) {
      const hn::Half<Tag> half;
      const hn::Half<decltype(half)> quarter;
      const auto two = hn::Add(hn::LowerHalf(half, sums_[0]), hn::UpperHalf(half, sums_[0]));
      hn::Store(hn::Add(hn::LowerHalf(quarter, two), hn::UpperHalf(quarter, two)), quarter, v);
    } else if constexpr (lanes == 8) {
      const hn::Half<Tag> quarter;
      const auto two = hn::Add(sums_[0], sums_[1]);
      hn::Store(hn::Add(hn::LowerHalf(quarter, two), hn::UpperHalf(quarter, two)), quarter, v);
    } else
#endif
    {
      constexpr size_t n = count / 4;
      for (size_t k = 0; k < n; ++k)
        hn::Store(
            hn::Add(hn::Add(sums_[k], sums_[2 * n + k]), hn::Add(sums_[n + k], sums_[3 * n + k])),
            Tag(), v + k * lanes);
    }
    return (v[0] + v[1]) + v[2];
  }

 private:
  /// The flows of the others, of as many pairs as there is room for.
  static HWY_INLINE hn::Vec<Tag> flows(const BlockPair* pairs, const BlockRow* rows, size_t part) {
#if HWY_TARGET != HWY_SCALAR
    const auto flow = [&](size_t k) HWY_ATTR {
      return hn::Load(hn::CappedTag<float, 4>(), &rows[pairs[k].row].flow.x);
    };
    if constexpr (lanes == 16) {
      const hn::Half<Tag> half;
      return hn::Combine(Tag(), hn::Combine(half, flow(3), flow(2)),
                         hn::Combine(half, flow(1), flow(0)));
    } else if constexpr (lanes == 8) {
      return hn::Combine(Tag(), flow(1), flow(0));
    } else
#endif
      return hn::Load(Tag(), &rows[pairs[0].row].flow.x + part * lanes % 4);
  }
  hn::Vec<Tag> sums_[count];
};

void open_here(const FluidBlock& block, const BlockPair* pairs, const BlockRow* rows, size_t first,
               size_t end, float* sums) {
  each_of_block(block, first, end, [&](size_t p, size_t k, size_t last) HWY_ATTR {
    FourPairs<hn::CappedTag<float, 16>> four;
    for (; k < last; k += 4) four.add(pairs + k, rows);
    sums[p - first] = four.sum_of_three();
  });
}

void press_here(const FluidBlock& block, const BlockPair* pairs, const float* weights, size_t first,
                size_t end, BlockRow* rows) {
  using Short = hn::Rebind<int16_t, Quad::Tag>;
  using Whole = hn::Rebind<int32_t, Quad::Tag>;
  each_of_block(block, first, end, [&](size_t p, size_t k, size_t last) HWY_ATTR {
    const float w = weights[p - first];
    if (w == 0) return;
    HWY_ALIGN const float every[4] = {w, w, w, 0};
    const Quad weight = Quad::load(every);
    for (; k < last; k += 4)
      for (size_t n = 0; n < 4; ++n) {
        const BlockPair& pair = pairs[k + n];
        Quad gradient;
        for (size_t j = 0; j < Quad::count; ++j)
          gradient.parts[j] = hn::ConvertTo(
              Quad::Tag(), hn::PromoteTo(Whole(), hn::LoadU(Short(), &pair.x + j * Quad::lanes)));
        float* push = &rows[pair.row].push.x;
        (Quad::load(push) + weight * gradient).store(push);
      }
  });
}

void exactly_here(const BlockPoints& of, const FluidBlock& block, const double* weights,
                  FluidVector* rows, FluidVector* own) {
  each_of_block(block, 0, block.ends.size(), [&](size_t p, size_t k, size_t last) HWY_ATTR {
    Fours sums[4] = {Fours::of(0), Fours::of(0), Fours::of(0), Fours::of(0)};
    const size_t place = block.first + p;
    // The fourth number of a row is no push: the columns have none.
    HWY_ALIGN double numbers[3][4];
    find_columns(of, place, weights[place], numbers);
    const Fours columns[3] = {Fours::load(numbers[0]), Fours::load(numbers[1]),
                              Fours::load(numbers[2])},
                at = Fours::load(&of.points[place].x);
    for (; k < last && weights[place] != 0; k += 4)
      for (size_t n = 0; n < 4; ++n) {
        const size_t other = block.others[k + n];
        FluidVector& row = rows[other];
        const Fours push = times(columns, Fours::of(double(block.slopes[k + n])) *
                                              (at - Fours::load(&of.points[block.rows[other]].x)));
        sums[n] = sums[n] + Fours::of(row.w) * push;
        (Fours::load(&row.x) + push).store(&row.x);
      }
    total(sums).store(&own[p].x);
  });
}

void spread_here(const BlockCopies& copies, size_t first, size_t last, const SingleVector* flows,
                 BlockRow* rows) {
  const Quad zero = Quad::of(0);
  for (size_t p = first; p < last; ++p) {
    const Quad flow = Quad::load(&flows[p].x);
    for (size_t k = copies.firsts[p]; k < copies.firsts[p + 1]; ++k) {
      BlockRow& row = rows[copies.rows[k]];
      flow.store(&row.flow.x);
      zero.store(&row.push.x);
    }
  }
}

void flow_here(const BlockCopies& copies, size_t first, size_t last, const SingleVector* gradients,
               const float* weights, SingleVector* flows, BlockRow* rows) {
  const Quad zero = Quad::of(0);
  for (size_t p = first; p < last; ++p) {
    const size_t begin = copies.firsts[p], end = copies.firsts[p + 1];
    Quad pushes = zero;
    for (size_t k = begin; k < end; ++k) {
      pushes = pushes + Quad::load(&rows[copies.rows[k]].push.x);
    }
    const float per_mass = gradients[p].w;
    const float each[4] = {per_mass, per_mass, per_mass, 0};
    const Quad flow =
        Quad::load(each) * (pushes - Quad::of(weights[p]) * Quad::load(&gradients[p].x));
    flow.store(&flows[p].x);
    for (size_t k = begin; k < end; ++k) {
      BlockRow& row = rows[copies.rows[k]];
      flow.store(&row.flow.x);
      zero.store(&row.push.x);
    }
  }
}

}  // namespace tumble::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tumble {
HWY_EXPORT(make_here);
HWY_EXPORT(open_here);
HWY_EXPORT(press_here);
HWY_EXPORT(exactly_here);
HWY_EXPORT(spread_here);
HWY_EXPORT(flow_here);

void make_pairs(const BlockPoints& of, const FluidBlock& block, const float* volumes,
                BlockPair* pairs, float* units, SingleVector* sums) {
  HWY_DYNAMIC_DISPATCH(make_here)(of, block, volumes, pairs, units, sums);
}
void open_pairs(const FluidBlock& block, const BlockPair* pairs, const BlockRow* rows, size_t first,
                size_t end, float* sums) {
  HWY_DYNAMIC_DISPATCH(open_here)(block, pairs, rows, first, end, sums);
}
void press_pairs(const FluidBlock& block, const BlockPair* pairs, const float* weights,
                 size_t first, size_t end, BlockRow* rows) {
  HWY_DYNAMIC_DISPATCH(press_here)(block, pairs, weights, first, end, rows);
}
void flow_by_pushes(const BlockCopies& copies, size_t first_place, size_t last_place,
                    const SingleVector* gradients, const float* weights, SingleVector* flows,
                    BlockRow* rows) {
  HWY_DYNAMIC_DISPATCH(flow_here)
  (copies, first_place, last_place, gradients, weights, flows, rows);
}
void spread_flows(const BlockCopies& copies, size_t first_place, size_t last_place,
                  const SingleVector* flows, BlockRow* rows) {
  HWY_DYNAMIC_DISPATCH(spread_here)(copies, first_place, last_place, flows, rows);
}
void press_exactly(const BlockPoints& of, const FluidBlock& block, const double* weights,
                   FluidVector* rows, FluidVector* own) {
  HWY_DYNAMIC_DISPATCH(exactly_here)(of, block, weights, rows, own);
}
}  // namespace tumble
#endif
