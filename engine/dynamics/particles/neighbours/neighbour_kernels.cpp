// Finds the points of nearby cells within reach, eight at a time.
#include "engine/dynamics/particles/neighbours/neighbour_kernels.hpp"

// Compiles this file once per instruction set, with the includes that each time needs.
// clang-format off
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "engine/dynamics/particles/neighbours/neighbour_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "engine/math/compress-inl.hpp"
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace tumble::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

size_t gather_near_here(const NeighbourCandidates& c, const float* point, float reach2,
                        uint32_t self, uint32_t* out) {
  const hn::CappedTag<float, 8> lanes;
  const hn::Rebind<uint32_t, decltype(lanes)> places;
  const auto x = hn::Set(lanes, point[0]), y = hn::Set(lanes, point[1]),
             z = hn::Set(lanes, point[2]), most = hn::Set(lanes, reach2);
  const auto own = hn::Set(places, self);
  size_t found = 0;
  for (size_t k = 0; k < c.padded; k += hn::Lanes(lanes)) {
    const auto dx = hn::Sub(hn::LoadU(lanes, c.x + k), x);
    const auto dy = hn::Sub(hn::LoadU(lanes, c.y + k), y);
    const auto dz = hn::Sub(hn::LoadU(lanes, c.z + k), z);
    const auto square = hn::Add(hn::Add(hn::Mul(dx, dx), hn::Mul(dy, dy)), hn::Mul(dz, dz));
    const auto place = hn::LoadU(places, c.place + k);
    const auto near = hn::And(hn::RebindMask(places, hn::Le(square, most)), hn::Ne(place, own));
    // Writes full vectors: on some processors partial writes are very slow.
    const Compressor<decltype(places)> compress(near);
    hn::StoreU(compress(place), places, out + found);
    found += compress.count();
  }
  return found;
}

size_t gather_four_here(const NeighbourCandidates& c, const float (&points)[3][4], float reach2,
                        uint32_t* out) {
  const hn::CappedTag<float, 8> lanes;
  const hn::Rebind<uint32_t, decltype(lanes)> places;
  const auto most = hn::Set(lanes, reach2);
  size_t found = 0;
  for (size_t k = 0; k < c.padded; k += hn::Lanes(lanes)) {
    const auto x = hn::LoadU(lanes, c.x + k), y = hn::LoadU(lanes, c.y + k),
               z = hn::LoadU(lanes, c.z + k);
    const auto square = [&](size_t n) HWY_ATTR {
      const auto dx = hn::Sub(x, hn::Set(lanes, points[0][n])),
                 dy = hn::Sub(y, hn::Set(lanes, points[1][n])),
                 dz = hn::Sub(z, hn::Set(lanes, points[2][n]));
      return hn::Add(hn::Add(hn::Mul(dx, dx), hn::Mul(dy, dy)), hn::Mul(dz, dz));
    };
    const auto least = hn::Min(hn::Min(square(0), square(1)), hn::Min(square(2), square(3)));
    const Compressor<decltype(places)> compress(hn::RebindMask(places, hn::Le(least, most)));
    hn::StoreU(compress(hn::LoadU(places, c.place + k)), places, out + found);
    found += compress.count();
  }
  return found;
}

}  // namespace tumble::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tumble {
HWY_EXPORT(gather_near_here);
HWY_EXPORT(gather_four_here);
size_t gather_near(const NeighbourCandidates& candidates, const float* point, float reach2,
                   uint32_t self, uint32_t* out) {
  return HWY_DYNAMIC_DISPATCH(gather_near_here)(candidates, point, reach2, self, out);
}
size_t gather_near_four(const NeighbourCandidates& candidates, const float (&points)[3][4],
                        float reach2, uint32_t* out) {
  return HWY_DYNAMIC_DISPATCH(gather_four_here)(candidates, points, reach2, out);
}
}  // namespace tumble
#endif
