#pragma once
#include "engine/geometry/continuous_tests/coplanarity.hpp"
#include "engine/geometry/continuous_tests/moving.hpp"

#include <optional>

/// Shared by vertex-face and edge-edge: the roots of the cubic in order, each with its inside test.
namespace tumble {

enum class InPlane { outside, inside, in_doubt };

/// Whether the features meet at the root; what it says holds throughout the bracket. `normal` is
/// u x v there and `weights` the coordinates of the common point along u and v (vertex and face) or
/// along the two edges.
template <bool edges, class Real>
InPlane in_plane(const MovingFrame<Real>& w, const CoplanarityCubic<Real>& cubic,
                 const RootBracket<Real>& root, Vec3& normal, Vec2& weights) {
  const Real t = root.t, s = CoplanarityCubic<Real>::one_minus(t);
  const auto at = [&](const std::array<Triple<Real>, 2>& p) {
    return Triple<Real>{p[0].x * s + p[1].x * t, p[0].y * s + p[1].y * t, p[0].z * s + p[1].z * t};
  };
  const Triple<Real> u = at(w.u), v = at(w.v), x = at(w.x), n = u.cross(v);
  const Real first = x.cross(v).dot(n), second = (edges ? x.cross(u) : u.cross(x)).dot(n),
             whole = n.dot(n);
  // Four factors, at most 12 times the product of their largest coordinates: rounding below 512
  // units; each changes by at most twice its size over the unit of time.
  const double relative = 512 * unit_of<Real>() + 200 * root.width;
  const double area = cubic.u * cubic.v;
  const double error_first = area * cubic.x * cubic.v * relative,
               error_second = area * cubic.x * cubic.u * relative,
               error_whole = area * area * relative;
  const double f = leading(first), g = leading(second);
  if (f < -error_first || g < -error_second) return InPlane::outside;
  if constexpr (edges) {
    const double rest_f = leading(whole - first), rest_g = leading(whole - second);
    const double error_f = error_first + error_whole, error_g = error_second + error_whole;
    if (rest_f < -error_f || rest_g < -error_g) return InPlane::outside;
    if (!(rest_f > error_f) || !(rest_g > error_g)) return InPlane::in_doubt;
  } else {
    const double third = leading(whole - first - second);
    const double error = error_first + error_second + error_whole;
    if (third < -error) return InPlane::outside;
    if (!(third > error)) return InPlane::in_doubt;
  }
  if (!(f > error_first) || !(g > error_second)) return InPlane::in_doubt;
  normal = {leading(n.x), leading(n.y), leading(n.z)};
  weights = Vec2(f, g) / leading(whole);
  return InPlane::inside;
}

/// What the cubic says: a contact, none, or a time from which on it cannot tell.
struct CubicAnswer {
  std::optional<MovingContact> contact;
  double doubt_from = -1;  ///< negative: never
};

template <bool edges, class Real>
CubicAnswer coplanar_contact(const MovingFrame<Real>& frame) {
  CubicAnswer out;
  const CoplanarityCubic<Real> cubic(frame);
  if (!cubic.usable) {
    out.doubt_from = 0;
    return out;
  }
  const CubicPieces pieces(cubic);
  for (int k = 0; k < pieces.count; ++k) {
    const CubicPiece& piece = pieces.piece[size_t(k)];
    if (!piece.in_doubt() && !piece.has_root()) continue;
    out.doubt_from = piece.begin;
    if (piece.in_doubt()) return out;
    const RootBracket<Real> root = bracket_root(cubic, piece);
    if (!root.found()) return out;
    Vec3 normal;
    Vec2 weights;
    const InPlane where = in_plane<edges>(frame, cubic, root, normal, weights);
    if (where == InPlane::in_doubt) return out;
    out.doubt_from = -1;
    if (where == InPlane::outside) continue;
    // f > 0: a vertex above the face, or the second edge above the first.
    normal *= (edges ? piece.sign_begin : -piece.sign_begin) / normal.norm();
    const double margin = root.width + 0x1p-52, t = leading(root.t);
    out.contact = MovingContact{std::max(piece.begin, t - margin), std::min(piece.end, t + margin),
                                true, weights, normal};
    return out;
  }
  return out;
}

}  // namespace tumble
