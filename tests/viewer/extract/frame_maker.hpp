#pragma once
#include "engine/collision/shape.hpp"
#include "viewer/render/extract.hpp"

#include <doctest/doctest.h>

namespace tumble::test {

inline std::shared_ptr<const Shape> shape(ShapeType type,
                                          std::shared_ptr<const TriangleMesh> mesh = {}) {
  ShapeDef def;
  def.type = type;
  def.mesh = std::move(mesh);
  auto made = make_shape(def);
  REQUIRE(made.ok());
  return *made;
}

inline std::shared_ptr<const TriangleMesh> tetrahedron() {
  auto mesh = std::make_shared<TriangleMesh>();
  mesh->vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  mesh->triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  return mesh;
}

/// A frame that the test fills body by body.
struct FrameMaker {
  std::vector<BodyInfo> infos;
  std::vector<BodyFrame> bodies;
  std::vector<ContactFrame> contacts;
  Frame frame;

  size_t add(const std::shared_ptr<const Shape>& part, const Vec3& x,
             BodyType type = BodyType::dynamic) {
    BodyFrame body;
    body.id = {uint32_t(bodies.size()), 1};
    body.pose.x = x;
    BodyInfo info;
    info.id = body.id;
    info.type = type;
    info.mass = 1;
    BodyShape placed;
    placed.shape = part;
    info.shapes.push_back(placed);
    bodies.push_back(body);
    infos.push_back(info);
    return bodies.size() - 1;
  }

  Frame make() {
    Frame f = frame;
    f.gravity = Vec3(0, -9.81, 0);
    f.usual_gravity = 9.81;
    f.infos = std::make_shared<std::vector<BodyInfo>>(infos);
    f.contacts = std::make_shared<std::vector<ContactFrame>>(contacts);
    f.chunks.clear();
    for (size_t i = 0; i < bodies.size(); i += Frame::chunk_size) {
      auto chunk = std::make_shared<Frame::BodyChunk>();
      for (size_t k = 0; k < Frame::chunk_size && i + k < bodies.size(); ++k)
        (*chunk)[k] = bodies[i + k];
      f.chunks.push_back(chunk);
    }
    return f;
  }
};

inline RenderScene extracted(const Frame& from, const Frame& to, double s,
                             ExtractOptions options = {}) {
  ShapeMeshes meshes;
  RenderScene out;
  extract(from, to, s, options, meshes, out);
  return out;
}

inline RenderScene extracted(const Frame& frame, const Overlays& overlays) {
  ExtractOptions options;
  options.overlays = overlays;
  return extracted(frame, frame, 1, options);
}

}  // namespace tumble::test
