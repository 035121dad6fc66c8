#include "tests/fuzz/random_scene.hpp"

#include "engine/collision/shape.hpp"
#include "engine/core/random.hpp"
#include "engine/math/det/det.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace tumble {
namespace {

using Json = nlohmann::ordered_json;
using Vector = std::array<double, 3>;

/// A shipped mesh and the radius of the sphere about the middle of its bounds that holds it, in
/// units of its file. A list of its own: a mesh more in the folder must not change the scenes.
struct KnownMesh {
  const char* file;
  double radius;
};
constexpr KnownMesh known_meshes[] = {
    {"gear.obj", 0.385},      {"l_bracket.obj", 0.307}, {"washer.obj", 0.185},
    {"hex_nut.obj", 0.160},   {"hex_bolt.obj", 0.241},  {"star_prism.obj", 0.345},
    {"torus_link.obj", 0.35}, {"t_part.obj", 0.181},    {"l_part.obj", 0.168},
    {"chain_link.obj", 0.36}, {"cup.obj", 0.246},       {"ring.obj", 0.372},
    {"i_beam.obj", 2.02},     {"rook.obj", 0.378},      {"stepped_shaft.obj", 0.224},
    {"vase.obj", 0.436},      {"arch_stone.off", 0.53}, {"trefoil_knot.obj", 0.48}};

const std::vector<std::string> broad_phases = {"brute_force", "uniform_grid", "multi_level_grid",
                                               "aabb_tree"};
const std::vector<std::string> hierarchies = {"aabb", "obb", "sphere", "convex_hull"};
const std::vector<std::string> narrow_phases = {"gjk", "v_clip"};
const std::vector<std::string> integrators = {
    "explicit_euler", "semi_implicit_euler", "implicit_euler", "rk2", "rk4", "rk45"};
const std::vector<std::string> impact_laws = {"reflections", "sequential", "simultaneous_newton",
                                              "simultaneous_poisson"};
const std::vector<std::string> contact_solvers = {"automatic", "dantzig", "baraff",
                                                  "lemke",     "pgs",     "cone_newton"};
const std::vector<std::string> friction_cones = {"circular", "pyramid"};
const std::vector<std::string> joint_kinds = {"spherical", "universal", "revolute", "cylindrical",
                                              "prismatic", "rigid",     "distance", "planar"};

double cube(double x) {
  return x * x * x;
}

/// Draws one scene, part after part.
class SceneMaker {
 public:
  SceneMaker(uint64_t seed, const std::string& stepper)
      : random_(seed, 24), shape_draws_(seed, 25), stepper_(stepper) {
    has_listed_shapes_ = shape_draws_.uniform() < 0.25;
    scene_["tumble_scene"] = 1;
    scene_["seed"] = seed;
    draw_scale();
    draw_settings();
  }

  RandomScene make() {
    draw_walls();
    const uint32_t bodies = 2 + random_.below(9);
    for (uint32_t i = 0; i < bodies; ++i) draw_body(i);
    if (chance(0.35)) draw_joints();
    if (chance(0.25)) draw_springs();
    if (chance(0.3)) draw_fields();
    if (chance(0.25)) draw_particles();
    return {scene_.dump(1), ordinary_, half_room(), radii_, explicit_euler_};
  }

 private:
  static constexpr int cells = 3;  ///< along each edge of the room

  bool chance(double p) { return random_.uniform() < p; }
  const std::string& one_of(const std::vector<std::string>& names) {
    return names[random_.below(uint32_t(names.size()))];
  }
  /// Between two powers of ten.
  double decade(double low, double high) { return det::pow(10, random_.uniform(low, high)); }
  Vector vector(double most) {
    Vector v;
    for (double& x : v) x = random_.uniform(-most, most);
    return v;
  }
  double half_room() const { return 0.5 * cells * cell_; }

  void draw_scale() {
    ordinary_ = chance(0.65);
    cell_ = ordinary_ ? decade(-1, 0) : decade(-2.5, 1.5);
    // A body may cross the whole room within a tick.
    speed_ = ordinary_ ? random_.uniform(0, 3) : cell_ * decade(-1, 2);
    smallest_ = cell_;
    // Cells in random order: each takes one body at most.
    order_.resize(cells * cells * cells);
    std::iota(order_.begin(), order_.end(), 0);
    for (size_t i = order_.size() - 1; i > 0; --i)
      std::swap(order_[i], order_[random_.below(uint32_t(i + 1))]);
  }

  void draw_settings() {
    Json& s = scene_["settings"];
    s = Json::object();
    defaults_ = chance(0.4);
    s["stepper"] = stepper_;
    constexpr double ticks[] = {30, 60, 60, 120, 240, 1000};
    tick_hz_ = defaults_ ? 60 : ticks[random_.below(6)];
    if (tick_hz_ != 60) s["tick_hz"] = tick_hz_;
    const double kind = random_.uniform();
    if (kind < 0.2)
      s["gravity"] = Vector{0, 0, 0};
    else if (kind < 0.35)
      s["gravity"] = vector(10);
    std::string integrator = "rk4";
    const bool draws_integrator = !defaults_ && chance(0.7);
    if (draws_integrator) integrator = one_of(integrators);
    if (!defaults_) {
      s["broad_phase"] = one_of(broad_phases);
      s["hierarchy"] = one_of(hierarchies);
      s["narrow_phase"] = one_of(narrow_phases);
      Json event = Json::object();
      if (draws_integrator) event["integrator"] = integrator;
      if (chance(0.6)) event["impulses"] = one_of(impact_laws);
      if (chance(0.6)) event["contact_solver"] = one_of(contact_solvers);
      if (chance(0.5)) event["friction_cone"] = one_of(friction_cones);
      s["event"] = event;
      Json realtime = Json::object();
      if (chance(0.3)) realtime["substeps"] = 1 + random_.below(12);
      if (chance(0.2)) realtime["sleeping"] = false;
      if (chance(0.2)) realtime["continuous"] = true;
      if (!realtime.empty()) s["realtime"] = realtime;
    }
    explicit_euler_ = stepper_ == "event" && integrator == "explicit_euler";
    const bool implicit = stepper_ == "realtime" || integrator == "implicit_euler";
    // Springs: fastest frequency times the tick.
    const double most = implicit && !ordinary_ ? 30 : explicit_euler_ ? 0.02 : 0.2;
    spring_rate_ = most * tick_hz_;
  }

  void draw_walls() {
    const double h = half_room(), t = std::max(0.25 * cell_, 0.25 * speed_ / tick_hz_);
    const Json material = {{"friction", one_number({0, 0.5, 0.8})},
                           {"restitution", one_number({0, 0.3, 0.9})}};
    const char* names[] = {"wxm", "wxp", "wym", "wyp", "wzm", "wzp"};
    for (size_t i = 0; i < 6; ++i) {
      Vector size{2 * (h + t), 2 * (h + t), 2 * (h + t)}, at{0, 0, 0};
      size[i / 2] = t;
      at[i / 2] = (i % 2 ? 1 : -1) * (h + 0.5 * t);
      scene_["bodies"][names[i]] = {{"type", "static"},
                                    {"shape", {{"type", "box"}, {"size", size}}},
                                    {"position", at},
                                    {"material", material}};
    }
  }

  double one_number(std::vector<double> values) {
    return values[random_.below(uint32_t(values.size()))];
  }

  /// Any convex shape of all_shapes() that is said by numbers, one that is added there included.
  Json draw_listed_shape(double r) {
    std::vector<const ShapeEntry*> entries;
    for (const ShapeEntry& e : all_shapes())
      if (e.family == ShapeFamily::convex && !e.parameters.empty()) entries.push_back(&e);
    const ShapeEntry& entry = *entries[shape_draws_.below(uint32_t(entries.size()))];
    ShapeDef def;
    def.type = entry.type;
    double bounding_radius = 0;
    while (bounding_radius == 0) {  // sizes may contradict each other
      for (const ShapeParameter& p : entry.parameters) {
        if (p.number) def.*p.number = shape_draws_.uniform(0.15, 1);
        for (int k = 0; p.vector && k < 3; ++k) (def.*p.vector)[k] = shape_draws_.uniform(0.15, 1);
      }
      if (const auto shape = make_shape(def)) bounding_radius = (*shape)->bounding_radius();
    }
    const double scale = r / std::max(1.0, bounding_radius);
    Json json = {{"type", entry.name}};
    for (const ShapeParameter& p : entry.parameters) {
      const double f = scale / p.factor;
      if (p.number) json[p.parameter.name] = f * (def.*p.number);
      if (!p.vector) continue;
      const Vec3 v = f * (def.*p.vector);
      json[p.parameter.name] = Vector{v.x(), v.y(), v.z()};
    }
    return json;
  }

  /// A shape within a sphere of radius r about its origin.
  Json draw_shape(double r, bool part) {
    if (has_listed_shapes_ && shape_draws_.uniform() < 0.5) return draw_listed_shape(r);
    const uint32_t kind = random_.below(part ? 7 : 9);
    const auto extent = [&] { return random_.uniform(0.15, 1) * r; };
    switch (kind) {
      case 0:
        return {{"type", "sphere"}, {"radius", extent()}};
      case 1: {
        const Vector half{extent(), extent(), extent()};
        const double scale =
            r / std::sqrt(half[0] * half[0] + half[1] * half[1] + half[2] * half[2]);
        const double f = 2 * std::min(1.0, scale);
        return {{"type", "box"}, {"size", Vector{f * half[0], f * half[1], f * half[2]}}};
      }
      case 2: {
        const double radius = random_.uniform(0.1, 0.6) * r;
        return {{"type", "capsule"}, {"radius", radius}, {"height", 2 * (r - radius)}};
      }
      case 3: {
        const double radius = random_.uniform(0.1, 0.9) * r;
        const double height = 2 * std::sqrt(r * r - radius * radius);
        return {{"type", "cylinder"}, {"radius", radius}, {"height", height}};
      }
      case 4:
        return {{"type", "ellipsoid"}, {"semi_axes", Vector{extent(), extent(), extent()}}};
      case 5: {
        Json points = Json::array();
        const uint32_t n = 5 + random_.below(15);
        for (uint32_t i = 0; i < n; ++i) points.push_back(vector(r / std::sqrt(3)));
        return {{"type", "convex_hull"}, {"points", points}};
      }
      case 6: {  // a cube: faces that lie flat
        const double a = 2 * r / std::sqrt(3);
        return {{"type", "box"}, {"size", Vector{a, a, a}}};
      }
      default: {
        const KnownMesh& mesh = known_meshes[random_.below(uint32_t(std::size(known_meshes)))];
        const std::string name = fmt::format("m{}", scene_["meshes"].size());
        scene_["meshes"][name] = {
            {"file", mesh.file}, {"scale", r / mesh.radius}, {"centre", true}};
        if (kind == 8 && chance(0.5)) scene_["meshes"][name]["mode"] = "convex_hull";
        return {{"type", "mesh"}, {"mesh", name}};
      }
    }
  }

  void draw_body(uint32_t number) {
    const int cell = order_[number];
    const Vector at = {(cell % 3 - 1) * cell_, (cell / 3 % 3 - 1) * cell_, (cell / 9 - 1) * cell_};
    const double r = random_.uniform(ordinary_ ? 0.2 : 0.05, 0.46) * cell_;
    smallest_ = std::min(smallest_, r);
    radii_.push_back(r);
    Json body;
    if (number > 1 && chance(0.05)) body["type"] = "kinematic";
    const bool kinematic = body.contains("type");
    body["position"] = at;
    body["euler_deg"] = vector(180);
    if (!kinematic) body["velocity"] = vector(speed_);
    body["angular_velocity"] = vector(ordinary_ ? 3 : std::min(100.0, speed_ / r));
    constexpr double densities[] = {100, 1000, 7800};
    body["material"] = {{"friction", one_number({0, 0.3, 0.5, 0.8, 2})},
                        {"restitution", one_number({0, 0.2, 0.5, 0.9})},
                        {"density", densities[random_.below(3)]}};
    if (chance(0.15)) {  // two shapes that overlap, as shapes of a body may
      Json shapes = Json::array();
      for (int side : {-1, 1}) {
        Json shape = draw_shape(0.6 * r, true);
        shape["position"] = Vector{0.4 * side * r, 0, 0};
        shapes.push_back(shape);
      }
      body["shapes"] = shapes;
    } else {
      body["shape"] = draw_shape(r, false);
    }
    const std::string name = fmt::format("b{}", number);
    scene_["bodies"][name] = body;
    if (!kinematic) names_.push_back(name);
  }

  /// Two names, or one and the world (an empty name).
  std::array<std::string, 2> draw_pair(double with_world) {
    const size_t a = random_.below(uint32_t(names_.size()));
    size_t b = random_.below(uint32_t(names_.size()));
    if (b == a) b = (a + 1) % names_.size();
    return {chance(with_world) ? std::string() : names_[a], names_[b]};
  }

  void draw_joints() {
    const uint32_t count = 1 + random_.below(3);
    for (uint32_t i = 0; i < count; ++i) {
      const auto [a, b] = draw_pair(0.3);
      const std::string kind = one_of(joint_kinds);
      Json joint = {{"kind", kind}, {"b", b}};
      if (!a.empty()) joint["a"] = a;
      joint["anchor"] = vector(a.empty() ? half_room() : cell_);
      if (kind == "distance") {
        joint["anchor_b"] = vector(0.3 * cell_);
      } else if (kind == "universal") {
        joint["axis"] = Vector{0, 0, 1};
        joint["axis_b"] = Vector{1, 0, 0};
      } else {
        joint["axis"] = Vector{1, random_.uniform(-1, 1), 0};
      }
      scene_["joints"][fmt::format("j{}", i)] = joint;
    }
  }

  /// Springs as stiff as the lightest body that there may be allows.
  void draw_springs() {
    const uint32_t count = 1 + random_.below(3);
    const double lightest = 10 * cube(smallest_);
    for (uint32_t i = 0; i < count; ++i) {
      const auto [a, b] = draw_pair(0.4);
      const double omega = random_.uniform(0.05, 1) * spring_rate_;
      Json spring = {{"type", "spring"},
                     {"stiffness", lightest * omega * omega},
                     {"damping", random_.uniform(0, 0.3) * lightest * omega}};
      if (a.empty())
        spring["a"] = {{"point", vector(half_room())}};
      else
        spring["a"] = {{"body", a}};
      spring["b"] = {{"body", b}, {"point", vector(0.2 * smallest_)}};
      scene_["forces"][fmt::format("s{}", i)] = spring;
    }
  }

  void draw_fields() {
    const uint32_t count = 1 + random_.below(2);
    for (uint32_t i = 0; i < count; ++i) {
      Json field;
      const double flow = std::min(10.0, 3 * cell_ * random_.uniform(0.1, 3));  // [m/s]
      const double pull = 10 / cell_ * random_.uniform(0, 0.5);                 // [1/s2]
      switch (random_.below(8)) {
        case 0:
          field = {{"type", "linear_drag"}, {"rate", random_.uniform(0, 2)}, {"angular_rate", 0.5}};
          break;
        case 1:
          field = {{"type", "quadratic_drag"},
                   {"fluid_density", 1.2},
                   {"coefficient", 0.5},
                   {"wind", vector(flow)}};
          break;
        case 2:
          field = {{"type", "point_gravity"},
                   {"centre", vector(cell_)},
                   {"mu", pull * cube(cell_)},
                   {"softening", 0.5 * cell_}};
          break;
        case 3:
        case 4:
          field = {{"type", chance(0.5) ? "attractor" : "repulsor"},
                   {"centre", vector(cell_)},
                   {"strength", pull},
                   {"radius", 2 * cell_}};
          break;
        case 5:
          field = {{"type", "vortex"},           {"centre", vector(cell_)},
                   {"axis", Vector{0, 1, 0}},    {"circulation", flow * cell_},
                   {"core_radius", 0.3 * cell_}, {"rate", 0.5}};
          break;
        case 6:
          field = {{"type", "wind"}, {"velocity", vector(flow)}, {"gusts", 0.5}, {"rate", 0.5}};
          break;
        default:
          field = {{"type", "turbulence"}, {"speed", flow}, {"size", cell_}, {"octaves", 3},
                   {"period", 1.0},        {"rate", 0.5},   {"seed", 2}};
      }
      scene_["forces"][fmt::format("f{}", i)] = field;
    }
  }

  void draw_particles() {
    const int cell = order_[order_.size() - 1 - random_.below(10)];  // without a body
    const Vector at = {(cell % 3 - 1) * cell_, (cell / 3 % 3 - 1) * cell_, (cell / 9 - 1) * cell_};
    const double radius = 0.01 * cell_, mass = 1000 * cube(radius);
    const int count = 5 + int(random_.below(30));
    Json p = {{"mass", mass}, {"radius", radius}, {"velocity", vector(0.5 * speed_)}};
    if (chance(0.2)) p["fast"] = true;
    const double size = 0.8 * cell_;
    if (chance(0.5))
      p["fill"] = {{"type", "random"}, {"region", "ball"},
                   {"centre", at},     {"size", Vector{size, size, size}},
                   {"count", count},   {"speed", speed_}};
    else
      p["fill"] = {{"type", "lattice"},
                   {"centre", at},
                   {"size", Vector{size, size, size}},
                   {"spacing", 0.3 * cell_}};
    if (!p.contains("fast") && chance(0.5)) {
      // About ten neighbours each: the fastest oscillation of a net is faster than of one spring.
      const double omega = random_.uniform(0.05, 1) * spring_rate_ / 6;
      p["springs"] = {{"reach", 0.35 * cell_},
                      {"stiffness", mass * omega * omega},
                      {"damping", random_.uniform(0, 0.2) * mass * omega}};
    }
    scene_["particles"]["p"] = p;
  }

  Random random_;
  Random shape_draws_;  ///< what is added to the list of shapes changes no scene without them
  bool has_listed_shapes_ = false;
  std::string stepper_;
  Json scene_;
  bool ordinary_ = false, defaults_ = false, explicit_euler_ = false;
  double cell_ = 1, speed_ = 0;     // [m], [m/s]
  double tick_hz_ = 60;             // [Hz]
  double spring_rate_ = 0;          // of the fastest spring [rad/s]
  double smallest_ = 0;             // [m]
  std::vector<double> radii_;       // of bodies [m]
  std::vector<int> order_;          // of cells
  std::vector<std::string> names_;  // of bodies that forces move
};

}  // namespace

RandomScene random_scene(uint64_t seed, const std::string& stepper) {
  return SceneMaker(seed, stepper).make();
}

}  // namespace tumble
