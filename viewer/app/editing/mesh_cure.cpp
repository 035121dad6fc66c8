#include "viewer/app/editing/mesh_cure.hpp"

#include "viewer/interact/key_map.hpp"

#include <utility>

#include <fmt/format.h>

namespace tumble {

Error with_cure_in_window(Error fault) {
  fault.cure = fmt::format(
      "choose its convex hull in the list instead; or, once it is in the scene, give it a closed "
      "surface: {} shows the scene, there meshes, its name, add, wrap",
      shortcut_of(Action::toggle_description));
  return fault;
}

}  // namespace tumble
