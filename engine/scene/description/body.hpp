#pragma once
#include "engine/scene/description/repetition.hpp"
#include "engine/scene/description/shape.hpp"

namespace tumble {

template <>
struct EnumNames<BodyType> {
  static constexpr std::array<std::pair<std::string_view, BodyType>, 3> values = {
      {{"static", BodyType::fixed},
       {"kinematic", BodyType::kinematic},
       {"dynamic", BodyType::dynamic}}};
};

/// The look of a body, except its colour.
struct LookDescription {
  double roughness = 0.6;
  double metallic = 0;
  double pattern = 0;
  double opacity = 1;
  bool visible = true;
  std::string label;
  std::optional<std::string> volumes;
  int volumes_level = 3;
  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.field(d.roughness, {.name = "roughness", .min = 0, .max = 1, .doc = "0 mirror, 1 matte"});
    v.field(d.metallic, {.name = "metallic", .min = 0, .max = 1, .doc = "1 for bare metal"});
    v.field(d.pattern, {.name = "pattern",
                        .min = 0,
                        .max = 1,
                        .doc = "strength of the two-tone pattern that makes rotation visible"});
    v.field(
        d.opacity,
        {.name = "opacity",
         .min = 0,
         .max = 1,
         .doc = "below 1 what is behind is seen through it, as through glass; it casts no shadow"});
    v.field(d.visible, {.name = "visible", .doc = "whether it is drawn"});
    v.field(d.label, {.name = "label", .doc = "text above it"});
    v.field(d.volumes, {.name = "volumes",
                        .doc = "kind of hierarchy whose volumes are drawn around its meshes"});
    v.field(d.volumes_level, {.name = "volumes_level",
                              .min = 0,
                              .max = 100,
                              .doc = "level of that hierarchy, 0 for the root"});
  }
};

/// Values that differ in one copy of a repeated body.
struct CopyDescription {
  bool present = true;
  std::optional<BodyType> type;
  std::optional<Vec3> position;          ///< world [m]
  std::optional<Vec3> euler_deg;         ///< world [deg]
  std::optional<Vec3> velocity;          ///< [m/s]
  std::optional<Vec3> angular_velocity;  ///< [rad/s]
  std::optional<double> mass;            ///< [kg]
  std::optional<double> density;         ///< [kg/m3]
  std::optional<double> gravity_scale;
  std::optional<double> fluid_friction;
  std::optional<bool> starts_asleep;
  std::optional<MaterialDescription> material;
  std::optional<Colour> colour;

  static constexpr std::string_view schema_name = "copy";
  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.field(d.present, {.name = "present", .doc = "false leaves this copy out"});
    v.field(d.type, {.name = "type", .doc = "how it moves"});
    v.field(d.position, {.name = "position",
                         .unit = "m",
                         .min = -1e7,
                         .max = 1e7,
                         .doc = "in the world, instead of the repeated one"});
    v.field(d.euler_deg, {.name = "euler_deg",
                          .unit = "deg",
                          .min = -1e6,
                          .max = 1e6,
                          .doc = "in the world, instead of the repeated orientation"});
    v.field(d.velocity, {.name = "velocity",
                         .unit = "m/s",
                         .min = -1e6,
                         .max = 1e6,
                         .doc = "of the centre of mass"});
    v.field(d.angular_velocity, {.name = "angular_velocity",
                                 .unit = "rad/s",
                                 .min = -1e6,
                                 .max = 1e6,
                                 .doc = "world axes"});
    v.field(d.mass, {.name = "mass",
                     .unit = "kg",
                     .min = 0,
                     .max = 1e15,
                     .exclusive_min = true,
                     .doc = "total mass"});
    v.field(d.density, {.name = "density",
                        .unit = "kg/m3",
                        .min = 0,
                        .max = 1e6,
                        .exclusive_min = true,
                        .doc = "of all shapes"});
    v.field(d.gravity_scale,
            {.name = "gravity_scale", .min = -1e6, .max = 1e6, .doc = "factor of gravity"});
    v.field(d.fluid_friction, {.name = "fluid_friction",
                               .min = 0,
                               .max = 1,
                               .doc = "share of a fluid's wall_friction that it has"});
    v.field(d.starts_asleep, {.name = "starts_asleep", .doc = "rests until touched"});
    v.object(d.material, {.name = "material", .doc = "surface and density"});
    v.field(d.colour, {.name = "colour", .doc = "colour"});
  }
};

/// The prescribed course of a kinematic body, relative to its initial pose.
struct BodyCourseDescription {
  std::optional<Varying> x, y, z, angle_deg;
  Vec3 axis{0, 0, 1};

  static constexpr std::string_view schema_name = "body_course";
  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.field(d.x, {.name = "x",
                  .unit = "m",
                  .min = -1e7,
                  .max = 1e7,
                  .doc = "displacement along the world's x axis: an expression in t, a table of "
                         "[time, value] or a number"});
    v.field(d.y, {.name = "y", .unit = "m", .min = -1e7, .max = 1e7, .doc = "likewise along y"});
    v.field(d.z, {.name = "z", .unit = "m", .min = -1e7, .max = 1e7, .doc = "likewise along z"});
    v.field(d.angle_deg, {.name = "angle_deg",
                          .unit = "deg",
                          .min = -1e9,
                          .max = 1e9,
                          .doc = "likewise turn about the axis"});
    v.field(d.axis, {.name = "axis",
                     .min = -1e9,
                     .max = 1e9,
                     .doc = "world axes, through the origin of the body's frame"});
  }
  static void check(const BodyCourseDescription& d, Complaints& complaints) {
    if (!(d.axis.squaredNorm() > 0)) complaints.add("axis", "an axis of zeros has no direction");
    if (!d.x && !d.y && !d.z && !d.angle_deg)
      complaints.add("", "needs at least one of x, y, z, angle_deg");
  }
};

/// A rigid body, or many copies of one.
struct BodyDescription {
  BodyType type = BodyType::dynamic;
  Placement placement;
  std::optional<ShapeDescription> shape;
  std::vector<ShapeDescription> shapes;
  std::vector<DrawnDescription> drawn;
  Vec3 velocity = Vec3::Zero();              ///< [m/s]
  Vec3 angular_velocity = Vec3::Zero();      ///< [rad/s]
  std::optional<Vec3> angular_velocity_deg;  ///< [deg/s]
  std::optional<double> mass;                ///< [kg]
  std::optional<Vec3> inertia;               ///< about the centre, body axes [kg m2]
  std::optional<Vec3> products;              ///< Ixy, Ixz, Iyz [kg m2]
  std::optional<Vec3> centre;                ///< of mass, body frame [m]
  std::optional<double> density;             ///< [kg/m3]
  std::optional<MaterialDescription> material;
  std::optional<Colour> colour;
  LookDescription look;
  std::optional<BodyCourseDescription> course;
  int group = 0;
  double gravity_scale = 1;
  double fluid_friction = 1;
  bool can_sleep = true;
  bool precise = false;
  bool starts_asleep = false;
  bool hull_mass = false;
  bool present = true;
  std::vector<RepetitionDescription> repeat;
  std::vector<Colour> colours;
  NamedList<CopyDescription> copies;

  static constexpr std::string_view schema_name = "body";
  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.field(d.type, {.name = "type", .doc = "how it moves"});
    v.part(d.placement);
    v.object(d.shape, {.name = "shape", .doc = "its shape, when it has one"});
    v.list(d.shapes, {.name = "shapes", .doc = "its shapes, when it has several"});
    v.list(d.drawn, {.name = "drawn", .doc = "what is drawn in place of its shapes"});
    v.field(d.velocity, {.name = "velocity",
                         .unit = "m/s",
                         .min = -1e6,
                         .max = 1e6,
                         .doc = "of the centre of mass"});
    v.field(d.angular_velocity, {.name = "angular_velocity",
                                 .unit = "rad/s",
                                 .min = -1e6,
                                 .max = 1e6,
                                 .doc = "world axes"});
    v.field(d.angular_velocity_deg, {.name = "angular_velocity_deg",
                                     .unit = "deg/s",
                                     .min = -1e8,
                                     .max = 1e8,
                                     .doc = "instead of angular_velocity"});
    v.object(d.course,
             {.name = "course", .doc = "of a kinematic body: its way over time, from its place"});
    v.field(d.mass, {.name = "mass",
                     .unit = "kg",
                     .min = 0,
                     .max = 1e15,
                     .exclusive_min = true,
                     .doc = "total mass, instead of density times volume"});
    v.field(d.inertia, {.name = "inertia",
                        .unit = "kg m2",
                        .min = 0,
                        .max = 1e30,
                        .exclusive_min = true,
                        .doc = "moments about the centre of mass along the body's axes, instead of "
                               "what its shapes give"});
    v.field(d.products, {.name = "products_of_inertia",
                         .unit = "kg m2",
                         .min = -1e30,
                         .max = 1e30,
                         .doc = "with inertia: the elements Ixy, Ixz, Iyz of its tensor"});
    v.field(d.centre, {.name = "centre_of_mass",
                       .unit = "m",
                       .min = -1e7,
                       .max = 1e7,
                       .doc = "with inertia: in the body's frame, instead of what its shapes "
                              "give; where there are none the origin"});
    v.field(d.group, {.name = "group",
                      .min = 0,
                      .max = 2147483647,
                      .doc = "bodies of one group do not collide with each other; 0: of none"});
    v.field(d.density, {.name = "density",
                        .unit = "kg/m3",
                        .min = 0,
                        .max = 1e6,
                        .exclusive_min = true,
                        .doc = "of all shapes, instead of the materials'"});
    v.object(d.material, {.name = "material", .doc = "name of a material, or one made here"});
    v.field(d.colour, {.name = "colour", .doc = "colour"});
    v.object(d.look, {.name = "look", .doc = "further looks"});
    v.field(d.gravity_scale,
            {.name = "gravity_scale", .min = -1e6, .max = 1e6, .doc = "factor of gravity"});
    v.field(d.fluid_friction, {.name = "fluid_friction",
                               .min = 0,
                               .max = 1,
                               .doc = "share of a fluid's wall_friction that it has"});
    v.field(d.can_sleep, {.name = "can_sleep", .doc = "may come to rest and cost nothing"});
    v.field(d.precise, {.name = "precise",
                        .doc = "the realtime stepper solves the group of touching or jointed "
                               "bodies that this one is in precisely: more sub-steps, double "
                               "precision"});
    v.field(d.starts_asleep, {.name = "starts_asleep", .doc = "rests until touched"});
    v.field(d.hull_mass,
            {.name = "hull_mass", .doc = "mass and inertia of an open mesh from its convex hull"});
    v.field(d.present,
            {.name = "present", .doc = "false: it is there for emitters to make copies of only"});
    v.list(d.repeat, {.name = "repeat", .doc = "makes copies; several nest, the first outermost"});
    v.field(d.colours, {.name = "colours", .doc = "the copies take these in turn"});
    v.map(d.copies, {.name = "copies", .doc = "what differs in single copies, by number"});
  }
  static void check(const BodyDescription& d, Complaints& complaints);
};

}  // namespace tumble
