#include "engine/collision/shape.hpp"
#include "viewer/render/extract.hpp"

namespace tumble {
namespace {

/// Draws in the frame of one shape.
class ShapeWires final : public DebugDraw {
 public:
  ShapeWires(const Pose& pose, RenderScene& out) : pose_(pose), out_(out) {}
  void line(const Vec3& a, const Vec3& b, const Vec4f& colour) override {
    out_.lines.push_back({.a = pose_.point(a).cast<float>(),
                          .b = pose_.point(b).cast<float>(),
                          .colour = colour,
                          .width = 1});
  }
  void point(const Vec3&, const Vec4f&, float) override {}
  void text(const Vec3&, const Vec4f&, std::string_view) override {}

 private:
  const Pose& pose_;
  RenderScene& out_;
};

}  // namespace

void add_wires(const Shape& shape, const Pose& pose, const Vec4f& colour, RenderScene& out) {
  ShapeWires wires(pose, out);
  shape.outline(wires, colour);
}

}  // namespace tumble
