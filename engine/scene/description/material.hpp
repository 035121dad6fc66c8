#pragma once
#include "engine/dynamics/bodies/body.hpp"
#include "engine/scene/description/values.hpp"

namespace tumble {

/// Surface and density. Members that are not given come from the material named by `like`, or from
/// the defaults of Material. In a file a bare string stands for {"like": string}.
struct MaterialDescription {
  std::string like;
  std::optional<double> friction;                              ///< [-]
  std::optional<double> restitution;                           ///< [-]
  std::optional<double> density;                               ///< [kg/m3]
  std::optional<Vec3> surface_velocity;                        ///< body axes [m/s]
  std::optional<double> rolling_friction, torsional_friction;  ///< [m]

  static constexpr std::string_view shorthand_key = "like";
  static constexpr std::string_view schema_name = "material";
  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.field(d.like, {.name = "like", .doc = "name of the material that this one starts from"});
    v.field(d.friction, {.name = "friction",
                         .min = 0,
                         .max = 100,
                         .doc = "Coulomb coefficient; of two bodies sqrt(a b) counts"});
    v.field(d.restitution,
            {.name = "restitution", .min = 0, .max = 1, .doc = "of two bodies the larger counts"});
    v.field(d.density, {.name = "density",
                        .unit = "kg/m3",
                        .min = 0,
                        .max = 1e6,
                        .exclusive_min = true,
                        .doc = "mass per volume"});
    v.field(d.surface_velocity, {.name = "surface_velocity",
                                 .unit = "m/s",
                                 .min = -1e4,
                                 .max = 1e4,
                                 .doc = "velocity of the surface in body axes (conveyor belts)"});
    v.field(d.rolling_friction,
            {.name = "rolling_friction",
             .unit = "m",
             .min = 0,
             .max = 1e3,
             .doc = "where bodies touch in a point or along a line, the torque against rolling is "
                    "at most this lever arm times the normal force; of two bodies sqrt(a b) "
                    "counts. Not given: 0.0005, and under the event stepper 0 if neither of the "
                    "two gives one"});
    v.field(d.torsional_friction,
            {.name = "torsional_friction",
             .unit = "m",
             .min = 0,
             .max = 1e3,
             .doc = "where bodies touch in a point or along a line, the torque against spinning "
                    "about the normal is at most this lever arm times the normal force; of two "
                    "bodies sqrt(a b) counts. Not given: 0.0005, and under the event stepper 0 if "
                    "neither of the two gives one"});
  }
};

/// Materials that every scene knows by name; a scene may define its own of the same name.
const std::vector<std::pair<std::string_view, Material>>& built_in_materials();

/// The material with its `like` chain followed. Errors: unknown name (with what is near), cycle.
Result<Material> resolve_material(const MaterialDescription& description,
                                  const NamedList<MaterialDescription>& materials);

}  // namespace tumble
