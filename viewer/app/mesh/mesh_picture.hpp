#pragma once
#include "engine/core/log.hpp"
#include "viewer/app/mesh/mesh_facts.hpp"
#include "viewer/render/render_scene.hpp"

#include <filesystem>

namespace tumble {

struct MeshPicture {
  std::filesystem::path file;  ///< PNG, replaced when it exists
  int width = 1280, height = 800;
  std::string context = "auto";
  std::string hierarchy;  ///< kind; "": none
  int level = 3;          ///< below the root; the leaves when the tree is not so deep
};

/// The mesh on a ground with a grid, or with the volumes of a level and the triangles of each in
/// its colour; open edges in red, edges with more than two triangles in violet, a caption. Shown
/// in units of its own size, so that nothing is too small or too large.
RenderScene mesh_scene(const MeshFacts& facts, const MeshPicture& picture);

enum class PictureFailure : uint8_t { no_renderer, cannot_write };
struct PictureError {
  PictureFailure kind;
  Error error;
};
/// Draws it into the file; nothing when that succeeded.
std::optional<PictureError> draw_mesh_picture(const MeshFacts& facts, const MeshPicture& picture,
                                              const LogSink& log);

}  // namespace tumble
