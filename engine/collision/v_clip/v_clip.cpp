#include "engine/collision/v_clip/v_clip.hpp"

#include "engine/collision/v_clip/walk.hpp"
#include "engine/math/triple.hpp"

#include <cmath>

namespace tumble {
namespace {

/// In units of the pair's scale: rounding of a signed distance, distance that counts as contact,
/// and error of a result above which the search is repeated exhaustively.
constexpr double plane_tolerance = 2e-15, contact_tolerance = 1e-13, doubtful_error = 2e-13;

/// Columns of the rotation, read number by number: callers have often just stored them in other
/// pairs, and a load across two stores would stall the processor.
std::array<Plain3, 3> columns(const Mat3& R) {
  const double* m = R.data();
  return {Plain3{m[0], m[1], m[2]}, Plain3{m[3], m[4], m[5]}, Plain3{m[6], m[7], m[8]}};
}

vclip::Walk relative_poses(const PlacedPolyhedron& A, const PlacedPolyhedron& B) {
  vclip::Walk w;
  const auto a = columns(A.R), b = columns(B.R);
  const Plain3 offset{B.x.x() - A.x.x(), B.x.y() - A.x.y(), B.x.z() - A.x.z()};
  w.side[0].model = A.model;
  w.side[1].model = B.model;
  for (size_t k = 0; k < 3; ++k) {
    for (size_t l = 0; l < 3; ++l)
      w.side[0].R(int(l), int(k)) = w.side[1].R(int(k), int(l)) = a[k].dot(b[l]);
    w.side[1].t[int(k)] = a[k].dot(offset);
    w.side[0].t[int(k)] = -b[k].dot(offset);
  }
  w.centres = w.side[1].to_other(B.model->centre) - A.model->centre;
  w.apart = w.centres.norm();
  w.reach = 2 * (A.model->radius + B.model->radius);
  w.scale = w.reach + w.apart;
  w.epsilon = plane_tolerance * w.scale;
  w.touching = contact_tolerance * w.scale;
  return w;
}

void set_start(vclip::Walk& w, const ClosestFeatures* start) {
  if (start && w.side[0].model->has((*start)[0]) && w.side[1].model->has((*start)[1]) &&
      !((*start)[0].kind == FeatureKind::face && (*start)[1].kind == FeatureKind::face)) {
    w.at = *start;
    return;
  }
  w.at[0] = {FeatureKind::vertex, climb(*w.side[0].model, w.centres)};
  w.at[1] = {FeatureKind::vertex, climb(*w.side[1].model, w.side[0].turn(-w.centres))};
}

vclip::Move examine(vclip::Walk& w) {
  using enum FeatureKind;
  const auto pair = [](FeatureKind a, FeatureKind b) { return 3 * uint32_t(a) + uint32_t(b); };
  switch (pair(w.at[0].kind, w.at[1].kind)) {
    case pair(vertex, vertex):
      return vertex_vertex(w);
    case pair(vertex, edge):
      return vertex_edge(w, 0);
    case pair(edge, vertex):
      return vertex_edge(w, 1);
    case pair(vertex, face):
      return vertex_face(w, 0);
    case pair(face, vertex):
      return vertex_face(w, 1);
    case pair(edge, edge):
      return edge_edge(w);
    case pair(edge, face):
      return edge_face(w, 0);
    default:
      return edge_face(w, 1);  // two faces never occur
  }
}

/// Walks to the end. False if it comes back to an earlier pair (Brent's algorithm), as it would
/// then never end.
bool walk_to_end(vclip::Walk& w, int& steps, vclip::Move& move,
                 std::vector<ClosestFeatures>* trace) {
  ClosestFeatures seen = w.at;
  for (int since = 0, power = 4;;) {
    if (trace) trace->push_back(w.at);
    ++steps;
    move = examine(w);
    if (move != vclip::Move::onward) return true;
    if (w.at == seen) return false;
    if (++since == power) {
      seen = w.at;
      since = 0;
      power *= 2;
    }
  }
}

void write_result(const vclip::Walk& w, vclip::Move move, const PlacedPolyhedron& A,
                  const PlacedPolyhedron& B, VClipResult& r) {
  r.features = w.at;
  if (move == vclip::Move::penetrating) {
    r.state = VClipState::penetrating;
    return;
  }
  const vclip::Answer& found = w.found;
  r.distance = found.distance;
  if (!std::isfinite(r.distance)) {
    r.state = VClipState::invalid;
    return;
  }
  r.state = r.distance <= w.touching ? VClipState::touching : VClipState::separated;
  const PlacedPolyhedron& frame = found.frame == 0 ? A : B;
  r.a = frame.x + frame.R * found.points[0];
  r.b = frame.x + frame.R * found.points[1];
  r.normal = frame.R * found.normal;
}

}  // namespace

VClipResult v_clip(const PlacedPolyhedron& A, const PlacedPolyhedron& B,
                   const VClipOptions& options) {
  VClipResult r;
  vclip::Walk w = relative_poses(A, B);
  if (!std::isfinite(w.scale)) return r;  // NaN where a rotation has one
  set_start(w, options.start);
  vclip::Move move = vclip::Move::penetrating;
  if (w.apart + 2 * w.touching < A.model->inner_radius + B.model->inner_radius) {
    write_result(w, move, A, B, r);  // the inner balls overlap
    return r;
  }
  if (!walk_to_end(w, r.steps, move, options.trace)) {
    r.answer = VClipAnswer::search_after_cycle;
    move = vclip::search_all(w);
  } else if (move == vclip::Move::arrived) {
    const double corner = std::min(A.model->least_corner_sine, B.model->least_corner_sine);
    const bool face = w.at[0].kind == FeatureKind::face || w.at[1].kind == FeatureKind::face;
    if (w.found.distance <= w.touching && !face) {
      move = vclip::judge_touching(w);
    } else if (w.found.overshoot > doubtful_error * w.scale * corner) {
      r.answer = VClipAnswer::search_after_doubt;
      move = vclip::search_all(w);
    }
  }
  write_result(w, move, A, B, r);
  return r;
}

}  // namespace tumble
