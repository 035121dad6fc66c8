// Pressures and rates of the particles of a block, in single precision. The numbers of each
// neighbour are made into a row first; a pair then loads the row as a whole and adds it to the sum
// of its particle, times its slope. Rows are vectors of four: one where slopes are plain; where
// they are corrected three, the columns of a matrix, and one more.
#include "engine/dynamics/sph/block_sums.hpp"

// This file once per instruction set, then what each time needs.
// clang-format off
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "engine/dynamics/sph/block_sums.cpp"
#include <hwy/cache_control.h>
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace tumble::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using QuadTag = hn::CappedTag<float, 4>;
constexpr size_t quad_lanes = hn::MaxLanes(QuadTag()), quad_parts = 4 / quad_lanes;

/// Four numbers in single precision.
struct Quad {
  hn::Vec<QuadTag> parts[quad_parts];
  static HWY_INLINE Quad of(float v) {
    Quad q;
    for (auto& part : q.parts) part = hn::Set(QuadTag(), v);
    return q;
  }
  static HWY_INLINE Quad load(const SingleVector& v) {
    Quad q;
    for (size_t k = 0; k < quad_parts; ++k) q.parts[k] = hn::Load(QuadTag(), &v.x + k * quad_lanes);
    return q;
  }
  HWY_INLINE void store(SingleVector& to) const {
    for (size_t k = 0; k < quad_parts; ++k) hn::Store(parts[k], QuadTag(), &to.x + k * quad_lanes);
  }
  HWY_INLINE SingleVector numbers() const {
    SingleVector v;
    store(v);
    return v;
  }
  /// Four times the number `k`.
  template <int k>
  HWY_INLINE Quad all() const {
    if constexpr (quad_parts == 1)
      return {{hn::Broadcast<k>(parts[0])}};
    else
      return of(hn::GetLane(parts[k]));
  }
  HWY_INLINE Quad with_fourth(float w) const {
    Quad q = *this;
    if constexpr (quad_parts == 1)
      q.parts[0] = hn::InsertLane(parts[0], 3, w);
    else
      q.parts[3] = hn::Set(QuadTag(), w);
    return q;
  }
  /// The first three numbers together.
  HWY_INLINE float sum_of_three() const {
    const SingleVector v = numbers();
    return (v.x + v.y) + v.z;
  }
};
static_assert(quad_parts == 1 || quad_lanes == 1);

HWY_INLINE Quad operator+(const Quad& a, const Quad& b) {
  Quad q;
  for (size_t k = 0; k < quad_parts; ++k) q.parts[k] = hn::Add(a.parts[k], b.parts[k]);
  return q;
}
HWY_INLINE Quad operator-(const Quad& a, const Quad& b) {
  Quad q;
  for (size_t k = 0; k < quad_parts; ++k) q.parts[k] = hn::Sub(a.parts[k], b.parts[k]);
  return q;
}
HWY_INLINE Quad operator*(const Quad& a, const Quad& b) {
  Quad q;
  for (size_t k = 0; k < quad_parts; ++k) q.parts[k] = hn::Mul(a.parts[k], b.parts[k]);
  return q;
}

/// Where particles are, from the centre of one block.
class BlockPoints {
 public:
  HWY_INLINE BlockPoints(const BlockOperands& of, const FluidBlock& block)
      : centres_(of.centres),
        centre_{block.centre[0], block.centre[1], block.centre[2], 0},
        per_unit_{1 / of.length_unit, 1 / of.length_unit, 1 / of.length_unit, 0} {}
  HWY_INLINE Quad operator()(const SingleVector& at) const {
    return Quad::load(at) + way_from<hn::CappedTag<double, 4>>(&centres_[size_t(at.w)].x);
  }

 private:
  /// From this block's centre to another one.
  template <class Tag>
  HWY_INLINE Quad way_from(const double* other) const {
    using Half = hn::Rebind<float, Tag>;
    constexpr size_t lanes = hn::MaxLanes(Tag());
    const auto part = [&](size_t k) HWY_ATTR {
      const auto d = hn::Sub(hn::Load(Tag(), other + k), hn::Load(Tag(), centre_ + k));
      return hn::DemoteTo(Half(), hn::Mul(d, hn::Load(Tag(), per_unit_ + k)));
    };
    if constexpr (lanes == quad_lanes) {
      Quad way;
      for (size_t k = 0; k < quad_parts; ++k) way.parts[k] = part(k * lanes);
      return way;
    } else {
      // Vectors of 128 bits hold two numbers in double precision and four in single.
      SingleVector way;
      for (size_t k = 0; k < 4; k += lanes) hn::StoreU(part(k), Half(), &way.x + k);
      return Quad::load(way);
    }
  }

  const FluidVector* centres_;
  HWY_ALIGN double centre_[4];
  HWY_ALIGN double per_unit_[4];
};

/// f(row, place) for the rows of a block. What they are made of is all over memory: it is asked for
/// some rows before.
template <class Of, class F>
HWY_INLINE void each_row(const FluidBlock& block, const Of* of, const F& f) {
  constexpr size_t ahead = 16;
  const size_t n = block.rows.size();
  for (size_t r = 0; r < n; ++r) {
    if (r + ahead < n) hwy::Prefetch(of + block.rows[r + ahead]);
    f(r, size_t(block.rows[r]));
  }
}

/// f(particle, its sum of rows) for all particles of a block.
template <size_t quads, class F>
HWY_INLINE void each_block_sum(const FluidBlock& block, const SingleVector* rows, const F& f) {
  using Tag = hn::CappedTag<float, 4 * quads>;
  constexpr size_t lanes = hn::MaxLanes(Tag()), parts = 4 * quads / lanes;
  size_t k = 0;
  for (size_t p = 0; p < block.ends.size(); ++p) {
    hn::Vec<Tag> sums[4][parts];
    for (auto& sum : sums)
      for (auto& part : sum) part = hn::Zero(Tag());
    for (; k < block.ends[p]; k += 4)
      for (size_t n = 0; n < 4; ++n) {
        const auto slope = hn::Set(Tag(), block.slopes[k + n]);
        const float* row = &rows[quads * block.others[k + n]].x;
        for (size_t j = 0; j < parts; ++j)
          sums[n][j] = hn::Add(sums[n][j], hn::Mul(slope, hn::Load(Tag(), row + j * lanes)));
      }
    SingleVector sum[quads];
    for (size_t j = 0; j < parts; ++j)
      hn::StoreU(hn::Add(hn::Add(sums[0][j], sums[2][j]), hn::Add(sums[1][j], sums[3][j])), Tag(),
                 &sum[0].x + j * lanes);
    f(p, sum);
  }
}

/// A matrix by its columns, times the first three numbers of x.
HWY_INLINE Quad times(const Quad (&columns)[3], const Quad& x) {
  return (columns[0] * x.all<0>() + columns[1] * x.all<1>()) + columns[2] * x.all<2>();
}

HWY_INLINE void store_flow(const BlockOperands& of, size_t place, const Quad& force) {
  const Quad per_mass = Quad::load(of.gradients[place]).all<3>();
  (Quad::of(-1) * per_mass * force).store(of.flows[place].u);
}

void press_corrected(const BlockOperands& of, const FluidBlock& block, SingleVector* rows) {
  const BlockPoints points(of, block);
  each_row(block, of.matrices, [&](size_t r, size_t place) HWY_ATTR {
    const BlockMatrix& m = of.matrices[place];
    const Quad w = Quad::of(of.weights[place]);
    const Quad columns[3] = {w * Quad::load(m.correction[0]), w * Quad::load(m.correction[1]),
                             w * Quad::load(m.correction[2])};
    SingleVector* row = rows + 4 * r;
    for (size_t k = 0; k < 3; ++k) columns[k].store(row[k]);
    times(columns, points(m.at)).store(row[3]);
  });
  each_block_sum<4>(block, rows, [&](size_t p, const SingleVector* sum) HWY_ATTR {
    const size_t place = block.first + p;
    const Quad x = points(of.flows[place].at),
               own = Quad::of(of.weights[place]) * Quad::load(of.gradients[place]);
    const Quad columns[3] = {Quad::load(sum[0]), Quad::load(sum[1]), Quad::load(sum[2])};
    store_flow(of, place, own + (times(columns, x) - Quad::load(sum[3])));
  });
}

void press_plain(const BlockOperands& of, const FluidBlock& block, SingleVector* rows) {
  const BlockPoints points(of, block);
  each_row(block, of.flows, [&](size_t r, size_t place) HWY_ATTR {
    const Quad x = points(of.flows[place].at);
    (Quad::of(of.weights[place]) * x.with_fourth(1)).store(rows[r]);
  });
  each_block_sum<1>(block, rows, [&](size_t p, const SingleVector* sum) HWY_ATTR {
    const size_t place = block.first + p;
    const Quad x = points(of.flows[place].at), s = Quad::load(sum[0]),
               own = Quad::of(of.weights[place]) * Quad::load(of.gradients[place]);
    store_flow(of, place, own + (s.all<3>() * x - s));
  });
}

void open_corrected(const BlockOperands& of, const FluidBlock& block, float* rates,
                    SingleVector* rows) {
  const BlockPoints points(of, block);
  each_row(block, of.flows, [&](size_t r, size_t place) HWY_ATTR {
    const Quad x = points(of.flows[place].at), u = Quad::load(of.flows[place].u);
    SingleVector* row = rows + 4 * r;
    (u * x.all<0>()).store(row[0]);
    (u * x.all<1>()).store(row[1]);
    (u * x.all<2>()).store(row[2]);
    u.store(row[3]);
  });
  each_block_sum<4>(block, rows, [&](size_t p, const SingleVector* sum) HWY_ATTR {
    const size_t place = block.first + p;
    const Quad x = points(of.flows[place].at), u = Quad::load(sum[3]);
    const SingleVector* correction = of.matrices[place].correction;
    Quad products = Quad::load(of.flows[place].u) * Quad::load(of.gradients[place]);
    products = products + Quad::load(correction[0]) * (Quad::load(sum[0]) - u * x.all<0>());
    products = products + Quad::load(correction[1]) * (Quad::load(sum[1]) - u * x.all<1>());
    products = products + Quad::load(correction[2]) * (Quad::load(sum[2]) - u * x.all<2>());
    rates[p] = products.sum_of_three();
  });
}

void open_plain(const BlockOperands& of, const FluidBlock& block, float* rates,
                SingleVector* rows) {
  const BlockPoints points(of, block);
  each_row(block, of.flows, [&](size_t r, size_t place) HWY_ATTR {
    const Quad x = points(of.flows[place].at), u = Quad::load(of.flows[place].u);
    u.with_fourth((u * x).sum_of_three()).store(rows[r]);
  });
  each_block_sum<1>(block, rows, [&](size_t p, const SingleVector* sum) HWY_ATTR {
    const size_t place = block.first + p;
    const Quad x = points(of.flows[place].at);
    const Quad own = Quad::load(of.flows[place].u) * Quad::load(of.gradients[place]);
    rates[p] = sum[0].w + (own - Quad::load(sum[0]) * x).sum_of_three();
  });
}

void press_block_here(const BlockOperands& of, const FluidBlock& block, SingleVector* rows) {
  if (of.matrices)
    press_corrected(of, block, rows);
  else
    press_plain(of, block, rows);
}
void open_block_here(const BlockOperands& of, const FluidBlock& block, float* rates,
                     SingleVector* rows) {
  if (of.matrices)
    open_corrected(of, block, rates, rows);
  else
    open_plain(of, block, rates, rows);
}

}  // namespace tumble::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tumble {
HWY_EXPORT(press_block_here);
HWY_EXPORT(open_block_here);

namespace {
SingleVector* rows_in(BlockScratch& scratch, const FluidBlock& block) {
  constexpr size_t quads_of_row = 4, per_line = 4;
  const size_t room = quads_of_row * block.rows.size() + per_line;
  if (scratch.size() < room) scratch.resize(room);
  // A row of four vectors is one line of the cache.
  const auto address = reinterpret_cast<uintptr_t>(scratch.data());
  return scratch.data() + (per_line - address / sizeof(SingleVector) % per_line) % per_line;
}
}  // namespace

void press_block(const BlockOperands& of, const FluidBlock& block, BlockScratch& scratch) {
  HWY_DYNAMIC_DISPATCH(press_block_here)(of, block, rows_in(scratch, block));
}
void open_block(const BlockOperands& of, const FluidBlock& block, float* rates,
                BlockScratch& scratch) {
  HWY_DYNAMIC_DISPATCH(open_block_here)(of, block, rates, rows_in(scratch, block));
}
}  // namespace tumble
#endif
