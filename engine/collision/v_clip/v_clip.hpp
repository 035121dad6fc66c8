#pragma once
#include "engine/collision/v_clip/voronoi_polyhedron.hpp"

// clang-format off
/// V-Clip: the closest features of two convex polyhedra (Mirtich, "V-Clip: Fast and robust
/// polyhedral collision detection", ACM Transactions on Graphics 17(3), 1998; Coutinho §4.9).
///
/// A walk over pairs of features, vertices V, edges E and faces F, one of each body. The space
/// around a polyhedron is divided into Voronoi regions V(X): the points nearer to feature X than
/// to any other. Regions of neighbours meet in vertex-edge planes (VE: across the edge, through
/// its end) and face-edge planes (FE: upright on the face, through the edge). When points x of X
/// and y of Y are nearest to each other, x in V(Y) and y in V(X), none of the bodies are nearer.
/// Otherwise a plane that is violated names the neighbour to go to, and the distance of the
/// features falls, or stays the same with a feature of lower dimension.
///
///            1 >             3 >
///   +-----+ ------- +-----+ ------- +-----+
///   | V-V |         | V-E |         | E-E |       in V-V, V-E, E-E and V-F, when no test
///   +-----+ ------- +-----+ ------- +-----+       names a neighbour: separated
///            < 2     |   ^   < 4     |   ^
///                  5 |   | 6       7 |   | 8
///                    v   |   9 >     v   |
///             .---> +-----+ ------- +-----+
///          10 |     | V-F |         | E-F | --- 12 ---> penetrating
///             '---- +-----+ ------- +-----+
///                      |    < 11       |
///                   13 |               '------- 14 ---> V-E
///                      v
///                 penetrating
///
///    1  one vertex is beyond a VE plane of the other: the other becomes the edge of that plane
///    2  v is beyond a VE plane of e: e becomes its end
///    3  e is clipped by the VE planes of v; where it enters or leaves V(v) the derivative of the
///       distance along e says that its nearest point is outside: v becomes the edge of that plane
///    4  one edge, clipped by the VE planes of the other, has its nearest point beyond an end: the
///       other becomes that end
///    5  v is beyond an FE plane of e, over the face: e becomes the face
///    6  v is beyond FE planes of f: f becomes the edge of the plane violated most
///    7  one edge, clipped by the FE planes of the other, has its nearest point over a face: the
///       other becomes that face
///    8  e is clipped by the FE planes of f, and its end nearer to f (by the sign of the derivative
///       of the height along e) is cut off there: f becomes the edge of that plane; or e is outside
///       V(f): f becomes the edge of its outline that is nearest to e,
///   14  or the corner of its outline, if that is nearest
///    9  an edge of v nears the plane of f (derivative of the height): v becomes that edge
///   10  v is below f and none of its edges rises to f, a local minimum: f becomes the face whose
///       plane is furthest below v
///   11  the nearer end of e is not cut off: e becomes that vertex
///   12  heights of e over f inside V(f) have opposite signs: penetration
///   13  v is below the planes of all faces: penetration
///
/// Where the derivative is zero (parallel edges and faces) the walk stays where it is.
///
/// **Rounding.** A plane is violated only beyond 2e-15 of the pair's scale (diameters and distance
/// of the centres), several times the rounding of the test. The walk has no memory but its pair of
/// features, so it ends or comes back to a pair; Brent's method (1980) notices the return. Each
/// answer has a bound on its error from the slopes that the tests found; where it is too wide
/// (edges almost parallel at a gap of 1e-8), and after a cycle, the answer comes from an exhaustive
/// search (search_all) that starts from GJK, and the result says so.
// clang-format on
namespace tumble {

/// A polyhedron in the frame of a query.
struct PlacedPolyhedron {
  const VoronoiPolyhedron* model = nullptr;
  Mat3 R = Mat3::Identity();
  Vec3 x = Vec3::Zero();

  PlacedPolyhedron(const VoronoiPolyhedron& m, const Mat3& rotation, const Vec3& origin)
      : model(&m), R(rotation), x(origin) {}
  PlacedPolyhedron(const VoronoiPolyhedron& m, const Pose& pose)
      : model(&m), R(pose.q.toRotationMatrix()), x(pose.x) {}
};

enum class VClipState {
  separated,    ///< the distance is known
  touching,     ///< apart or overlapping by no more than 1e-13 of the scale
  penetrating,  ///< they overlap; no distance, points or normal
  invalid,      ///< a pose is not finite, or too far for double precision
};

/// Which algorithm gave the result.
enum class VClipAnswer {
  walk,
  search_after_cycle,  ///< the walk came back to an earlier pair
  search_after_doubt,  ///< the walk ended, but rounding could hide a nearer pair
};

struct VClipResult {
  VClipState state = VClipState::invalid;
  /// |distance - exact| <= 1e-12 scale + flatness of both; 0 when penetrating [m]
  double distance = 0;
  Vec3 a = Vec3::Zero();  ///< witness on A, query frame; zero when penetrating
  Vec3 b = Vec3::Zero();
  Vec3 normal = Vec3::Zero();  ///< unit, from A to B; zero when penetrating
  /// The closest features, or those at which penetration was detected. For the start of the next
  /// query.
  ClosestFeatures features;
  /// Number of pairs of features examined; 0 if the inscribed balls of the two overlap, which
  /// proves penetration without a walk.
  int steps = 0;
  VClipAnswer answer = VClipAnswer::walk;
};

struct VClipOptions {
  /// The features of an earlier query of the same two polyhedra; indices out of range are ignored.
  /// Without it the walk starts at the vertices extreme along the line of the centres.
  const ClosestFeatures* start = nullptr;
  /// Receives each pair that is examined, for drawing the walk.
  std::vector<ClosestFeatures>* trace = nullptr;
};

/// Distance and closest features of two polyhedra. Thread-safe; the same call gives the same bits.
VClipResult v_clip(const PlacedPolyhedron& A, const PlacedPolyhedron& B,
                   const VClipOptions& options = {});

}  // namespace tumble
