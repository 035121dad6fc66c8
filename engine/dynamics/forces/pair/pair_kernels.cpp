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
constexpr size_t batch = pair_batch;

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

/// Eight neighbours, as many at a time as there are lanes.
constexpr size_t parts = batch / hn::MaxLanes(Doubles());

struct PushLanes {
  Double fx[parts], fy[parts], fz[parts];
};
struct EnergyLanes {
  Double energy[parts], virial[parts];
};
HWY_INLINE void clear(Double* sums) {
  for (size_t k = 0; k < parts; ++k) sums[k] = all(0);
}
HWY_INLINE double total(const Double* lanes) {
  const Doubles d;
  HWY_ALIGN double v[batch];
  for (size_t k = 0; k < parts; ++k) hn::Store(lanes[k], d, v + k * hn::Lanes(d));
  return ((v[0] + v[4]) + (v[2] + v[6])) + ((v[1] + v[5]) + (v[3] + v[7]));
}

/// What a law says of some pairs; what does not count of it may be no number.
struct PairsHere {
  Double dx, dy, dz, r2, weight;
  HWY_INLINE void load(const PairPoint* near) {
    hn::LoadInterleaved4(Doubles(), &near->x, dx, dy, dz, weight);
  }
  HWY_INLINE void measure() {
    r2 = hn::Add(hn::Add(hn::Mul(dx, dx), hn::Mul(dy, dy)), hn::Mul(dz, dz));
  }
  HWY_INLINE void from(const PairPoint& own) {
    dx = hn::Sub(dx, all(own.x)), dy = hn::Sub(dy, all(own.y)), dz = hn::Sub(dz, all(own.z));
  }
  template <class Mask>
  HWY_INLINE void add(const PairLanes& v, Mask counts, size_t part, PushLanes& sums) const {
    const Double push = hn::IfThenElseZero(counts, hn::Mul(weight, v.push));
    sums.fx[part] = hn::Sub(sums.fx[part], hn::Mul(push, dx));
    sums.fy[part] = hn::Sub(sums.fy[part], hn::Mul(push, dy));
    sums.fz[part] = hn::Sub(sums.fz[part], hn::Mul(push, dz));
  }
  template <class Mask>
  HWY_INLINE void add(const PairLanes& v, Mask counts, size_t part, EnergyLanes& sums) const {
    const Double energy = hn::Mul(weight, v.energy), virial = hn::Mul(hn::Mul(weight, v.push), r2);
    sums.energy[part] = hn::Add(sums.energy[part], hn::IfThenElseZero(counts, energy));
    sums.virial[part] = hn::Add(sums.virial[part], hn::IfThenElseZero(counts, virial));
  }
};

/// Four candidates are copied behind what was found, measured there side by side, and those in
/// reach then written over them: no branch that cannot be foreseen.
class NearFinder {
 public:
  HWY_INLINE NearFinder(const PairPoint& own, double cutoff2)
      : own_(own), cutoff2_(hn::Set(Row(), cutoff2)) {}

  HWY_INLINE size_t add(const PairPoint* points, const uint32_t* list, PairPoint* near) const {
    const Row d;
    hn::Vec<Row> rows[four][pieces];
    for (size_t k = 0; k < four; ++k)
      for (size_t piece = 0; piece < pieces; ++piece) {
        rows[k][piece] = hn::LoadU(d, &points[list[k]].x + piece * lanes);
        hn::StoreU(rows[k][piece], d, &near[k].x + piece * lanes);
      }
    bool inside[four];
    for (size_t piece = 0; piece < pieces; ++piece) {
      hn::Vec<Row> x, y, z, weight;
      hn::LoadInterleaved4(d, &near[piece * lanes].x, x, y, z, weight);
      const auto dx = hn::Sub(x, hn::Set(d, own_.x)), dy = hn::Sub(y, hn::Set(d, own_.y)),
                 dz = hn::Sub(z, hn::Set(d, own_.z));
      const auto r2 = hn::Add(hn::Add(hn::Mul(dx, dx), hn::Mul(dy, dy)), hn::Mul(dz, dz));
      uint8_t bits[8];
      hn::StoreMaskBits(d, hn::Le(r2, cutoff2_), bits);
      for (size_t k = 0; k < lanes; ++k) inside[piece * lanes + k] = (bits[0] >> k & 1) != 0;
    }
    size_t found = 0;
    for (size_t k = 0; k < four; ++k) {
      for (size_t piece = 0; piece < pieces; ++piece)
        hn::StoreU(rows[k][piece], d, &near[found].x + piece * lanes);
      found += inside[k] ? 1 : 0;
    }
    return found;
  }

 private:
  static constexpr size_t four = 4;
  using Row = hn::CappedTag<double, four>;
  static constexpr size_t lanes = hn::MaxLanes(Row()), pieces = four / lanes;
  const PairPoint& own_;
  hn::Vec<Row> cutoff2_;
};

size_t find_near_here(const PairPoint* points, const PairPoint& own, std::span<const uint32_t> list,
                      double cutoff2, PairPoint* near) {
  const NearFinder finder(own, cutoff2);
  size_t found = 0, k = 0;
  for (; k + 4 <= list.size(); k += 4) found += finder.add(points, list.data() + k, near + found);
  for (; k < list.size(); ++k) {
    const PairPoint& other = points[list[k]];
    const double dx = other.x - own.x, dy = other.y - own.y, dz = other.z - own.z;
    near[found] = other;
    found += (dx * dx + dy * dy) + dz * dz <= cutoff2 ? 1 : 0;
  }
  return found;
}

template <class Law, class Sums>
HWY_INLINE void over_near(const PairLaw& law, const PairPoint& own, std::span<const PairPoint> near,
                          Sums& sums) {
  const EndedLanes<Law> value(law);
  PairsHere pairs;
  for (size_t k = 0; k < near.size(); k += batch)
    for (size_t part = 0; part < parts; ++part) {
      pairs.load(near.data() + k + part * hn::Lanes(Doubles()));
      pairs.from(own);
      pairs.measure();
      pairs.add(value(pairs.r2), hn::Le(pairs.r2, value.cutoff2), part, sums);
    }
}

/// Which of all points count for the one at `own`: all others, or those behind it.
enum class Others : uint8_t { all, later };

template <class Law, Others others, class Sums>
HWY_INLINE void over_all(const PairLaw& law, std::span<const PairPoint> points, size_t count,
                         size_t own, Sums& sums) {
  const Doubles d;
  const EndedLanes<Law> value(law);
  PairsHere pairs;
  const size_t first = others == Others::all ? 0 : own / batch * batch;
  for (size_t k = first; k < points.size(); k += batch)
    for (size_t part = 0; part < parts; ++part) {
      const size_t at = k + part * hn::Lanes(d);
      pairs.load(points.data() + at);
      pairs.from(points[own]);
      pairs.measure();
      const Double place = hn::Iota(d, double(at));
      const auto other =
          others == Others::all ? hn::Ne(place, all(double(own))) : hn::Gt(place, all(double(own)));
      const auto counts = hn::And(other, hn::Lt(place, all(double(count))));
      const auto inside = hn::And(hn::Le(pairs.r2, value.cutoff2), counts);
      pairs.add(value(pairs.r2), inside, part, sums);
    }
}

template <class F>
HWY_INLINE void with_law(const PairLaw& law, const F& f) {
  switch (law.kind) {
    case PairLaw::Kind::lennard_jones:
      return f.template operator()<LennardJonesLanes>();
    case PairLaw::Kind::inverse_distance:
      return f.template operator()<InverseDistanceLanes>();
    default:
      return f.template operator()<ScalarLanes>();
  }
}

PairPush push_of_here(const PairLaw& law, const PairPoint& own, std::span<const PairPoint> near) {
  PushLanes sums;
  clear(sums.fx), clear(sums.fy), clear(sums.fz);
  with_law(law, [&]<class Law>() { over_near<Law>(law, own, near, sums); });
  return {total(sums.fx), total(sums.fy), total(sums.fz)};
}
PairEnergy energy_of_here(const PairLaw& law, const PairPoint& own,
                          std::span<const PairPoint> near) {
  EnergyLanes sums;
  clear(sums.energy), clear(sums.virial);
  with_law(law, [&]<class Law>() { over_near<Law>(law, own, near, sums); });
  return {total(sums.energy), total(sums.virial)};
}
PairPush push_of_all_here(const PairLaw& law, std::span<const PairPoint> points, size_t count,
                          size_t own) {
  PushLanes sums;
  clear(sums.fx), clear(sums.fy), clear(sums.fz);
  with_law(law, [&]<class Law>() { over_all<Law, Others::all>(law, points, count, own, sums); });
  return {total(sums.fx), total(sums.fy), total(sums.fz)};
}
PairEnergy energy_of_later_here(const PairLaw& law, std::span<const PairPoint> points, size_t count,
                                size_t own) {
  EnergyLanes sums;
  clear(sums.energy), clear(sums.virial);
  with_law(law, [&]<class Law>() { over_all<Law, Others::later>(law, points, count, own, sums); });
  return {total(sums.energy), total(sums.virial)};
}

}  // namespace tumble::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tumble {
HWY_EXPORT(find_near_here);
HWY_EXPORT(push_of_here);
HWY_EXPORT(energy_of_here);
HWY_EXPORT(push_of_all_here);
HWY_EXPORT(energy_of_later_here);

size_t find_near(const PairPoint* points, const PairPoint& own, std::span<const uint32_t> list,
                 double cutoff2, PairPoint* near) {
  return HWY_DYNAMIC_DISPATCH(find_near_here)(points, own, list, cutoff2, near);
}

size_t fill_up(PairPoint* near, size_t count, const PairPoint& own, double cutoff) {
  const PairPoint beyond{own.x + 2 * cutoff, own.y, own.z, 0};
  for (; count % pair_batch != 0; ++count) near[count] = beyond;
  return count;
}

PairPush push_of(const PairLaw& law, const PairPoint& own, std::span<const PairPoint> near) {
  return HWY_DYNAMIC_DISPATCH(push_of_here)(law, own, near);
}
PairEnergy energy_of(const PairLaw& law, const PairPoint& own, std::span<const PairPoint> near) {
  return HWY_DYNAMIC_DISPATCH(energy_of_here)(law, own, near);
}
PairPush push_of_all(const PairLaw& law, std::span<const PairPoint> points, size_t count,
                     size_t own) {
  return HWY_DYNAMIC_DISPATCH(push_of_all_here)(law, points, count, own);
}
PairEnergy energy_of_later(const PairLaw& law, std::span<const PairPoint> points, size_t count,
                           size_t own) {
  return HWY_DYNAMIC_DISPATCH(energy_of_later_here)(law, points, count, own);
}
}  // namespace tumble
#endif
