#pragma once
#include "engine/core/stop.hpp"
#include "engine/scene/build/mesh_parts.hpp"
#include "viewer/ui/build_choice.hpp"

#include <future>
#include <memory>
#include <optional>
#include <string>

namespace tumble {

/// A mesh file that is ready to be placed.
struct PaletteMesh {
  NewMesh chosen;
  double scale = 1;  ///< metres per unit of the file
  std::shared_ptr<const TriangleMesh> mesh;
  MeshParts parts;
};

/// Reads the mesh file that the palette has, and makes what it collides as, on a thread of its own.
class MeshPalette {
 public:
  MeshPalette() = default;
  ~MeshPalette() { stop_.request(); }
  MeshPalette(const MeshPalette&) = delete;
  MeshPalette& operator=(const MeshPalette&) = delete;

  /// To be called in every picture: another mesh is begun once the one under way has been given up.
  /// `view_size`: a mesh that is far larger or smaller is scaled by a power of ten, as files have
  /// units of their own [m]. `beside` false: read when it is first asked for.
  void choose(const NewMesh& mesh, double view_size, bool beside);
  /// Null: not chosen, not ready, or not possible.
  std::shared_ptr<const PaletteMesh> ready();
  bool reading() const { return reading_.valid(); }
  /// Why there is none; "": there is, or will be.
  const std::string& fault() const { return fault_; }

 private:
  using Read = Result<std::shared_ptr<const PaletteMesh>>;

  std::optional<NewMesh> wanted_;
  StopFlag stop_;  ///< before the future, whose thread looks at it until it is gone
  std::future<Read> reading_;
  std::shared_ptr<const PaletteMesh> ready_;
  std::string fault_;
};

}  // namespace tumble
