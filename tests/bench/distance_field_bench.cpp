// Distance fields against OpenVDB's level sets (tools::meshToLevelSet, then its trilinear sampler):
// a bumpy ball of 81,920 triangles and a torus of 61,440, both with nodes right up to the same
// number of cells from the surface, on one thread. The answer is the sum of |distance| over the
// queries, which both give alike; errors are against the exact distance, where both have fine
// answers. The bars: .3 of the time, .65 of the bytes, no larger an error; a value in 25 ns, one
// with its gradient in 40, an exact distance in 3 us.
#include "engine/core/random.hpp"
#include "engine/geometry/distance_field/distance_field.hpp"
#include "engine/geometry/hierarchy/aabb_tree.hpp"
#include "engine/geometry/make_mesh.hpp"
#include "tests/bench/contest.hpp"
#include "tests/geometry/draws.hpp"

#include <cmath>
#include <memory>

#include <openvdb/openvdb.h>
#include <openvdb/tools/Interpolation.h>
#include <openvdb/tools/MeshToVolume.h>
#include <tbb/global_control.h>

using namespace tumble;

namespace {

/// A ball with bumps of three sizes, about as uneven as a scan.
TriangleMesh bumpy_ball() {
  TriangleMesh mesh = make_mesh::icosphere(1, 6);
  for (Vec3& v : mesh.vertices)
    v *= 1 + 0.15 * std::sin(3 * v.x() + 1) * std::cos(2 * v.y()) + 0.05 * std::sin(9 * v.z()) +
         0.01 * std::sin(31 * v.x()) * std::sin(29 * v.y());
  return mesh;
}

openvdb::FloatGrid::Ptr level_set(const TriangleMesh& mesh, double cell, double half_width) {
  std::vector<openvdb::Vec3s> points;
  std::vector<openvdb::Vec3I> triangles;
  for (const Vec3& v : mesh.vertices) points.emplace_back(float(v.x()), float(v.y()), float(v.z()));
  for (const Triangle& t : mesh.triangles) triangles.emplace_back(t[0], t[1], t[2]);
  return openvdb::tools::meshToLevelSet<openvdb::FloatGrid>(
      *openvdb::math::Transform::createLinearTransform(cell), points, triangles, float(half_width));
}

struct Errors {
  double square = 0, largest = 0;
  size_t count = 0;
  void add(double e) {
    square += e * e;
    largest = std::max(largest, std::fabs(e));
    ++count;
  }
  void print(const char* name) const {
    std::printf("  %-28s rms %.3e m, largest %.3e m (%zu points)\n", name,
                std::sqrt(square / double(count)), largest, count);
  }
};

/// Points no farther from the surface than `band`.
std::vector<Vec3> points_near(const Hierarchy& surface, double band, size_t count) {
  Random random(5);
  std::vector<Vec3> out;
  const TriangleMesh& mesh = surface.mesh();
  while (out.size() < count) {
    const auto t = size_t(random.uniform() * double(mesh.triangles.size()));
    const Vec3 p = (mesh.corner(t, 0) + mesh.corner(t, 1) + mesh.corner(t, 2)) / 3 +
                   band * random.uniform() * draws::direction(random);
    out.push_back(p);
  }
  return out;
}

void run(const char* name, TriangleMesh made, double half_width) {
  const auto mesh = std::make_shared<const TriangleMesh>(std::move(made));
  const auto surface = std::make_shared<const AabbTree>(mesh);
  DistanceFieldOptions options;
  options.cell = surface->bounds().extent().maxCoeff() / 128;
  options.band = half_width - std::sqrt(3.0);  // the field's nodes go that much farther
  std::optional<DistanceField> field;
  openvdb::FloatGrid::Ptr grid;
  std::printf("%s, %zu triangles, 128 cells along, nodes right to %.2f cells\n", name,
              mesh->triangles.size(), half_width);
  bench::report(
      "build",
      {{"OpenVDB",
        [&] {
          grid = level_set(*mesh, options.cell, half_width);
          return double(grid->activeVoxelCount());
        }},
       {"tumble",
        [&] {
          field = *make_distance_field(*surface, options);
          return double(field->report().nodes);
        }},
       {"tumble, its tree with it",
        [&] { return double(make_distance_field(AabbTree(mesh), options)->report().nodes); }}},
      5);
  const double theirs = double(grid->memUsage()), ours = double(field->report().bytes);
  std::printf("  memory: OpenVDB %.2f MB, tumble %.2f MB, %.3f x\n", theirs / 1e6, ours / 1e6,
              ours / theirs);

  const auto points = points_near(*surface, field->band(), 100'000);
  auto accessor = grid->getConstAccessor();
  const openvdb::tools::GridSampler<openvdb::FloatGrid::ConstAccessor, openvdb::tools::BoxSampler>
      sampler(accessor, grid->transform());
  Errors their_error, our_error;
  for (size_t i = 0; i < points.size(); i += 10) {
    const Vec3& p = points[i];
    const double exact = exact_distance(*surface, p).distance;
    their_error.add(double(sampler.wsSample({p.x(), p.y(), p.z()})) - exact);
    our_error.add(field->value(p) - exact);
  }
  their_error.print("OpenVDB");
  our_error.print("tumble");

  const double each = 1e6 / double(points.size());
  const auto value =
      bench::report("100,000 values near the surface",
                    {{"OpenVDB",
                      [&] {
                        double sum = 0;
                        for (const Vec3& p : points)
                          sum += std::fabs(double(sampler.wsSample({p.x(), p.y(), p.z()})));
                        return sum;
                      }},
                     {"tumble",
                      [&] {
                        double sum = 0;
                        for (const Vec3& p : points) sum += std::fabs(field->value(p));
                        return sum;
                      }},
                     {"tumble, with gradient",
                      [&] {
                        double sum = 0;
                        Vec3 gradient, total = Vec3::Zero();
                        for (const Vec3& p : points) {
                          sum += std::fabs(field->value(p, gradient));
                          total += gradient;
                        }
                        return total.allFinite() ? sum : 0;
                      }},
                     {"tumble, exact distance", [&] {
                        double sum = 0;
                        for (const Vec3& p : points)
                          sum += std::fabs(exact_distance(*surface, p).distance);
                        return sum;
                      }}});
  std::printf("  each: OpenVDB %.1f, value %.1f, with gradient %.1f, exact %.0f ns of processor\n",
              value[0].cpu * each, value[1].cpu * each, value[2].cpu * each, value[3].cpu * each);
}

}  // namespace

int main() {
  openvdb::initialize();
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  // OpenVDB's own width, and the one that a field's default band asks for.
  for (const double half_width : {3.0, 2 + std::sqrt(3.0)}) {
    run("bumpy ball", bumpy_ball(), half_width);
    run("torus", make_mesh::torus(1, 0.4, 240, 128), half_width);
  }
}
