#pragma once
#include "engine/geometry/constructions/ray_casts.hpp"
#include "engine/geometry/triangle_mesh.hpp"
#include "engine/math/dense.hpp"

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <embree3/rtcore.h>
#include <fcl/fcl.h>

/// Triangle meshes as the peers want them.
namespace tumble::peers {

inline fcl::Transform3d transform(const Pose& pose) {
  fcl::Transform3d out = fcl::Transform3d::Identity();
  out.linear() = dense(pose.q.toRotationMatrix());
  out.translation() = dense(pose.x);
  return out;
}

/// FCL's hierarchy with bounding volume BV.
template <class BV>
class FclModel {
 public:
  explicit FclModel(const TriangleMesh& mesh) {
    std::vector<fcl::Triangle> triangles;
    for (const Triangle& t : mesh.triangles) triangles.emplace_back(t[0], t[1], t[2]);
    model_->beginModel(int(mesh.triangles.size()), int(mesh.vertices.size()));
    std::vector<fcl::Vector3d> vertices;
    for (const Vec3& v : mesh.vertices) vertices.push_back(dense(v));
    model_->addSubModel(vertices, triangles);
    model_->endModel();
  }

  size_t bytes() const { return size_t(model_->memUsage(0)); }

  /// Number of intersecting pairs with this mesh itself at `pose`; at most `most` are looked for.
  size_t pairs(const Pose& pose, size_t most = 100'000'000) const {
    fcl::CollisionRequestd request(most, false);
    fcl::CollisionResultd result;
    return fcl::collide(model_.get(), fcl::Transform3d::Identity(), model_.get(), transform(pose),
                        request, result);
  }

  double distance(const Pose& pose) const {
    fcl::DistanceRequestd request(false);
    fcl::DistanceResultd result;
    return fcl::distance(model_.get(), fcl::Transform3d::Identity(), model_.get(), transform(pose),
                         request, result);
  }

 private:
  std::shared_ptr<fcl::BVHModel<BV>> model_ = std::make_shared<fcl::BVHModel<BV>>();
};

/// Number of intersecting pairs of a mesh with itself at `pose`, by CGAL's exact predicates.
inline size_t cgal_pairs(const TriangleMesh& mesh, const Pose& pose) {
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
  using Triangle = Kernel::Triangle_3;
  using Primitive = CGAL::AABB_triangle_primitive<Kernel, std::vector<Triangle>::iterator>;
  const Mat3 R = pose.q.toRotationMatrix();
  const auto triangle = [&](size_t t, bool moved) {
    std::array<Kernel::Point_3, 3> p;
    for (size_t k = 0; k < 3; ++k) {
      const Vec3& c = mesh.corner(t, k);
      const Vec3 v = moved ? Vec3(R * c + pose.x) : c;
      p[k] = {v.x(), v.y(), v.z()};
    }
    return Triangle(p[0], p[1], p[2]);
  };
  std::vector<Triangle> own;
  for (size_t t = 0; t < mesh.triangles.size(); ++t) own.push_back(triangle(t, false));
  CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>> tree(own.begin(), own.end());
  size_t count = 0;
  for (size_t t = 0; t < mesh.triangles.size(); ++t) {
    count += tree.number_of_intersected_primitives(triangle(t, true));
  }
  return count;
}

/// Embree's default tree, one ray at a time.
class EmbreeScene {
 public:
  explicit EmbreeScene(const TriangleMesh& mesh)
      : device_(rtcNewDevice("threads=1")), scene_(rtcNewScene(device_)) {
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, mesh.vertices.size()));
    for (const Vec3& v : mesh.vertices) {
      for (int k = 0; k < 3; ++k) *vertices++ = float(v[k]);
    }
    auto* triangles = static_cast<uint32_t*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, mesh.triangles.size()));
    for (const auto& t : mesh.triangles) triangles = std::copy(t.begin(), t.end(), triangles);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene_);
  }
  ~EmbreeScene() {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
  }
  EmbreeScene(const EmbreeScene&) = delete;
  EmbreeScene& operator=(const EmbreeScene&) = delete;

  bool hits(const Ray& ray) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRayHit query{};
    query.ray.org_x = float(ray.origin.x());
    query.ray.org_y = float(ray.origin.y());
    query.ray.org_z = float(ray.origin.z());
    query.ray.dir_x = float(ray.direction.x());
    query.ray.dir_y = float(ray.direction.y());
    query.ray.dir_z = float(ray.direction.z());
    query.ray.tfar = std::numeric_limits<float>::infinity();
    query.ray.mask = ~0u;
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(scene_, &context, &query);
    return query.hit.geomID != RTC_INVALID_GEOMETRY_ID;
  }

 private:
  RTCDevice device_;
  RTCScene scene_;
};

}  // namespace tumble::peers
