#pragma once
#include "engine/collision/shapes/triangle_mesh.hpp"
#include "engine/geometry/distance_field/distance_field.hpp"

namespace tumble {

/// A closed mesh that touches others by its signed distance field, with the field's error;
/// everything else (mass, rays, nearest points, times of contact) is that of the mesh itself.
class DistanceFieldShape final : public TriangleMeshShape {
 public:
  static Result<std::shared_ptr<const Shape>> make(const ShapeDef& def);

  const DistanceField* field() const override { return field_.get(); }
  std::string words() const override;

 private:
  DistanceFieldShape(const ShapeDef& def, std::shared_ptr<const DistanceField> field)
      : TriangleMeshShape(def), field_(std::move(field)) {}
  std::shared_ptr<const DistanceField> field_;
};

}  // namespace tumble
