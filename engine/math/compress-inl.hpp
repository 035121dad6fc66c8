// Lanes of 32 bits that a mask keeps, moved to the front. Included once per target.
#if defined(TUMBLE_COMPRESS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef TUMBLE_COMPRESS_INL
#undef TUMBLE_COMPRESS_INL
#else
#define TUMBLE_COMPRESS_INL
#endif

#include "engine/math/compress_table.hpp"

#include <bit>
#include <cstddef>

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace tumble::HWY_NAMESPACE {

/// The operation of hn::Compress, for several vectors with one mask. On processors without such an
/// instruction, Highway's implementation has a local index table, which GCC copies onto the stack
/// in each call.
template <class D>
class Compressor {
 public:
  using Mask = hwy::HWY_NAMESPACE::Mask<D>;
  static constexpr bool native = HWY_TARGET <= HWY_AVX3;

  explicit HWY_INLINE Compressor(Mask keep) : keep_(keep) {
    uint8_t bits[8] = {};
    hwy::HWY_NAMESPACE::StoreMaskBits(D(), keep, bits);
    bits_ = bits[0] | unsigned(bits[1]) << 8;
  }
  /// The lanes that are kept, in their order, followed by the others.
  template <class V>
  HWY_INLINE V operator()(V v) const {
    namespace hn = hwy::HWY_NAMESPACE;
    const hn::DFromV<V> d;
    if constexpr (native) {
      return hn::Compress(v, hn::RebindMask(d, keep_));
    } else {
      static_assert(sizeof(hn::TFromD<D>) == 4 && hn::MaxLanes(D()) <= compress_lanes);
      const hn::Rebind<uint8_t, decltype(d)> bytes;
      const hn::RebindToSigned<decltype(d)> indices;
      const auto row = hn::LoadU(bytes, compress_table[bits_].data());
      return hn::TableLookupLanes(v, hn::IndicesFromVec(d, hn::PromoteTo(indices, row)));
    }
  }
  /// Number of lanes that are kept.
  HWY_INLINE size_t count() const { return size_t(std::popcount(bits_)); }

 private:
  Mask keep_;
  unsigned bits_ = 0;
};

}  // namespace tumble::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
