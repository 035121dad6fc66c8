// Four particles with four neighbours are one vector of sixteen numbers: what is read of a
// neighbour serves four particles, and no sum is taken across a vector but at the end of a list.
#include "engine/dynamics/sph/pressure_sums.hpp"

// This file once per instruction set, then what each time needs.
// clang-format off
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "engine/dynamics/sph/pressure_sums.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "engine/dynamics/sph/group_lanes-inl.hpp"
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace tumble::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Numbers in a row.
template <class Row>
constexpr size_t row_stride = sizeof(Row) / sizeof(float);

HWY_INLINE SixteenSingle as_single(const SixteenWhole& from) {
  SixteenSingle s;
  for (size_t k = 0; k < s.count; ++k)
    s.parts[k] = hn::BitCast(SixteenSingle::Tag(), from.parts[k]);
  return s;
}
/// Differences of 16 bits each.
HWY_INLINE SixteenWhole apart(const SixteenWhole& a, const SixteenWhole& b) {
  const SixteenWhole::Tag tag;
  SixteenWhole s;
  for (size_t k = 0; k < s.count; ++k) {
#if HWY_TARGET == HWY_SCALAR
    const auto from = uint32_t(hn::GetLane(b.parts[k])), to = uint32_t(hn::GetLane(a.parts[k]));
    const uint32_t upper = ((to >> 16) - (from >> 16)) << 16, lower = (to - from) & UINT16_MAX;
    s.parts[k] = hn::Set(tag, int32_t(upper | lower));
#else
    const hn::Repartition<int16_t, SixteenWhole::Tag> shorts;
    s.parts[k] =
        hn::BitCast(tag, hn::Sub(hn::BitCast(shorts, a.parts[k]), hn::BitCast(shorts, b.parts[k])));
#endif
  }
  return s;
}
HWY_INLINE SixteenSingle lower(SixteenWhole s) {
  for (auto& part : s.parts) part = hn::ShiftRight<16>(hn::ShiftLeft<16>(part));
  return to_single(s);
}
HWY_INLINE SixteenSingle upper(SixteenWhole s) {
  for (auto& part : s.parts) part = hn::ShiftRight<16>(part);
  return to_single(s);
}

/// Ways to the particles of a group.
template <class Row>
class GroupWays {
 public:
  HWY_INLINE GroupWays(const FluidGroup& group, const Row* rows) {
    HWY_ALIGN int32_t xy[FluidGroup::size], z[FluidGroup::size];
    for (size_t n = 0; n < FluidGroup::size; ++n) {
      const FluidPlace& at = rows[group.place(n)].at;
      xy[n] = at.xy, z[n] = at.z;
    }
    xy_ = SixteenWhole::of_particles(xy), z_ = SixteenWhole::of_particles(z);
  }
  /// From four neighbours, by the first numbers of their rows.
  HWY_INLINE void find(const SixteenWhole& others, SixteenSingle (&ways)[3]) const {
    const SixteenWhole xy = apart(xy_, others.each<0>()), z = apart(z_, others.each<1>());
    ways[0] = lower(xy), ways[1] = upper(xy), ways[2] = upper(z);
  }

 private:
  SixteenWhole xy_, z_;
};

/// Symmetric matrices, of the particles or of the neighbours.
struct SixteenMatrices {
  SixteenSingle xx, yy, zz, yz, zx, xy;

  static HWY_INLINE SixteenMatrices of_particles(const FluidGroup& group,
                                                 const SymmetricRow<float>* from) {
    HWY_ALIGN float own[6][FluidGroup::size];
    for (size_t n = 0; n < FluidGroup::size; ++n) {
      const SymmetricRow<float>& m = from[group.place(n)];
      own[0][n] = m.xx, own[1][n] = m.yy, own[2][n] = m.zz;
      own[3][n] = m.yz, own[4][n] = m.zx, own[5][n] = m.xy;
    }
    const auto all = [&](size_t k) HWY_ATTR { return SixteenSingle::of_particles(own[k]); };
    return {all(0), all(1), all(2), all(3), all(4), all(5)};
  }
  HWY_INLINE void times(const SixteenSingle (&v)[3], SixteenSingle (&out)[3]) const {
    out[0] = (xx * v[0] + xy * v[1]) + zx * v[2];
    out[1] = (xy * v[0] + yy * v[1]) + yz * v[2];
    out[2] = (zx * v[0] + yz * v[1]) + zz * v[2];
  }
};

float sum_unit(const FluidPairs& pairs) {
  return float(pairs.rounded_unit() / double(1 << FluidPlace::bits));
}

template <bool corrected>
void open_here(const FluidPairs& pairs, size_t first, size_t end, const FlowRow* rows,
               const SymmetricRow<float>* corrections, float* sums) {
  const float unit = sum_unit(pairs);
  for (size_t g = first; g < end; ++g) {
    const FluidGroup group = pairs.group(g);
    const GroupWays<FlowRow> from(group, rows);
    SixteenMatrices matrices;
    if constexpr (corrected) matrices = SixteenMatrices::of_particles(group, corrections);
    SixteenSingle all = SixteenSingle::of(0);
    for (size_t k = 0; k < group.padded; k += 4) {
      const uint32_t* others = group.others + k;
      for (size_t n = 0; n < 4; ++n) FluidGroup::fetch(rows, others + n);
      const SixteenSingle flows = SixteenSingle::rows(&rows->flow.x, row_stride<FlowRow>, others);
      SixteenSingle ways[3], gradients[3];
      from.find(SixteenWhole::rows(&rows->at.xy, row_stride<FlowRow>, others), ways);
      if constexpr (corrected)
        matrices.times(ways, gradients);
      else
        for (size_t c = 0; c < 3; ++c) gradients[c] = ways[c];
      all = all + load_rounded(group.rounded + 4 * k) *
                      ((gradients[0] * flows.each<0>() + gradients[1] * flows.each<1>()) +
                       gradients[2] * flows.each<2>());
    }
    float found[4];
    all.total(found);
    for (size_t n = 0; n < group.count; ++n) *sums++ = unit * found[n];
  }
}

HWY_INLINE void write_vectors(const SixteenSingle (&from)[3], float unit, size_t count,
                              SingleVector* to) {
  float v[3][4];
  for (size_t c = 0; c < 3; ++c) from[c].total(v[c]);
  for (size_t n = 0; n < count; ++n) to[n] = {unit * v[0][n], unit * v[1][n], unit * v[2][n], 0};
}

void push_here(const FluidPairs& pairs, size_t first, size_t end, const PushRow* rows,
               SingleVector* sums) {
  for (size_t g = first; g < end; ++g) {
    const FluidGroup group = pairs.group(g);
    const GroupWays<PushRow> from(group, rows);
    SixteenSingle all[3] = {SixteenSingle::of(0), SixteenSingle::of(0), SixteenSingle::of(0)};
    for (size_t k = 0; k < group.padded; k += 4) {
      const SixteenWhole others =
          SixteenWhole::rows(&rows->at.xy, row_stride<PushRow>, group.others + k);
      SixteenSingle ways[3];
      from.find(others, ways);
      const SixteenSingle f = load_rounded(group.rounded + 4 * k) * as_single(others.each<2>());
      for (size_t c = 0; c < 3; ++c) all[c] = all[c] + f * ways[c];
    }
    write_vectors(all, sum_unit(pairs), group.count, sums);
    sums += group.count;
  }
}

void stress_here(const FluidPairs& pairs, size_t first, size_t end, const StressRow* rows,
                 SingleVector* sums) {
  for (size_t g = first; g < end; ++g) {
    const FluidGroup group = pairs.group(g);
    const GroupWays<StressRow> from(group, rows);
    SixteenSingle all[3] = {SixteenSingle::of(0), SixteenSingle::of(0), SixteenSingle::of(0)};
    for (size_t k = 0; k < group.padded; k += 4) {
      const uint32_t* others = group.others + k;
      for (size_t n = 0; n < 4; ++n) FluidGroup::fetch(rows, others + n);
      const SixteenWhole front = SixteenWhole::rows(&rows->at.xy, row_stride<StressRow>, others);
      const SixteenSingle back = SixteenSingle::rows(&rows->zz, row_stride<StressRow>, others);
      SixteenSingle ways[3], pushes[3];
      from.find(front, ways);
      const SixteenSingle f = load_rounded(group.rounded + 4 * k);
      for (size_t c = 0; c < 3; ++c) ways[c] = f * ways[c];
      const SixteenMatrices stresses{as_single(front.each<2>()),
                                     as_single(front.each<3>()),
                                     back.each<0>(),
                                     back.each<1>(),
                                     back.each<2>(),
                                     back.each<3>()};
      stresses.times(ways, pushes);
      for (size_t c = 0; c < 3; ++c) all[c] = all[c] + pushes[c];
    }
    write_vectors(all, sum_unit(pairs), group.count, sums);
    sums += group.count;
  }
}

void open_plain_here(const FluidPairs& pairs, size_t first, size_t end, const FlowRow* rows,
                     float* sums) {
  open_here<false>(pairs, first, end, rows, nullptr, sums);
}
void open_corrected_here(const FluidPairs& pairs, size_t first, size_t end, const FlowRow* rows,
                         const SymmetricRow<float>* corrections, float* sums) {
  open_here<true>(pairs, first, end, rows, corrections, sums);
}

}  // namespace tumble::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tumble {
HWY_EXPORT(open_plain_here);
HWY_EXPORT(open_corrected_here);
HWY_EXPORT(push_here);
HWY_EXPORT(stress_here);

FluidPlace FluidPlace::of(const Vec3& x) {
  // Whole reaches, and what is left of one.
  const auto part = [](double v) {
    const auto whole = int64_t(v);
    const double rest = (v - double(whole)) * double(1 << bits);
    return uint32_t(
        ((uint64_t(whole) << bits) + uint64_t(int64_t(rest + (rest < 0 ? -0.5 : 0.5)))) &
        UINT16_MAX);
  };
  return {int32_t(part(x[0]) | part(x[1]) << 16), int32_t(part(x[2]) << 16)};
}

void open_groups(const FluidPairs& pairs, size_t first, size_t end, const FlowRow* rows,
                 const SymmetricRow<float>* corrections, float* sums) {
  if (corrections)
    HWY_DYNAMIC_DISPATCH(open_corrected_here)(pairs, first, end, rows, corrections, sums);
  else
    HWY_DYNAMIC_DISPATCH(open_plain_here)(pairs, first, end, rows, sums);
}
void push_groups(const FluidPairs& pairs, size_t first, size_t end, const PushRow* rows,
                 SingleVector* sums) {
  HWY_DYNAMIC_DISPATCH(push_here)(pairs, first, end, rows, sums);
}
void push_groups(const FluidPairs& pairs, size_t first, size_t end, const StressRow* rows,
                 SingleVector* sums) {
  HWY_DYNAMIC_DISPATCH(stress_here)(pairs, first, end, rows, sums);
}
}  // namespace tumble
#endif
