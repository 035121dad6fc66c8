#pragma once

/// The numbers of this folder that no option gives: unit, reason, and source where there is one.
namespace tumble::tolerances {

/// Reflex edges no deeper than this are none, and those as near to a cut are on it [diagonals of
/// the mesh]: some thousand roundings of coordinates about its middle, far beneath anything that a
/// body can feel.
inline constexpr double on_plane = 1e-12;

/// The same in units of the largest coordinate, where the mesh is far from the origin: some
/// roundings of its coordinates.
inline constexpr double on_plane_far = 1e-14;

/// What is thinner than this is a matter of rounding [diagonals and largest coordinates of the
/// mesh]: a few dozen roundings of coordinates.
inline constexpr double rounding = 4e-15;

/// Exact pieces of less than this are left out [volumes of the mesh]: ten thousand of them are what
/// volumes may be off by, and rounded corners give none of them a volume that means anything.
inline constexpr double no_volume = 1e-16;

/// In approximate mode reflex edges no deeper than this are none, and parts no thicker are left out
/// [diagonals of the mesh]: far beneath the error that is allowed.
inline constexpr double on_plane_roughly = 1e-7;

/// Planes that turn by less than this about an edge are one [rad].
inline constexpr double same_turn = 1e-9;

/// Of a mesh's volume this much may go lost in skins before a tolerance counts as too large for it
/// [-].
inline constexpr double lost_volume = 1e-6;

/// Directions of approximate cuts are those of faces unless they are this near to one that is tried
/// already [rad].
inline constexpr double same_cut_direction = 1e-3;

}  // namespace tumble::tolerances
