#pragma once
#include "engine/collision/shape.hpp"

namespace tumble {

// Parts of outlines of shapes, in the frame of the shape.

using OutlineColour = Vec4f;

/// An arc about `centre` from u towards v, of the angle `turn` [rad]; part of an ellipse if u and v
/// differ in length.
void draw_arc(DebugDraw& out, const OutlineColour& colour, const Vec3& centre, const Vec3& u,
              const Vec3& v, double turn);
/// The full circle or ellipse.
void draw_ring(DebugDraw& out, const OutlineColour& colour, const Vec3& centre, const Vec3& u,
               const Vec3& v);
/// Two rings about y and four lines between them; with half circles over the ends.
void draw_round_outline(DebugDraw& out, const OutlineColour& colour, double radius,
                        double half_height, bool caps);
/// Every edge of a mesh once, open edges too.
void draw_edges(DebugDraw& out, const OutlineColour& colour, const TriangleMesh& mesh);

/// The surface of a mesh for drawing, with sharp edges.
DrawnSurface drawn_mesh(const TriangleMesh& mesh);

}  // namespace tumble
