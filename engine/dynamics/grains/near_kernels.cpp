// Finds grains near a cell, and near a grain, a vector of them at a time.
#include "engine/dynamics/grains/near_kernels.hpp"

#include "engine/dynamics/grains/tolerances.hpp"
#include "engine/dynamics/particles/tolerances.hpp"

// Compiles this file once per instruction set, with the includes that each time needs.
// clang-format off
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "engine/dynamics/grains/near_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "engine/math/compress-inl.hpp"
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace tumble::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Coordinates relative to `centre`, of as many grains as there are lanes.
template <class D>
HWY_INLINE hn::Vec<D> relative(D lanes, const double* from, double centre) {
#if HWY_TARGET == HWY_SCALAR
  return hn::Set(lanes, float(*from - centre));
#else
  const hn::Half<D> half;
  const hn::Rebind<double, decltype(half)> wide;
  const auto middle = hn::Set(wide, centre);
  const auto lower = hn::DemoteTo(half, hn::Sub(hn::LoadU(wide, from), middle));
  const auto upper = hn::DemoteTo(half, hn::Sub(hn::LoadU(wide, from + hn::Lanes(half)), middle));
  return hn::Combine(lanes, upper, lower);
#endif
}

size_t AddNearCell(const GrainColumns& from, uint32_t begin, uint32_t end, const double* centre,
                   float half, const GrainsNearCell& to, size_t size) {
  const hn::CappedTag<float, grain_batch> lanes;
  const hn::Rebind<uint32_t, decltype(lanes)> places;
  const hn::Rebind<int32_t, decltype(lanes)> ordinals;
  const auto most = hn::Set(lanes, half);
  for (size_t k = begin; k < end; k += hn::Lanes(lanes)) {
    const auto x = relative(lanes, from.x + k, centre[0]);
    const auto y = relative(lanes, from.y + k, centre[1]);
    const auto z = relative(lanes, from.z + k, centre[2]);
    const auto farthest = hn::Max(hn::Max(hn::Abs(x), hn::Abs(y)), hn::Abs(z));
    const auto near = hn::And(hn::Le(farthest, most), hn::FirstN(lanes, end - k));
    if (hn::AllFalse(lanes, near)) continue;
    // Writes full vectors: on some processors partial writes are very slow.
    const Compressor<decltype(lanes)> compress(near);
    hn::StoreU(compress(x), lanes, to.x + size);
    hn::StoreU(compress(y), lanes, to.y + size);
    hn::StoreU(compress(z), lanes, to.z + size);
    const auto copy = [&](const float* column, float* kept) HWY_ATTR {
      hn::StoreU(compress(hn::LoadU(lanes, column + k)), lanes, kept + size);
    };
    copy(from.extent, to.extent);
    copy(from.radius, to.radius);
    copy(from.way_x, to.way_x);
    copy(from.way_y, to.way_y);
    copy(from.way_z, to.way_z);
    hn::StoreU(compress(hn::LoadU(places, from.place + k)), places, to.place + size);
    hn::StoreU(compress(hn::LoadU(ordinals, from.ordinal + k)), ordinals, to.ordinal + size);
    size += compress.count();
  }
  return size;
}

size_t FindNear(const GrainsNearCell& among, size_t padded, const NearGrain& grain, uint32_t* out) {
  const hn::CappedTag<float, grain_batch> lanes;
  const hn::Rebind<uint32_t, decltype(lanes)> places;
  const hn::Rebind<int32_t, decltype(lanes)> ordinals;
  const auto x = hn::Set(lanes, grain.x), y = hn::Set(lanes, grain.y), z = hn::Set(lanes, grain.z),
             extent = hn::Set(lanes, grain.extent);
  const auto way_x = hn::Set(lanes, grain.way_x), way_y = hn::Set(lanes, grain.way_y),
             way_z = hn::Set(lanes, grain.way_z), radius = hn::Set(lanes, grain.radius);
  const auto touches = hn::Set(lanes, grain.radius + grain.more);
  const auto margin = hn::Set(lanes, float(tolerances::grain_margin)), zero = hn::Zero(lanes);
  const auto foresight = hn::Set(lanes, float(tolerances::grain_foresight));
  const auto rounding = hn::Set(lanes, float(tolerances::neighbour_rounding));
  const auto after = hn::Set(ordinals, grain.after);
  size_t found = 0;
  for (size_t k = 0; k < padded; k += hn::Lanes(lanes)) {
    const auto dx = hn::Sub(hn::LoadU(lanes, among.x + k), x);
    const auto dy = hn::Sub(hn::LoadU(lanes, among.y + k), y);
    const auto dz = hn::Sub(hn::LoadU(lanes, among.z + k), z);
    const auto most = hn::Add(hn::LoadU(lanes, among.extent + k), extent);
    const auto square = hn::Add(hn::Add(hn::Mul(dx, dx), hn::Mul(dy, dy)), hn::Mul(dz, dz));
    const auto later = hn::Gt(hn::LoadU(ordinals, among.ordinal + k), after);
    // Most grains are farther away than any motion could bring them.
    const auto coarse = hn::And(hn::RebindMask(places, hn::Le(square, hn::Mul(most, most))),
                                hn::RebindMask(places, later));
    if (hn::AllFalse(places, coarse)) continue;
    const auto wx = hn::Sub(hn::LoadU(lanes, among.way_x + k), way_x);
    const auto wy = hn::Sub(hn::LoadU(lanes, among.way_y + k), way_y);
    const auto wz = hn::Sub(hn::LoadU(lanes, among.way_z + k), way_z);
    const auto way = hn::Sqrt(hn::Add(hn::Add(hn::Mul(wx, wx), hn::Mul(wy, wy)), hn::Mul(wz, wz)));
    const auto r = hn::LoadU(lanes, among.radius + k);
    const auto least = hn::Min(r, radius);
    const auto reach =
        hn::Add(hn::Add(r, touches),
                hn::Add(hn::Mul(margin, least), hn::Min(hn::Mul(foresight, least), way)));
    const auto rounded = hn::Mul(rounding, most);
    const auto farthest = hn::Add(reach, rounded), sure = hn::Max(hn::Sub(reach, rounded), zero);
    const auto near =
        hn::And(coarse, hn::RebindMask(places, hn::Le(square, hn::Mul(farthest, farthest))));
    if (hn::AllFalse(places, near)) continue;
    const auto doubtful = hn::RebindMask(places, hn::Gt(square, hn::Mul(sure, sure)));
    const auto index = hn::Or(hn::Iota(places, uint32_t(k)),
                              hn::IfThenElseZero(doubtful, hn::Set(places, doubtful_grain)));
    const Compressor<decltype(places)> compress(near);
    hn::StoreU(compress(index), places, out + found);
    found += compress.count();
  }
  return found;
}

}  // namespace tumble::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tumble {

HWY_EXPORT(AddNearCell);
HWY_EXPORT(FindNear);

size_t add_near_cell(const GrainColumns& from, uint32_t begin, uint32_t end, const double* centre,
                     float half, const GrainsNearCell& to, size_t size) {
  return HWY_DYNAMIC_DISPATCH(AddNearCell)(from, begin, end, centre, half, to, size);
}
size_t find_near(const GrainsNearCell& among, size_t padded, const NearGrain& grain,
                 uint32_t* out) {
  return HWY_DYNAMIC_DISPATCH(FindNear)(among, padded, grain, out);
}

}  // namespace tumble
#endif
