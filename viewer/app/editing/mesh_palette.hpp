#pragma once
#include "engine/core/stop.hpp"
#include "engine/scene/build/mesh_parts.hpp"
#include "viewer/ui/build_choice.hpp"

#include <future>
#include <memory>
#include <optional>
#include <string>

namespace tumble {

/// A mesh ready to be placed.
struct PaletteMesh {
  NewMesh chosen;
  double scale = 1;  ///< metres per unit of the file
  std::shared_ptr<const TriangleMesh> mesh;
  MeshParts parts;
};

/// Reads the mesh file of the palette and computes its collision representation on a thread of its
/// own.
class MeshPalette {
 public:
  MeshPalette() = default;
  ~MeshPalette() { stop_.request(); }
  MeshPalette(const MeshPalette&) = delete;
  MeshPalette& operator=(const MeshPalette&) = delete;

  /// To be called for every picture. Another mesh is begun once the one under way has been
  /// cancelled. `view_size` [m]: a mesh far larger or smaller is scaled by a power of ten, since
  /// files have various units. With `beside` false it is read at once on first request.
  void choose(const NewMesh& mesh, double view_size, bool beside);
  /// Null: not chosen, not ready, or not possible.
  std::shared_ptr<const PaletteMesh> ready();
  bool reading() const { return reading_.valid(); }
  /// Why there is no mesh; "": there is, or will be.
  const std::string& fault() const { return fault_; }

 private:
  using Read = Result<std::shared_ptr<const PaletteMesh>>;

  std::optional<NewMesh> wanted_;
  StopFlag stop_;  ///< declared before the future, whose thread uses it until it ends
  std::future<Read> reading_;
  std::shared_ptr<const PaletteMesh> ready_;
  std::string fault_;
};

}  // namespace tumble
