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
  int level = 3;          ///< below the root; the leaves if the hierarchy is less deep
};

/// The mesh on a ground with a grid, or with the bounding volumes of a level and the triangles of
/// each in its colour; open edges are red, edges with more than two triangles violet; with a
/// caption. The mesh is scaled to a standard size, so that any size can be drawn.
RenderScene mesh_scene(const MeshFacts& facts, const MeshPicture& picture);

enum class PictureFailure : uint8_t { no_renderer, cannot_write };
struct PictureError {
  PictureFailure kind;
  Error error;
};
/// Draws it into the file; empty on success.
std::optional<PictureError> draw_mesh_picture(const MeshFacts& facts, const MeshPicture& picture,
                                              const LogSink& log);

}  // namespace tumble
