#include "engine/world/microscope/descent_steps.hpp"

#include "engine/collision/shapes/polyhedral.hpp"
#include "engine/geometry/hierarchy/aabb_tree.hpp"
#include "engine/geometry/hierarchy/obb_tree.hpp"
#include "engine/geometry/hierarchy/sphere_tree.hpp"
#include "engine/geometry/hierarchy/watched_descent.hpp"
#include "engine/world/microscope/chart.hpp"

#include <algorithm>
#include <iterator>
#include <map>
#include <set>

#include <fmt/format.h>

namespace tumble {
namespace {

/// Volumes of a body drawn in a step: more would hide each other.
constexpr size_t most_volumes = 150;
/// Triangles drawn of each body among those found: more would merge into one surface.
constexpr size_t most_triangles = 5000;

/// Limit of the tests of volumes and of the pairs of triangles found, at which a descent stops: it
/// is repeated for each picture in which a body has moved, and takes about 0.1 s at this limit.
constexpr size_t most_tests = 300'000;

/// Draws the lines of a volume into a sketch.
class VolumeLines final : public DebugDraw {
 public:
  VolumeLines(Sketch& out, Ink ink, float width) : out_(out), ink_(ink), width_(width) {}
  void line(const Vec3& a, const Vec3& b, const Vec4f&) override { out_.line(a, b, ink_, width_); }
  void point(const Vec3&, const Vec4f&, float) override {}
  void text(const Vec3&, const Vec4f&, std::string_view) override {}

 private:
  Sketch& out_;
  Ink ink_;
  float width_;
};

/// All nodes of a hierarchy, by their number in DescentTest.
std::vector<NodeBound> nodes_of(const Hierarchy& hierarchy) {
  std::vector<NodeBound> out;
  hierarchy.visit_nodes([&out](const NodeBound& bound) {
    out.push_back(bound);
    return true;
  });
  return out;
}

/// What became of a node in the tests of a level; of several tests the greatest value counts.
enum class Fate : uint8_t { pruned, kept, leaf };

/// The tree of a mesh, built once for consecutive slides.
template <class Kind>
std::shared_ptr<const BoundingTree<Kind>> tree_of(const std::shared_ptr<const TriangleMesh>& mesh,
                                                  MicroscopeMemory* memory) {
  using Tree = BoundingTree<Kind>;
  if (memory)
    for (const MicroscopeMemory::Kept& k : memory->trees)
      if (k.of == mesh && k.kind == Kind::name) return std::static_pointer_cast<const Tree>(k.tree);
  auto made = std::make_shared<const Tree>(mesh);
  if (memory) {
    constexpr size_t most = 2;  // one for each of the two bodies
    if (memory->trees.size() == most) memory->trees.erase(memory->trees.begin());
    memory->trees.push_back({mesh, Kind::name, made});
  }
  return made;
}

class DescentRecorder {
 public:
  template <class Kind>
  DescentRecorder(const MicroscopeSlide& slide, const Kind&) : slide_(slide) {
    for (size_t i = 0; i < 2; ++i) {
      mesh_[i] = slide.body[i].shape->polyhedral()->surface().mesh;
      pose_[i] = slide.body[i].pose();
    }
    const auto a = tree_of<Kind>(mesh_[0], slide.memory.get());
    const auto b = tree_of<Kind>(mesh_[1], slide.memory.get());
    nodes_ = {nodes_of(*a), nodes_of(*b)};
    way_ = watch_pairs(*a, *b, pose_[0].inverse() * pose_[1], slide.tolerance, most_tests);
    out_.title = fmt::format("Descent of two {} trees", Kind::name);
  }

  MicroscopeRecording run();

 private:
  void sort_tests();
  void add_level(size_t level);
  void add_end();
  void begin(MicroscopeStep& step) const;
  size_t draw_nodes(size_t body, const std::map<uint32_t, Fate>& fates, Sketch& out) const;
  void draw_plot(size_t until, Diagram& out) const;
  void count(size_t level, MicroscopeStep& step) const;

  const MicroscopeSlide& slide_;
  std::array<std::shared_ptr<const TriangleMesh>, 2> mesh_;
  std::array<std::vector<NodeBound>, 2> nodes_;
  std::array<Pose, 2> pose_;
  WatchedDescent way_;
  std::vector<std::vector<DescentTest>> levels_;
  MicroscopeRecording out_;
};

/// Sorts the tests by the sum of both nodes' levels, which grows by one with each step down.
void DescentRecorder::sort_tests() {
  for (const DescentTest& t : way_.tests) {
    const auto level = size_t(nodes_[0][t.a].level + nodes_[1][t.b].level);
    if (level >= levels_.size()) levels_.resize(level + 1);
    levels_[level].push_back(t);
  }
}

void DescentRecorder::begin(MicroscopeStep& step) const {
  for (size_t body = 0; body < 2; ++body)
    step.sketch.ghosts.push_back({body, pose_[body], 0.35f, false});
}

size_t DescentRecorder::draw_nodes(size_t body, const std::map<uint32_t, Fate>& fates,
                                   Sketch& out) const {
  size_t drawn = 0;
  // Nodes that are descended into first, so that the limit leaves out pruned ones.
  for (const Fate wanted : {Fate::leaf, Fate::kept, Fate::pruned})
    for (const auto& [node, fate] : fates) {
      if (fate != wanted || drawn == most_volumes) continue;
      ++drawn;
      const Ink ink = fate == Fate::pruned ? Ink::faint
                      : fate == Fate::leaf ? Ink::active
                      : body == 0          ? Ink::first
                                           : Ink::second;
      VolumeLines lines(out, ink, fate == Fate::pruned ? 1.0f : 2.2f);
      draw_bound(nodes_[body][node], pose_[body], Vec4f::Ones(), lines);
    }
  return fates.size() - drawn;
}

/// Plots the number of tests by level, and of those that were not pruned.
void DescentRecorder::draw_plot(size_t until, Diagram& out) const {
  out.title = "tests (green: went on)";
  size_t most = 1;
  for (const auto& level : levels_) most = std::max(most, level.size());
  Chart chart(out, 0, double(levels_.size()), 0, double(most), "level", "tests");
  for (size_t i = 0; i < levels_.size(); ++i) {
    const auto went_on = std::count_if(levels_[i].begin(), levels_[i].end(),
                                       [](const DescentTest& t) { return !t.apart; });
    const auto bar = [&](double height, Ink ink, float opacity) {
      Diagram::Box box;
      box.min = chart.at(double(i) + 0.12, 0);
      box.max = chart.at(double(i) + 0.88, height);
      box.ink = ink, box.opacity = opacity;
      out.boxes.push_back(box);
    };
    const bool past = i <= until;
    bar(double(levels_[i].size()), Ink::plain, past ? 0.55f : 0.15f);
    if (past && went_on > 0) bar(double(went_on), Ink::answer, i == until ? 1 : 0.6f);
  }
}

void DescentRecorder::count(size_t level, MicroscopeStep& step) const {
  size_t nodes = 0, pruned = 0, triangles = 0;
  for (size_t i = 0; i <= level; ++i)
    for (const DescentTest& t : levels_[i]) {
      ++nodes;
      pruned += t.apart ? 1 : 0;
      triangles += t.leaf_tests;
    }
  step.numbers.push_back({"pairs of nodes tested", fmt::format("{}", nodes)});
  step.numbers.push_back({"pruned", fmt::format("{}", pruned)});
  step.numbers.push_back({"pairs of triangles tested", fmt::format("{}", triangles)});
  step.numbers.push_back({"without trees", fmt::format("{}", mesh_[0]->triangles.size() *
                                                                 mesh_[1]->triangles.size())});
}

void DescentRecorder::add_level(size_t level) {
  std::array<std::map<uint32_t, Fate>, 2> fates;
  size_t apart = 0, leaves = 0, triangles = 0;
  for (const DescentTest& t : levels_[level]) {
    const Fate fate = t.apart ? Fate::pruned : t.leaf_tests > 0 ? Fate::leaf : Fate::kept;
    for (size_t body = 0; body < 2; ++body) {
      Fate& own = fates[body].emplace(body == 0 ? t.a : t.b, fate).first->second;
      own = std::max(own, fate);
    }
    apart += fate == Fate::pruned ? 1 : 0;
    leaves += fate == Fate::leaf ? 1 : 0;
    triangles += t.leaf_tests;
  }
  const size_t all = levels_[level].size();
  MicroscopeStep& step = out_.steps.emplace_back();
  begin(step);
  const size_t hidden = draw_nodes(0, fates[0], step.sketch) + draw_nodes(1, fates[1], step.sketch);
  step.numbers.push_back({"level", fmt::format("{} of {}", level, levels_.size() - 1)});
  step.numbers.push_back({"tests on it", fmt::format("{}", all)});
  count(level, step);
  draw_plot(level, step.diagram);
  step.title = level == 0 ? "Do the two roots overlap?"
                          : fmt::format("Level {}: {} tests, {} pruned", level, all, apart);
  step.caption =
      level == 0
          ? "Each root holds a whole mesh. Where they are apart, so is everything in them, and one "
            "test has answered for all pairs of triangles; else the larger node of a pair is "
            "replaced by its two children."
          : fmt::format(
                "{} pairs of nodes come from the level above. {} are apart (grey), and all "
                "below them is left out. {} go on{}.",
                all, apart, all - apart - leaves,
                leaves == 0 ? std::string()
                            : fmt::format("; {} are two leaves (pink), whose {} pairs of "
                                          "triangles are tested one by one",
                                          leaves, triangles));
  if (hidden > 0) step.caption += fmt::format(" {} volumes are not drawn.", hidden);
}

void DescentRecorder::add_end() {
  MicroscopeStep& step = out_.steps.emplace_back();
  begin(step);
  for (size_t body = 0; body < 2; ++body) {
    Sketch::Surface near{{}, Ink::answer, 0.85f};
    std::set<uint32_t> drawn;  // a triangle may be in many pairs
    for (const TriangleIds& ids : way_.found) {
      const uint32_t id = body == 0 ? ids.a : ids.b;
      if (drawn.size() == most_triangles || !drawn.insert(id).second) continue;
      const auto& corners = mesh_[body]->triangles[id];
      std::array<Vec3, 3> at;
      for (size_t k = 0; k < 3; ++k) at[k] = pose_[body].point(mesh_[body]->vertices[corners[k]]);
      near.triangles.push_back(at);
      for (size_t k = 0; k < 3; ++k) step.sketch.line(at[k], at[(k + 1) % 3], Ink::answer, 2);
    }
    if (!near.triangles.empty()) step.sketch.surfaces.push_back(std::move(near));
  }
  count(levels_.size() - 1, step);
  step.numbers.push_back({"pairs found", fmt::format("{}", way_.found.size())});
  draw_plot(levels_.size() - 1, step.diagram);
  size_t triangles = 0;
  for (const DescentTest& t : way_.tests) triangles += t.leaf_tests;
  const double all = double(mesh_[0]->triangles.size()) * double(mesh_[1]->triangles.size());
  step.title = way_.found.empty() ? "Nothing is near" : "Which triangles are near";
  step.caption = fmt::format(
      "{} pairs of triangles are within {:.2g} m of each other. The trees took {} tests of volumes "
      "and {} of triangles; without them all {:.0f} pairs of triangles would have been tested.",
      way_.found.size(), slide_.tolerance, way_.tests.size(), triangles, all);
  if (!way_.whole)
    step.caption += fmt::format(
        " The descent was broken off after these: it would take more than {} tests, or find more "
        "pairs.",
        most_tests);
  out_.answer = double(way_.found.size());
}

MicroscopeRecording DescentRecorder::run() {
  sort_tests();
  for (size_t level = 0; level < levels_.size(); ++level) add_level(level);
  add_end();
  return std::move(out_);
}

}  // namespace

std::string refuse_descent(const Shape& a, const Shape& b) {
  if (a.polyhedral() && b.polyhedral() && (a.is_mesh() || b.is_mesh())) return {};
  return "descent needs a triangle_mesh, and beside it another one, a convex_hull or a box";
}

MicroscopeRecording record_aabb_descent(const MicroscopeSlide& slide) {
  return DescentRecorder(slide, AabbKind{}).run();
}
MicroscopeRecording record_obb_descent(const MicroscopeSlide& slide) {
  return DescentRecorder(slide, ObbKind{}).run();
}
MicroscopeRecording record_sphere_descent(const MicroscopeSlide& slide) {
  return DescentRecorder(slide, SphereKind{}).run();
}

}  // namespace tumble
