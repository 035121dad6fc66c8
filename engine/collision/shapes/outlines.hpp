#pragma once
#include "engine/collision/shape.hpp"

namespace tumble {

// What outlines of shapes are made of, in the frame of the shape.

using OutlineColour = Vec4f;

/// An arc about `centre` from u towards v [rad]; an ellipse where these differ in length.
void draw_arc(DebugDraw& out, const OutlineColour& colour, const Vec3& centre, const Vec3& u,
              const Vec3& v, double turn);
/// The same all the way round.
void draw_ring(DebugDraw& out, const OutlineColour& colour, const Vec3& centre, const Vec3& u,
               const Vec3& v);
/// Two rings about y and four lines between them; with half circles over the ends.
void draw_round_outline(DebugDraw& out, const OutlineColour& colour, double radius,
                        double half_height, bool caps);
/// Every edge of a mesh once, those of only one triangle too.
void draw_edges(DebugDraw& out, const OutlineColour& colour, const TriangleMesh& mesh);

/// A mesh as it is drawn, with sharp edges.
DrawnSurface drawn_mesh(const TriangleMesh& mesh);

}  // namespace tumble
