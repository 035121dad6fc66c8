#pragma once

/// The constants of this folder that no option gives, with unit, reason, and source where there is
/// one.
namespace tumble::tolerances {

/// The least offset of a wrap [longest sides of the mesh]: a thousand times what a coordinate may
/// be off in files of single precision.
inline constexpr double least_offset = 1e-6;

/// How far beyond the offset the first surface stands off the mesh [cells]. Every point of it is
/// within the longest edge of a tetrahedron, sqrt(3) cells, of a node that is at least this and the
/// offset from the mesh, and so is farther from the mesh than the offset.
inline constexpr double first_stand = 1.75;

/// Vertices of the first surface are farther than this from nodes of the grid, measured by the
/// value there [cells]: nearer ones make triangles that are mostly rounding, and being off by it is
/// within what being drawn to the mesh makes up for.
inline constexpr double off_nodes = 0.15;

/// Before it is drawn to the mesh the first surface loses its small triangles, as long as it moves
/// by no more than `even_error` [cells], a fraction of what the grid itself is off, and no edge
/// becomes longer than `even_edge` [cells], about the size of what the wrap can follow.
inline constexpr double even_error = 0.1, even_edge = 1.5;

/// From the boundary of the outside the first surface goes back at least this far, or not at all
/// [cells]. Distances from nodes make of a plane a surface that is rough by up to 1 / (2 way)
/// cells: a sixth.
inline constexpr double least_way_back = 3;

/// Where the first surface is no farther from the mesh than it stands off it and this, it follows
/// the mesh; elsewhere it closes a gap [cells]. The last node outside is at most sqrt(3) cells from
/// where it could be, and rounding of the grid to nodes adds up to a part of a cell.
inline constexpr double follows_within = 2;

/// A wrap keeps at least this part of its offset all over, as proven triangle by triangle [-]. On
/// flat and hollow parts it stands at the whole offset; over a ridge the flat triangles between
/// points at the offset cut the circle about the ridge, as a chord does: two that meet at 120
/// degrees and more keep the half.
inline constexpr double least_clearance = 0.5;

/// A vertex is above a plane of its triangles from this height on [cells]: less is the curvature of
/// what it follows.
inline constexpr double above_plane = 0.05;

/// Weight of where a vertex would go alone against the planes about it [-]: two that would meet in
/// a valley stay apart by this part of their ways, in their order.
inline constexpr double alone_weight = 0.05;

/// A vertex goes no farther down into a valley than this many times what the first surface stands
/// off the mesh [-]: in a right angle it is once, in sharper ones it goes a part of the way.
inline constexpr double longest_way = 2;

/// How often a way that is not free is halved before a vertex stays where it is [-]: an eighth of a
/// way that is at most some cells is no more than the error that is allowed.
inline constexpr int most_halvings = 3;

/// After that a vertex is left behind when it is this far beyond the offset [cells]: the error that
/// a wrap may have from being simplified.
inline constexpr double left_behind = 0.25;

/// How often all vertices are drawn to the mesh [-]: what was blocked by neighbours that had not
/// moved yet is free the next time; a fourth pass moved nothing by a tenth of a cell on the meshes
/// of the tests.
inline constexpr int most_passes = 3;

/// Error below which a vertex of the fine surface counts as lying in the planes of the other
/// [cells]: ten times the rounding of quadrics of walls of a thousand cells.
inline constexpr double same_wrap_place = 3e-4;

/// Triangles whose planes differ by less than this [rad] form one flat part; rounding of vertices
/// that were drawn to one wall is a thousandth of it.
inline constexpr double same_plane = 1e-9;

/// Square of how far from the middle of an edge its ends may be contracted to [squares of the
/// edge]: the corner of a cube is less than an edge from the middle of one that is cut off it.
inline constexpr double farthest_end = 2;

/// Least cosine of the angle that a triangle may turn by while edges about it are contracted [-]:
/// beyond some 78 degrees it is on its way to be folded.
inline constexpr double least_turn_cosine = 0.2;

/// Least height of a triangle over its longest side, unless those before were flatter [-]:
/// predicates are exact, but normals of flatter ones are mostly rounding.
inline constexpr double least_height = 1e-3;

/// Weight of an edge's squared length against its error in the order of contraction [-]: decides
/// among edges without error, so that flat parts are thinned out evenly.
inline constexpr double length_weight = 1e-4;

/// How far the measured distance of the wrap may be from the greatest that there is [-].
inline constexpr double measured_share = 0.02;

}  // namespace tumble::tolerances
