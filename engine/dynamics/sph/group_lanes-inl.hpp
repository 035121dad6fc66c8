// The pairs of four particles with four neighbours side by side, for any width of vectors, so that
// sums have the same bits for all. Included once per target.
#if defined(TUMBLE_GROUP_LANES_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef TUMBLE_GROUP_LANES_INL
#undef TUMBLE_GROUP_LANES_INL
#else
#define TUMBLE_GROUP_LANES_INL
#endif

#include <cstddef>
#include <cstdint>
#include <cstring>

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace tumble::HWY_NAMESPACE {

#if HWY_TARGET <= HWY_AVX3
// Highway has no insertion of blocks but by halves, which takes twice as many instructions.
HWY_INLINE hwy::HWY_NAMESPACE::Vec512<float> four_blocks(hwy::HWY_NAMESPACE::Vec128<float> a,
                                                         hwy::HWY_NAMESPACE::Vec128<float> b,
                                                         hwy::HWY_NAMESPACE::Vec128<float> c,
                                                         hwy::HWY_NAMESPACE::Vec128<float> d) {
  __m512 v = _mm512_castps128_ps512(a.raw);
  v = _mm512_insertf32x4(v, b.raw, 1);
  v = _mm512_insertf32x4(v, c.raw, 2);
  return {_mm512_insertf32x4(v, d.raw, 3)};
}
HWY_INLINE hwy::HWY_NAMESPACE::Vec512<int32_t> four_blocks(hwy::HWY_NAMESPACE::Vec128<int32_t> a,
                                                           hwy::HWY_NAMESPACE::Vec128<int32_t> b,
                                                           hwy::HWY_NAMESPACE::Vec128<int32_t> c,
                                                           hwy::HWY_NAMESPACE::Vec128<int32_t> d) {
  __m512i v = _mm512_castsi128_si512(a.raw);
  v = _mm512_inserti32x4(v, b.raw, 1);
  v = _mm512_inserti32x4(v, c.raw, 2);
  return {_mm512_inserti32x4(v, d.raw, 3)};
}
#endif

/// Sixteen numbers: by neighbour, of each four particles.
template <class T>
struct Sixteen {
  using Tag = hwy::HWY_NAMESPACE::CappedTag<T, 16>;
  using Block = hwy::HWY_NAMESPACE::CappedTag<T, 4>;
  static constexpr size_t lanes = hwy::HWY_NAMESPACE::MaxLanes(Tag()), count = 16 / lanes;
  hwy::HWY_NAMESPACE::Vec<Tag> parts[count];

  static HWY_INLINE Sixteen of(T v) {
    Sixteen s;
    for (auto& part : s.parts) part = hwy::HWY_NAMESPACE::Set(Tag(), v);
    return s;
  }
  static HWY_INLINE Sixteen load(const T* from) {
    Sixteen s;
    for (size_t k = 0; k < count; ++k)
      s.parts[k] = hwy::HWY_NAMESPACE::LoadU(Tag(), from + k * lanes);
    return s;
  }
  HWY_INLINE void store(T* to) const {
    for (size_t k = 0; k < count; ++k) hwy::HWY_NAMESPACE::StoreU(parts[k], Tag(), to + k * lanes);
  }
#if HWY_TARGET == HWY_SCALAR
  static HWY_INLINE Sixteen of_particles(const T* four) {
    Sixteen s;
    for (size_t k = 0; k < count; ++k) s.parts[k] = hwy::HWY_NAMESPACE::Set(Tag(), four[k % 4]);
    return s;
  }
  static HWY_INLINE Sixteen rows(const T* from, size_t stride, const uint32_t* others) {
    Sixteen s;
    for (size_t k = 0; k < count; ++k) {
      T v;
      std::memcpy(&v, from + stride * others[k / 4] + k % 4, sizeof(T));
      s.parts[k] = hwy::HWY_NAMESPACE::Set(Tag(), v);
    }
    return s;
  }
  template <int k>
  HWY_INLINE Sixteen each() const {
    Sixteen s;
    for (size_t n = 0; n < count; ++n) s.parts[n] = parts[n / 4 * 4 + k];
    return s;
  }
  HWY_INLINE void total(T* four) const {
    T v[16];
    store(v);
    for (size_t n = 0; n < 4; ++n) four[n] = (v[n] + v[8 + n]) + (v[4 + n] + v[12 + n]);
  }
#else
  /// A number of each particle, the same for all neighbours.
  static HWY_INLINE Sixteen of_particles(const T* four) {
    Sixteen s;
    for (auto& part : s.parts) part = hwy::HWY_NAMESPACE::LoadDup128(Tag(), four);
    return s;
  }
  /// Four numbers of each neighbour, out of an array with `stride` numbers for each.
  static HWY_INLINE Sixteen rows(const T* from, size_t stride, const uint32_t* others) {
    namespace hn = hwy::HWY_NAMESPACE;
    const auto row = [&](size_t k)
                         HWY_ATTR { return hn::Load(Block(), from + stride * others[k]); };
    Sixteen s;
    if constexpr (lanes == 16) {
#if HWY_TARGET <= HWY_AVX3
      s.parts[0] = four_blocks(row(0), row(1), row(2), row(3));
#else
      const hn::Half<Tag> half;
      s.parts[0] =
          hn::Combine(Tag(), hn::Combine(half, row(3), row(2)), hn::Combine(half, row(1), row(0)));
#endif
    } else if constexpr (lanes == 8) {
      s.parts[0] = hn::Combine(Tag(), row(1), row(0));
      s.parts[1] = hn::Combine(Tag(), row(3), row(2));
    } else {
      for (size_t k = 0; k < 4; ++k) s.parts[k] = row(k);
    }
    return s;
  }
  /// Of rows: the number `k` of each neighbour, the same for all particles.
  template <int k>
  HWY_INLINE Sixteen each() const {
    Sixteen s;
    for (size_t n = 0; n < count; ++n) s.parts[n] = hwy::HWY_NAMESPACE::Broadcast<k>(parts[n]);
    return s;
  }
  /// The sum over neighbours, of each particle.
  HWY_INLINE void total(T* four) const {
    namespace hn = hwy::HWY_NAMESPACE;
    if constexpr (lanes == 16) {
      const hn::Half<Tag> half;
      const auto two = hn::Add(hn::LowerHalf(half, parts[0]), hn::UpperHalf(half, parts[0]));
      hn::StoreU(hn::Add(hn::LowerHalf(Block(), two), hn::UpperHalf(Block(), two)), Block(), four);
    } else if constexpr (lanes == 8) {
      const auto two = hn::Add(parts[0], parts[1]);
      hn::StoreU(hn::Add(hn::LowerHalf(Block(), two), hn::UpperHalf(Block(), two)), Block(), four);
    } else {
      hn::StoreU(hn::Add(hn::Add(parts[0], parts[2]), hn::Add(parts[1], parts[3])), Block(), four);
    }
  }
#endif
};
template <class T>
HWY_INLINE Sixteen<T> operator+(const Sixteen<T>& a, const Sixteen<T>& b) {
  Sixteen<T> s;
  for (size_t k = 0; k < s.count; ++k) s.parts[k] = hwy::HWY_NAMESPACE::Add(a.parts[k], b.parts[k]);
  return s;
}
template <class T>
HWY_INLINE Sixteen<T> operator-(const Sixteen<T>& a, const Sixteen<T>& b) {
  Sixteen<T> s;
  for (size_t k = 0; k < s.count; ++k) s.parts[k] = hwy::HWY_NAMESPACE::Sub(a.parts[k], b.parts[k]);
  return s;
}
template <class T>
HWY_INLINE Sixteen<T> operator*(const Sixteen<T>& a, const Sixteen<T>& b) {
  Sixteen<T> s;
  for (size_t k = 0; k < s.count; ++k) s.parts[k] = hwy::HWY_NAMESPACE::Mul(a.parts[k], b.parts[k]);
  return s;
}
using SixteenSingle = Sixteen<float>;
using SixteenWhole = Sixteen<int32_t>;

HWY_INLINE SixteenSingle to_single(const SixteenWhole& from) {
  SixteenSingle s;
  for (size_t k = 0; k < s.count; ++k)
    s.parts[k] = hwy::HWY_NAMESPACE::ConvertTo(SixteenSingle::Tag(), from.parts[k]);
  return s;
}
HWY_INLINE SixteenSingle load_rounded(const int16_t* from) {
  namespace hn = hwy::HWY_NAMESPACE;
  const hn::Rebind<int16_t, SixteenSingle::Tag> shorts;
  SixteenWhole s;
  for (size_t k = 0; k < s.count; ++k)
    s.parts[k] =
        hn::PromoteTo(SixteenWhole::Tag(), hn::LoadU(shorts, from + k * SixteenWhole::lanes));
  return to_single(s);
}
/// Rounded to the nearest whole numbers.
HWY_INLINE void store_rounded(const SixteenSingle& s, int16_t* to) {
  namespace hn = hwy::HWY_NAMESPACE;
  const hn::Rebind<int16_t, SixteenSingle::Tag> shorts;
  for (size_t k = 0; k < s.count; ++k)
    hn::StoreU(hn::DemoteTo(shorts, hn::NearestInt(s.parts[k])), shorts,
               to + k * SixteenSingle::lanes);
}

/// Four numbers in double, of the particles of a group.
struct GroupFour {
  using Tag = hwy::HWY_NAMESPACE::CappedTag<double, 4>;
  using Single = hwy::HWY_NAMESPACE::Rebind<float, Tag>;
  static constexpr size_t lanes = hwy::HWY_NAMESPACE::MaxLanes(Tag()), count = 4 / lanes;
  hwy::HWY_NAMESPACE::Vec<Tag> parts[count];

  static HWY_INLINE GroupFour of(double v) {
    GroupFour f;
    for (auto& part : f.parts) part = hwy::HWY_NAMESPACE::Set(Tag(), v);
    return f;
  }
  static HWY_INLINE GroupFour load(const double* from) {
    GroupFour f;
    for (size_t k = 0; k < count; ++k)
      f.parts[k] = hwy::HWY_NAMESPACE::LoadU(Tag(), from + k * lanes);
    return f;
  }
  static HWY_INLINE GroupFour load(const float* from) {
    namespace hn = hwy::HWY_NAMESPACE;
    GroupFour f;
    for (size_t k = 0; k < count; ++k)
      f.parts[k] = hn::PromoteTo(Tag(), hn::LoadU(Single(), from + k * lanes));
    return f;
  }
  HWY_INLINE void store(double* to) const {
    for (size_t k = 0; k < count; ++k) hwy::HWY_NAMESPACE::StoreU(parts[k], Tag(), to + k * lanes);
  }
  HWY_INLINE void store_single(float* to) const {
    namespace hn = hwy::HWY_NAMESPACE;
    for (size_t k = 0; k < count; ++k)
      hn::StoreU(hn::DemoteTo(Single(), parts[k]), Single(), to + k * lanes);
  }
};
HWY_INLINE GroupFour operator+(const GroupFour& a, const GroupFour& b) {
  GroupFour f;
  for (size_t k = 0; k < f.count; ++k) f.parts[k] = hwy::HWY_NAMESPACE::Add(a.parts[k], b.parts[k]);
  return f;
}
HWY_INLINE GroupFour operator-(const GroupFour& a, const GroupFour& b) {
  GroupFour f;
  for (size_t k = 0; k < f.count; ++k) f.parts[k] = hwy::HWY_NAMESPACE::Sub(a.parts[k], b.parts[k]);
  return f;
}
HWY_INLINE GroupFour operator*(const GroupFour& a, const GroupFour& b) {
  GroupFour f;
  for (size_t k = 0; k < f.count; ++k) f.parts[k] = hwy::HWY_NAMESPACE::Mul(a.parts[k], b.parts[k]);
  return f;
}

}  // namespace tumble::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
