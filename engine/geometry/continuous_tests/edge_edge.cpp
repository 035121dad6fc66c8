#include "engine/geometry/continuous_tests/edge_edge.hpp"

#include "engine/geometry/continuous_tests/coplanar_contact.hpp"
#include "engine/geometry/continuous_tests/exact_ends.hpp"
#include "engine/geometry/continuous_tests/moving_hull.hpp"
#include "engine/geometry/continuous_tests/moving_input.hpp"
#include "engine/geometry/primitive_tests/triangle_pairs.hpp"

namespace tumble {

namespace {

template <class Real>
MovingFrame<Real> frame_of(const MovingEdge& a, const MovingEdge& b) {
  const auto way = MovingFrame<Real>::way;
  MovingFrame<Real> out;
  out.u = {way(a[1].start, a[0].start), way(a[1].end, a[0].end)};
  out.v = {way(b[1].start, b[0].start), way(b[1].end, b[0].end)};
  out.x = {way(b[0].start, a[0].start), way(b[0].end, a[0].end)};
  return out;
}

}  // namespace

Result<std::optional<MovingContact>> edge_edge_contact(const MovingEdge& a, const MovingEdge& b,
                                                       double separation) {
  const std::array<const MovingPoint*, 2> of_a{&a[0], &a[1]}, of_b{&b[0], &b[1]};
  if (!(separation >= 0)) return bad_separation("edge_edge_contact", separation);
  const auto points = std::array{of_a[0], of_a[1], of_b[0], of_b[1]};
  const double largest = largest_magnitude(points);
  if (!(largest <= largest_direct)) {
    if (!std::isfinite(largest)) return not_finite("edge_edge_contact");
    constexpr double down = 0x1p-40;
    return edge_edge_contact({scaled(a[0], down), scaled(a[1], down)},
                             {scaled(b[0], down), scaled(b[1], down)}, separation * down);
  }
  std::optional<MovingContact> out;
  if (apart_along_axes(of_a, of_b, separation)) return out;
  const auto meet = [&](Vec3 MovingPoint::*at) {
    return segments_intersect(a[0].*at, a[1].*at, b[0].*at, b[1].*at);
  };
  double march_from = 0;
  if (separation == 0) {
    const auto frame = frame_of<double>(a, b);
    CubicAnswer answer = coplanar_contact<true>(frame);
    if (answer.doubt_from >= 0 && !frame.flat())
      answer = coplanar_contact<true>(frame_of<DoubleDouble>(a, b));
    if (answer.doubt_from < 0) return answer.contact;
    march_from = answer.doubt_from;
    if (march_from == 0 && meets_at_start(points, meet))
      return std::optional(contact_at_start(MovingHull(a, b)));
  }
  out = march(MovingHull(a, b), separation, march_from);
  if (out && !out->certain) decide_at_ends(*out, points, meet);
  return out;
}

}  // namespace tumble
