#include "engine/collision/shapes/distance_field.hpp"

#include "engine/geometry/hierarchy/aabb_tree.hpp"

#include <array>

#include <fmt/format.h>

namespace tumble {

Result<std::shared_ptr<const Shape>> DistanceFieldShape::make(const ShapeDef& def) {
  if (Status s = check(def); !s) return s.error();
  std::shared_ptr<const DistanceField> field = def.field;
  if (!field) {
    DistanceFieldOptions options;
    options.cell = def.cell;
    auto made = make_distance_field(AabbTree(def.mesh), options);
    if (!made) return made.error();
    field = std::make_shared<const DistanceField>(*std::move(made));
  }
  std::shared_ptr<DistanceFieldShape> shape(new DistanceFieldShape(def, std::move(field)));
  shape->surface();  // here, where loading is expected to take time
  return std::shared_ptr<const Shape>(shape);
}

std::string DistanceFieldShape::words() const {
  return fmt::format("distance field, cells of {:.3g} m, right to {:.2g} m", field_->cell(),
                     field_->report().band_error);
}

namespace {

constexpr std::array field_parameters{
    ShapeParameter{{.name = "cell",
                    .unit = "m",
                    .min = 0,
                    .max = 1e6,
                    .doc = "side of a cell of the field; 0: a 64th of the mesh's longest side"},
                   &ShapeDef::cell}};

}  // namespace

extern const ShapeEntry distance_field_entry;
constinit const ShapeEntry distance_field_entry{"distance_field",         ShapeType::distance_field,
                                                ShapeFamily::mesh,        true,
                                                DistanceFieldShape::make, field_parameters};

}  // namespace tumble
