#pragma once

/// The numbers of this room that no setting gives: unit, reason, and source where there is one.
/// None of them changes a bit of what is summed.
namespace tumble::tolerances {

/// Skin of lists that are made first [cut-offs]: LAMMPS' for liquids, 0.3 of 2.5.
inline constexpr double first_skin = 0.12;
/// Skins are no less and no greater [cut-offs]: below, looking whether lists are right costs more
/// than it saves; above, lists hold three times what is in reach.
inline constexpr double least_skin = 0.01;
inline constexpr double largest_skin = 0.45;
/// What making lists costs [sums over lists]: an estimate for a liquid, of weight for time alone.
inline constexpr double price_of_lists = 2;

}  // namespace tumble::tolerances
