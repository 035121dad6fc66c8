// Sums over the pairs of one point, eight at a time.
#include "engine/dynamics/forces/pair/pair_kernels.hpp"

// This file once per instruction set, then what each time needs.
// clang-format off
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "engine/dynamics/forces/pair/pair_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace tumble::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Doubles = hn::CappedTag<double, 8>;
using Double = hn::Vec<Doubles>;
constexpr size_t batch = 8;

HWY_INLINE Double all(double v) {
  return hn::Set(Doubles(), v);
}

struct PairLanes {
  Double energy, push;
};

/// The laws that are arithmetic alone; the others go lane by lane.
struct LennardJonesLanes {
  Double length2, strength4, strength24;
  explicit LennardJonesLanes(const PairLaw& law)
      : length2(all(law.length * law.length)),
        strength4(all(4 * law.strength)),
        strength24(all(24 * law.strength)) {}
  HWY_INLINE PairLanes operator()(Double r2) const {
    const Double inverse = hn::Div(all(1), r2);
    const Double s2 = hn::Mul(length2, inverse);
    const Double s6 = hn::Mul(hn::Mul(s2, s2), s2), s12 = hn::Mul(s6, s6);
    return {hn::Mul(strength4, hn::Sub(s12, s6)),
            hn::Mul(hn::Mul(strength24, hn::Sub(hn::Add(s12, s12), s6)), inverse)};
  }
};

struct InverseDistanceLanes {
  Double length2, strength;
  explicit InverseDistanceLanes(const PairLaw& law)
      : length2(all(law.length * law.length)), strength(all(law.strength)) {}
  HWY_INLINE PairLanes operator()(Double r2) const {
    const Double d2 = hn::Add(r2, length2), energy = hn::Div(strength, hn::Sqrt(d2));
    return {energy, hn::Div(energy, d2)};
  }
};

struct ScalarLanes {
  const PairLaw& law;
  explicit ScalarLanes(const PairLaw& l) : law(l) {}
  HWY_INLINE PairLanes operator()(Double r2) const {
    const Doubles d;
    HWY_ALIGN double square[batch], energy[batch], push[batch];
    hn::Store(r2, d, square);
    for (size_t k = 0; k < hn::Lanes(d); ++k) {
      const bool inside = square[k] > 0 && square[k] <= law.cutoff * law.cutoff;
      const PairLaw::Value v = inside ? law.endless(square[k]) : PairLaw::Value{};
      energy[k] = v.energy, push[k] = v.push;
    }
    return {hn::Load(d, energy), hn::Load(d, push)};
  }
};

/// A law with its end.
template <class Law>
struct EndedLanes {
  Law law;
  Double cutoff2, shift, smooth_from, width;
  bool smooth;
  explicit EndedLanes(const PairLaw& l)
      : law(l),
        cutoff2(all(l.cutoff * l.cutoff)),
        shift(all(l.ends() && l.truncation == Truncation::shifted
                      ? l.endless(l.cutoff * l.cutoff).energy
                      : 0)),
        smooth_from(all(l.smooth_from)),
        width(all(l.ends() ? l.cutoff - l.smooth_from : 1)),
        smooth(l.ends() && l.truncation == Truncation::smoothed) {}
  HWY_INLINE PairLanes operator()(Double r2) const {
    PairLanes v = law(r2);
    if (smooth) {
      const Double r = hn::Sqrt(r2);
      const Double s = hn::Div(hn::Max(all(0), hn::Sub(r, smooth_from)), width);
      const Double rest = hn::Sub(all(1), s), s2 = hn::Mul(s, s);
      const Double keep = hn::Sub(
          all(1), hn::Mul(hn::Mul(s2, s),
                          hn::Sub(all(10), hn::Mul(s, hn::Sub(all(15), hn::Mul(all(6), s))))));
      const Double slope = hn::Div(hn::Mul(hn::Mul(all(-30), s2), hn::Mul(rest, rest)), width);
      v.push = hn::Sub(hn::Mul(v.push, keep), hn::Div(hn::Mul(v.energy, slope), r));
      v.energy = hn::Mul(v.energy, keep);
    } else {
      v.energy = hn::Sub(v.energy, shift);
    }
    return v;
  }
};

/// The sums of the lanes that the eight of a batch are divided into.
struct LaneSums {
  static constexpr size_t parts = batch / hn::MaxLanes(Doubles());
  Double fx[parts], fy[parts], fz[parts], energy[parts], virial[parts];

  LaneSums() {
    for (size_t k = 0; k < parts; ++k) fx[k] = fy[k] = fz[k] = energy[k] = virial[k] = all(0);
  }
  template <class Mask>
  HWY_INLINE void add(size_t k, const PairLanes& v, Double dx, Double dy, Double dz, Double r2,
                      Double weight, Mask counts) {
    // What does not count may be no number.
    const Double push = hn::IfThenElseZero(counts, hn::Mul(weight, v.push));
    fx[k] = hn::Sub(fx[k], hn::Mul(push, dx));
    fy[k] = hn::Sub(fy[k], hn::Mul(push, dy));
    fz[k] = hn::Sub(fz[k], hn::Mul(push, dz));
    energy[k] = hn::Add(energy[k], hn::IfThenElseZero(counts, hn::Mul(weight, v.energy)));
    virial[k] = hn::Add(virial[k], hn::IfThenElseZero(counts, hn::Mul(push, r2)));
  }
  static double total(const Double* lanes) {
    const Doubles d;
    HWY_ALIGN double v[batch];
    for (size_t k = 0; k < parts; ++k) hn::Store(lanes[k], d, v + k * hn::Lanes(d));
    return ((v[0] + v[4]) + (v[2] + v[6])) + ((v[1] + v[5]) + (v[3] + v[7]));
  }
  PairSum totals(double weight) const {
    return {weight * total(fx), weight * total(fy), weight * total(fz), weight * total(energy),
            weight * total(virial)};
  }
};

template <class Law>
PairSum over_list(const PairLaw& law, const PairPoints& p, size_t place,
                  std::span<const uint32_t> list) {
  const Doubles d;
  const hn::Rebind<int32_t, Doubles> narrow;  // places are far below 2^31
  const hn::RebindToSigned<Doubles> index;
  const EndedLanes<Law> value(law);
  const Double x = all(p.x[place]), y = all(p.y[place]), z = all(p.z[place]);
  LaneSums sums;
  for (size_t k = 0; k < list.size(); k += batch)
    for (size_t part = 0; part < LaneSums::parts; ++part) {
      const auto at =
          hn::PromoteTo(index, hn::LoadU(narrow, reinterpret_cast<const int32_t*>(list.data()) + k +
                                                     part * hn::Lanes(d)));
      const Double dx = hn::Sub(hn::GatherIndex(d, p.x, at), x);
      const Double dy = hn::Sub(hn::GatherIndex(d, p.y, at), y);
      const Double dz = hn::Sub(hn::GatherIndex(d, p.z, at), z);
      const Double r2 = hn::Add(hn::Add(hn::Mul(dx, dx), hn::Mul(dy, dy)), hn::Mul(dz, dz));
      const auto inside = hn::Le(r2, value.cutoff2);
      if (hn::AllFalse(d, inside)) continue;
      sums.add(part, value(r2), dx, dy, dz, r2, hn::GatherIndex(d, p.weight, at), inside);
    }
  return sums.totals(p.weight[place]);
}

template <class Law>
PairSum over_all(const PairLaw& law, const PairPoints& p, size_t place, size_t count) {
  const Doubles d;
  const EndedLanes<Law> value(law);
  const Double x = all(p.x[place]), y = all(p.y[place]), z = all(p.z[place]);
  LaneSums sums;
  for (size_t k = 0; k < count; k += batch)
    for (size_t part = 0; part < LaneSums::parts; ++part) {
      const size_t at = k + part * hn::Lanes(d);
      const Double dx = hn::Sub(hn::LoadU(d, p.x + at), x);
      const Double dy = hn::Sub(hn::LoadU(d, p.y + at), y);
      const Double dz = hn::Sub(hn::LoadU(d, p.z + at), z);
      const Double r2 = hn::Add(hn::Add(hn::Mul(dx, dx), hn::Mul(dy, dy)), hn::Mul(dz, dz));
      const auto other = hn::Ne(hn::Iota(d, double(at)), all(double(place)));
      const auto inside = hn::And(hn::Le(r2, value.cutoff2), other);
      sums.add(part, value(r2), dx, dy, dz, r2, hn::LoadU(d, p.weight + at), inside);
    }
  return sums.totals(p.weight[place]);
}

PairSum sum_over_list_here(const PairLaw& law, const PairPoints& points, size_t place,
                           std::span<const uint32_t> list) {
  switch (law.kind) {
    case PairLaw::Kind::lennard_jones:
      return over_list<LennardJonesLanes>(law, points, place, list);
    case PairLaw::Kind::inverse_distance:
      return over_list<InverseDistanceLanes>(law, points, place, list);
    default:
      return over_list<ScalarLanes>(law, points, place, list);
  }
}

PairSum sum_over_all_here(const PairLaw& law, const PairPoints& points, size_t place,
                          size_t count) {
  switch (law.kind) {
    case PairLaw::Kind::lennard_jones:
      return over_all<LennardJonesLanes>(law, points, place, count);
    case PairLaw::Kind::inverse_distance:
      return over_all<InverseDistanceLanes>(law, points, place, count);
    default:
      return over_all<ScalarLanes>(law, points, place, count);
  }
}

}  // namespace tumble::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tumble {
HWY_EXPORT(sum_over_list_here);
HWY_EXPORT(sum_over_all_here);

PairSum sum_over_list(const PairLaw& law, const PairPoints& points, size_t place,
                      std::span<const uint32_t> list) {
  return HWY_DYNAMIC_DISPATCH(sum_over_list_here)(law, points, place, list);
}
PairSum sum_over_all(const PairLaw& law, const PairPoints& points, size_t place, size_t count) {
  return HWY_DYNAMIC_DISPATCH(sum_over_all_here)(law, points, place, count);
}
}  // namespace tumble
#endif
