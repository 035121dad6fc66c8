#include "engine/geometry/continuous_tests/vertex_face.hpp"

#include "engine/geometry/continuous_tests/coplanar_contact.hpp"
#include "engine/geometry/continuous_tests/exact_ends.hpp"
#include "engine/geometry/continuous_tests/moving_hull.hpp"
#include "engine/geometry/continuous_tests/moving_input.hpp"
#include "engine/geometry/primitive_tests/triangle_pairs.hpp"

namespace tumble {

namespace {

template <class Real>
MovingFrame<Real> frame_of(const MovingPoint& p, const MovingTriangle& t) {
  const auto way = MovingFrame<Real>::way;
  MovingFrame<Real> out;
  out.u = {way(t[1].start, t[0].start), way(t[1].end, t[0].end)};
  out.v = {way(t[2].start, t[0].start), way(t[2].end, t[0].end)};
  out.x = {way(p.start, t[0].start), way(p.end, t[0].end)};
  return out;
}

}  // namespace

Result<std::optional<MovingContact>> vertex_face_contact(const MovingPoint& vertex,
                                                         const MovingTriangle& face,
                                                         double separation) {
  const std::array<const MovingPoint*, 1> a{&vertex};
  const std::array<const MovingPoint*, 3> b{&face[0], &face[1], &face[2]};
  if (!(separation >= 0)) return bad_separation("vertex_face_contact", separation);
  const auto points = std::array{a[0], b[0], b[1], b[2]};
  const double largest = largest_magnitude(points);
  if (!(largest <= largest_direct)) {
    if (!std::isfinite(largest)) return not_finite("vertex_face_contact");
    constexpr double down = 0x1p-40;
    return vertex_face_contact(
        scaled(vertex, down), {scaled(face[0], down), scaled(face[1], down), scaled(face[2], down)},
        separation * down);
  }
  std::optional<MovingContact> out;
  if (apart_along_axes(a, b, separation)) return out;
  const auto meet = [&](Vec3 MovingPoint::*at) {
    return point_in_triangle(vertex.*at, {face[0].*at, face[1].*at, face[2].*at});
  };
  double march_from = 0;
  if (separation == 0) {
    const auto frame = frame_of<double>(vertex, face);
    CubicAnswer answer = coplanar_contact<false>(frame);
    if (answer.doubt_from >= 0 && !frame.flat())
      answer = coplanar_contact<false>(frame_of<DoubleDouble>(vertex, face));
    if (answer.doubt_from < 0) return answer.contact;
    march_from = answer.doubt_from;
    if (march_from == 0 && meets_at_start(points, meet))
      return std::optional(contact_at_start(MovingHull(vertex, face)));
  }
  out = march(MovingHull(vertex, face), separation, march_from);
  if (out && !out->certain) decide_at_ends(*out, points, meet);
  return out;
}

}  // namespace tumble
