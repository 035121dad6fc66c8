#include "viewer/app/mesh/mesh_picture.hpp"

#include "viewer/app/drawing.hpp"
#include "viewer/capture/png.hpp"
#include "viewer/render/builtin_meshes.hpp"
#include "viewer/render/hierarchy_views.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace tumble {
namespace {

const Vec4f open_colour(1.0f, 0.06f, 0.04f, 1), crowded_colour(0.75f, 0.1f, 1.0f, 1);

/// Maps the mesh's coordinates to those of the picture, in which the mesh is two units across.
struct MeshPlacing {
  Vec3 centre;
  double scale;
  Vec3 point(const Vec3& x) const { return scale * (x - centre); }
};

MeshPlacing placing_of(const MeshFacts& f) {
  const double size = f.box.extent().norm();
  return {f.box.centre(), size > 0 ? 2 / size : 1};
}

TriangleMesh placed_mesh(const MeshFacts& f) {
  const MeshPlacing at = placing_of(f);
  TriangleMesh out = *f.mesh;
  for (Vec3& v : out.vertices) v = at.point(v);
  return out;
}

void add_plain(const TriangleMesh& mesh, const Paint& paint, RenderScene& out) {
  std::vector<uint32_t> indices;
  indices.reserve(3 * mesh.triangles.size());
  for (const Triangle& t : mesh.triangles) indices.insert(indices.end(), t.begin(), t.end());
  if (MeshRef drawn = make_mesh_from_triangles(mesh.vertices, indices))
    out.instances.push_back(mesh_instance(drawn, {}, Vec3::Ones(), paint));
}

void add_fault_edges(const MeshFacts& f, const TriangleMesh& mesh, RenderScene& out) {
  for (const MeshEdge& e : f.topology.edges) {
    if (e.face_count == 2) continue;
    out.lines.push_back({.a = mesh.vertices[e.vertices[0]].cast<float>(),
                         .b = mesh.vertices[e.vertices[1]].cast<float>(),
                         .colour = e.face_count == 1 ? open_colour : crowded_colour,
                         .width = 3});
  }
}

/// Adds the volumes, with the mesh in pieces by volume. Returns a line of text about them.
std::string add_volumes(std::shared_ptr<const TriangleMesh> mesh, const MeshPicture& picture,
                        const Paint& paint, Aabb& shown, RenderScene& out) {
  const auto kind = std::find_if(all_hierarchies().begin(), all_hierarchies().end(),
                                 [&](const auto& k) { return k.name == picture.hierarchy; });
  if (kind == all_hierarchies().end()) return {};
  const auto tree = kind->build(mesh);
  const HierarchyView view = make_hierarchy_view(*tree, picture.level, true);
  for (const HierarchyView::Wire& w : view.wires) {
    out.lines.push_back({.a = w.a.cast<float>(), .b = w.b.cast<float>(), .colour = w.colour});
    shown.include(w.a);
    shown.include(w.b);
  }
  if (view.pieces.empty()) add_plain(*mesh, paint, out);
  for (const HierarchyView::Piece& piece : view.pieces) {
    Paint own = paint;
    own.colour = 0.45f * paint.colour + 0.55f * piece.colour;
    out.instances.push_back(mesh_instance(piece.mesh, {}, Vec3::Ones(), own));
  }
  const std::string level = picture.level >= tree->depth()
                                ? fmt::format("the leaves, level {}", tree->depth())
                                : fmt::format("level {} of {}", picture.level, tree->depth());
  return fmt::format("{}, {}: {} {}", picture.hierarchy, level, view.volumes,
                     view.volumes == 1 ? "volume" : "volumes");
}

void add_caption(const std::string& text, float y, float size, RenderScene& out) {
  TextLabel label;
  label.text = text;
  label.in_world = false;
  label.x = Vec3f(18, y, 0);
  label.size = size;
  out.texts.push_back(label);
}

/// The nearest camera that leaves a margin around the bounds, and room for the caption.
Camera near_camera(const Aabb& shown, double aspect) {
  Camera camera = frame_bounds(shown, Vec3(0.62, 0.5, 1), 32, aspect);
  const auto fits = [&](const Camera& c) {
    for (int k = 0; k < 8; ++k) {
      const Vec3 corner(k & 1 ? shown.max.x() : shown.min.x(),
                        k & 2 ? shown.max.y() : shown.min.y(),
                        k & 4 ? shown.max.z() : shown.min.z());
      const Vec3 at = project(c, corner, aspect, 1);
      if (!(at.z() > 0 && at.x() > 0.06 * aspect && at.x() < 0.94 * aspect && at.y() > 0.1 &&
            at.y() < 0.94))
        return false;
    }
    return true;
  };
  for (int step = 0; step < 100; ++step) {
    Camera nearer = camera;
    nearer.eye = camera.target + 0.98 * (camera.eye - camera.target);
    if (!fits(nearer)) break;
    camera = nearer;
  }
  return camera;
}

/// The largest of 1, 2, 5 times a power of ten that is no more than x.
double round_length(double x) {
  const double power = std::pow(10.0, std::floor(std::log10(x)));
  return (x >= 5 * power ? 5 : x >= 2 * power ? 2 : 1) * power;
}

}  // namespace

RenderScene mesh_scene(const MeshFacts& f, const MeshPicture& picture) {
  RenderScene out;
  const auto mesh = std::make_shared<const TriangleMesh>(placed_mesh(f));
  Paint paint;
  paint.colour = linear_from_srgb(0xA9B0B8);
  paint.roughness = 0.5f;
  Aabb shown = bounds(*mesh);
  std::string volumes;
  if (picture.hierarchy.empty()) {
    add_plain(*mesh, paint, out);
  } else {
    volumes = add_volumes(mesh, picture, paint, shown, out);
  }
  add_fault_edges(f, *mesh, out);

  out.quality = Quality::high;
  out.sun.to_sun = Vec3(0.45, 0.8, 0.5);
  out.sky.zenith = linear_from_srgb(0x7E93A6);
  out.sky.horizon = linear_from_srgb(0xE4E6E6);
  out.haze = 0;
  out.ground.height = shown.min.y();
  out.ground.colour = linear_from_srgb(0xB4B6B6);
  out.ground.grid_colour = linear_from_srgb(0x9A9DA0);
  const double scale = placing_of(f).scale, square = round_length(0.5 / scale);
  out.ground.grid_spacing = square * scale;
  out.camera = near_camera(shown, double(picture.width) / picture.height);

  const float text = float(std::clamp(picture.height / 45.0, 13.0, 40.0));
  const std::string name = std::filesystem::path(f.file).filename().string();
  add_caption(name + (volumes.empty() ? "" : "   " + volumes), 0.8f * text, text, out);
  const Vec3 size = f.box.extent();
  add_caption(fmt::format("{} triangles   {:.4g} x {:.4g} x {:.4g} m   squares of {:.4g} m{}{}",
                          f.mesh->triangles.size(), size.x(), size.y(), size.z(), square,
                          f.topology.open_edges ? "   open edges red" : "",
                          f.topology.non_manifold_edges ? "   non-manifold edges violet" : ""),
              2.1f * text, 0.8f * text, out);
  return out;
}

std::optional<PictureError> draw_mesh_picture(const MeshFacts& f, const MeshPicture& picture,
                                              const LogSink& log) {
  auto drawing = make_drawing(picture.context, log);
  if (!drawing) return PictureError{PictureFailure::no_renderer, drawing.error()};
  const auto drawn =
      drawing->renderer->render(mesh_scene(f, picture), picture.width, picture.height);
  if (!drawn) return PictureError{PictureFailure::no_renderer, drawn.error()};
  Image image;
  if (Status s = drawing->renderer->read_back(image); !s)
    return PictureError{PictureFailure::no_renderer, s.error()};
  if (Status s = write_png(picture.file, without_alpha(image)); !s)
    return PictureError{PictureFailure::cannot_write, s.error()};
  return {};
}

}  // namespace tumble
