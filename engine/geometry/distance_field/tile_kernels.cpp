// Distances of the nodes of a tile from triangles, a row of nodes at a time.
#include "engine/geometry/distance_field/tile_kernels.hpp"

#include "engine/geometry/distance_field/tolerances.hpp"

#include <cmath>
#include <cstdint>
#include <limits>

// Compiles this file once per instruction set, with the includes that each time needs.
// clang-format off
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "engine/geometry/distance_field/tile_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace tumble::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Lanes = hn::CappedTag<double, TileTriangles::batch>;
using Numbers = hn::Vec<Lanes>;

struct Numbers3 {
  Numbers x, y, z;
};

HWY_INLINE Numbers3 operator-(const Numbers3& a, const Numbers3& b) {
  return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}
HWY_INLINE Numbers3 operator*(Numbers s, const Numbers3& a) {
  return {hn::Mul(s, a.x), hn::Mul(s, a.y), hn::Mul(s, a.z)};
}
HWY_INLINE Numbers dot(const Numbers3& a, const Numbers3& b) {
  return hn::Add(hn::Mul(a.x, b.x), hn::Add(hn::Mul(a.y, b.y), hn::Mul(a.z, b.z)));
}
HWY_INLINE Numbers3 cross(const Numbers3& a, const Numbers3& b) {
  return {hn::Sub(hn::Mul(a.y, b.z), hn::Mul(a.z, b.y)),
          hn::Sub(hn::Mul(a.z, b.x), hn::Mul(a.x, b.z)),
          hn::Sub(hn::Mul(a.x, b.y), hn::Mul(a.y, b.x))};
}

/// Reads columns of one triangle into every lane.
struct OneTriangle {
  const TileTriangles& from;
  size_t n;
  HWY_INLINE Numbers operator()(size_t column) const {
    return hn::Set(Lanes(), from.column(column)[n]);
  }
};
/// The same of another triangle in each lane.
struct TriangleByLane {
  const TileTriangles& from;
  hn::VFromD<hn::RebindToSigned<Lanes>> n;
  HWY_INLINE Numbers operator()(size_t column) const {
    return hn::GatherIndex(Lanes(), from.column(column), n);
  }
};
/// The same of as many successive triangles as there are lanes.
struct SuccessiveTriangles {
  const TileTriangles& from;
  size_t n;
  HWY_INLINE Numbers operator()(size_t column) const {
    return hn::LoadU(Lanes(), from.column(column) + n);
  }
};

template <class Get>
HWY_INLINE Numbers3 three(const Get& get, size_t column) {
  return {get(column), get(column + 1), get(column + 2)};
}

/// Squared distance of points from triangles: that from the plane where the projection is inside,
/// else that of the nearest side.
template <class Get>
HWY_INLINE Numbers squared_distance(const Numbers3& p, const Get& triangle) {
  const Lanes lanes;
  const auto zero = hn::Zero(lanes), one = hn::Set(lanes, 1.0);
  const Numbers3 a = three(triangle, TileTriangles::corner),
                 b = three(triangle, TileTriangles::corner + 3),
                 c = three(triangle, TileTriangles::corner + 6);
  const auto from_side = [&](const Numbers3& way, const Numbers3& side, size_t k) HWY_ATTR {
    const auto along = hn::Mul(dot(side, way), triangle(TileTriangles::inverse_square + k));
    const Numbers3 rest = way - hn::Min(hn::Max(along, zero), one) * side;
    return dot(rest, rest);
  };
  const Numbers3 pa = p - a, pb = p - b, pc = p - c;
  const auto sides =
      hn::Min(hn::Min(from_side(pa, b - a, 0), from_side(pb, c - b, 1)), from_side(pc, a - c, 2));
  const auto least_inward = hn::Min(hn::Min(dot(three(triangle, TileTriangles::inward), pa),
                                            dot(three(triangle, TileTriangles::inward + 3), pb)),
                                    dot(three(triangle, TileTriangles::inward + 6), pc));
  const auto height = dot(three(triangle, TileTriangles::normal), pa);
  return hn::IfThenElse(hn::Gt(least_inward, zero), hn::Mul(height, height), sides);
}

void PrepareTriangles(TileTriangles& t) {
  const Lanes lanes;
  for (size_t n = 0; n < t.size(); n += hn::Lanes(lanes)) {
    const SuccessiveTriangles get{t, n};
    const auto put = [&](Numbers v, size_t column)
                         HWY_ATTR { hn::StoreU(v, lanes, t.column(column) + n); };
    const auto put3 = [&](const Numbers3& v, size_t column) HWY_ATTR {
      put(v.x, column), put(v.y, column + 1), put(v.z, column + 2);
    };
    const Numbers3 a = three(get, TileTriangles::corner), b = three(get, TileTriangles::corner + 3),
                   c = three(get, TileTriangles::corner + 6);
    const Numbers3 ab = b - a, bc = c - b, ca = a - c;
    const Numbers3 area = cross(ab, c - a);
    const auto one = hn::Set(lanes, 1.0);
    const Numbers3 normal = hn::Div(one, hn::Sqrt(dot(area, area))) * area;
    put3(normal, TileTriangles::normal);
    put3(cross(normal, ab), TileTriangles::inward);
    put3(cross(normal, bc), TileTriangles::inward + 3);
    put3(cross(normal, ca), TileTriangles::inward + 6);
    put(hn::Div(one, dot(ab, ab)), TileTriangles::inverse_square);
    put(hn::Div(one, dot(bc, bc)), TileTriangles::inverse_square + 1);
    put(hn::Div(one, dot(ca, ca)), TileTriangles::inverse_square + 2);
    const auto third = hn::Set(lanes, 1.0 / 3);
    const Numbers3 middle{hn::Mul(third, hn::Add(hn::Add(a.x, b.x), c.x)),
                          hn::Mul(third, hn::Add(hn::Add(a.y, b.y), c.y)),
                          hn::Mul(third, hn::Add(hn::Add(a.z, b.z), c.z))};
    put3(middle, TileTriangles::middle);
    const Numbers3 ma = a - middle, mb = b - middle, mc = c - middle;
    const auto square = hn::Max(hn::Max(dot(ma, ma), dot(mb, mb)), dot(mc, mc));
    put(hn::Mul(hn::Sqrt(square), hn::Set(lanes, 1 + tolerances::distance_rounding)),
        TileTriangles::radius);
  }
}

/// The triangles that may be near a row of nodes.
class RowTriangles {
 public:
  RowTriangles(const TileTriangles& from, double cell, double within)
      : from_(from),
        reach_(from.size() + TileTriangles::batch),
        apart_(from.size() + TileTriangles::batch) {
    found_.resize(from.size() + TileTriangles::batch);
    const Lanes lanes;
    const auto range = hn::Set(lanes, std::sqrt(within) * (1 + tolerances::prune_slack)),
               length = hn::Set(lanes, (tile_nodes - 1) * cell), zero = hn::Zero(lanes);
    for (size_t n = 0; n < from.size(); n += hn::Lanes(lanes)) {
      const SuccessiveTriangles get{from, n};
      const auto reach = hn::Add(get(TileTriangles::radius), range);
      hn::StoreU(hn::Mul(reach, reach), lanes, reach_.data() + n);
      const auto x = get(TileTriangles::middle);
      const auto gap = hn::Max(hn::Max(hn::Sub(x, length), hn::Neg(x)), zero);
      hn::StoreU(hn::Mul(gap, gap), lanes, apart_.data() + n);
    }
  }

  /// Those of the row at y and z.
  HWY_INLINE size_t find(double y, double z) {
    const Lanes lanes;
    size_t count = 0;
    const auto row_y = hn::Set(lanes, y), row_z = hn::Set(lanes, z);
    for (size_t n = 0; n < from_.size(); n += hn::Lanes(lanes)) {
      const SuccessiveTriangles get{from_, n};
      const auto dy = hn::Sub(row_y, get(TileTriangles::middle + 1)),
                 dz = hn::Sub(row_z, get(TileTriangles::middle + 2));
      const auto square =
          hn::Add(hn::LoadU(lanes, apart_.data() + n), hn::Add(hn::Mul(dy, dy), hn::Mul(dz, dz)));
      const auto near = hn::And(hn::Le(square, hn::LoadU(lanes, reach_.data() + n)),
                                hn::FirstN(lanes, from_.size() - n));
      uint8_t bytes[8] = {};
      hn::StoreMaskBits(lanes, near, bytes);
      for (unsigned bits = bytes[0]; bits != 0; bits &= bits - 1)
        found_[count++] = uint32_t(n) + uint32_t(__builtin_ctz(bits));
    }
    return count;
  }
  uint32_t operator[](size_t k) const { return found_[k]; }

 private:
  const TileTriangles& from_;
  std::vector<double> reach_;  ///< square of how far a node's row may be from the centroid [m^2]
  std::vector<double> apart_;  ///< square of how far the centroid is from the tile along x [m^2]
  std::vector<uint32_t> found_;
};

/// Lowers `best` of the nodes p by the first `count` triangles of a row. Bounds come first: what is
/// nearest by its centroid is measured in each lane, so that few of the others can be nearer.
HWY_INLINE Numbers measure_row(const TileTriangles& from, const RowTriangles& row, size_t count,
                               const Numbers3& p, Numbers best) {
  const Lanes lanes;
  const hn::RebindToSigned<Lanes> whole;
  auto by_centroid = hn::Set(lanes, std::numeric_limits<double>::infinity());
  auto which = hn::Zero(whole);
  for (size_t k = 0; k < count; ++k) {
    const Numbers3 way = p - three(OneTriangle{from, row[k]}, TileTriangles::middle);
    const auto square = dot(way, way);
    const auto nearer = hn::Lt(square, by_centroid);
    by_centroid = hn::Min(square, by_centroid);
    which = hn::IfThenElse(hn::RebindMask(whole, nearer), hn::Set(whole, int64_t{row[k]}), which);
  }
  best = hn::Min(best, squared_distance(p, TriangleByLane{from, which}));
  const auto slack = hn::Set(lanes, 1 + tolerances::prune_slack), zero = hn::Zero(lanes),
             four = hn::Set(lanes, 4.0);
  for (size_t k = 0; k < count; ++k) {
    const OneTriangle triangle{from, row[k]};
    // In its plane the triangle is in a disc of radius r about its centroid. With the height h of a
    // node over the plane and q^2 = best - h^2, only nodes whose projections are within r + q of
    // the centroid can be nearer to it: o^2 <= (r + q)^2, for o^2 + h^2 = |way|^2.
    const Numbers3 way = p - three(triangle, TileTriangles::middle);
    const auto height = dot(three(triangle, TileTriangles::normal), way);
    const auto bound = hn::Mul(best, slack), r = triangle(TileTriangles::radius);
    const auto r_square = hn::Mul(r, r), q_square = hn::Sub(bound, hn::Mul(height, height));
    const auto beyond = hn::Max(hn::Sub(hn::Sub(dot(way, way), r_square), bound), zero);
    const auto most = hn::Mul(four, hn::Mul(r_square, q_square));
    const auto chance = hn::And(hn::Ge(q_square, zero), hn::Ge(most, hn::Mul(beyond, beyond)));
    if (hn::AllFalse(lanes, chance)) continue;
    best = hn::Min(best, squared_distance(p, triangle));
  }
  return best;
}

void MeasureTile(const TileTriangles& triangles, double cell, double within, TileDistances& best) {
  const Lanes lanes;
  RowTriangles row(triangles, cell, within);
  for (int z = 0; z < tile_nodes; ++z)
    for (int y = 0; y < tile_nodes; ++y) {
      const size_t count = row.find(cell * y, cell * z);
      if (count == 0) continue;
      for (int x = 0; x < tile_nodes; x += int(hn::Lanes(lanes))) {
        double* const at = best.data() + node_in_tile(x, y, z);
        const Numbers3 p{hn::Mul(hn::Set(lanes, cell), hn::Iota(lanes, double(x))),
                         hn::Set(lanes, cell * y), hn::Set(lanes, cell * z)};
        hn::StoreU(measure_row(triangles, row, count, p, hn::LoadU(lanes, at)), lanes, at);
      }
    }
}

}  // namespace tumble::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tumble {

HWY_EXPORT(PrepareTriangles);
HWY_EXPORT(MeasureTile);

void prepare_triangles(TileTriangles& triangles) {
  HWY_DYNAMIC_DISPATCH(PrepareTriangles)(triangles);
}
void measure_tile(const TileTriangles& triangles, double cell, double within, TileDistances& best) {
  HWY_DYNAMIC_DISPATCH(MeasureTile)(triangles, cell, within, best);
}

}  // namespace tumble
#endif
