#pragma once

/// The constants of this folder that no option gives, with unit, reason, and source where there is
/// one.
namespace tumble::tolerances {

/// Shallower reflex edges are ignored, and those within this distance of a cut are on it [diagonals
/// of the mesh]: about a thousand rounding errors of coordinates about its middle, far too small to
/// matter to contacts.
inline constexpr double on_plane = 1e-12;

/// The same in units of the largest coordinate, for meshes far from the origin: some rounding
/// errors of its coordinates.
inline constexpr double on_plane_far = 1e-14;

/// Thickness that may be due to rounding [diagonals and largest coordinates of the mesh]: a few
/// dozen rounding errors of coordinates.
inline constexpr double rounding = 4e-15;

/// Exact pieces with less volume than this are left out [volumes of the mesh]: ten thousand of them
/// are the error of volumes, and with rounded corners their own volume is meaningless.
inline constexpr double no_volume = 1e-16;

/// In approximate mode shallower reflex edges are ignored, and thinner parts are left out
/// [diagonals of the mesh]: far below the allowed error.
inline constexpr double on_plane_roughly = 1e-7;

/// Planes through an edge whose angles differ by less than this count as the same [rad].
inline constexpr double same_turn = 1e-9;

/// Share of a mesh's volume that may be lost in thin layers before a tolerance counts as too large
/// for it [-].
inline constexpr double lost_volume = 1e-6;

/// Approximate cuts have the directions of faces, except those within this angle of a direction
/// that was tried already [rad].
inline constexpr double same_cut_direction = 1e-3;

}  // namespace tumble::tolerances
