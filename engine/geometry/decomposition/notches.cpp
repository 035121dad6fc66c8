#include "engine/geometry/decomposition/notches.hpp"

#include <algorithm>

namespace tumble {

std::vector<Notch> find_notches(const ExactSpace& space, const SolidPiece& piece,
                                double tolerance) {
  // The greatest height of a face above the plane of another one.
  const auto height = [&](const SolidPiece::Face& face, const SolidPiece::Face& over) {
    double out = 0;
    for (const uint32_t s : face.sides)
      out = std::max(out, space.plane(over.plane).distance(space.at(piece.sides[s].start)));
    return out;
  };
  std::vector<Notch> out;
  for (uint32_t s = 0; s < piece.sides.size(); ++s) {
    const SolidPiece::Side& side = piece.sides[s];
    if (side.edge == no_index || side.mate < s) continue;
    const SolidPiece::Face &own = piece.faces[side.face],
                           &other = piece.faces[piece.sides[side.mate].face];
    if (tolerance == 0 || (height(own, other) > tolerance && height(other, own) > tolerance))
      out.push_back({side.edge, {side.start, side.end}});
  }
  return out;
}

}  // namespace tumble
