#pragma once
#include "engine/collision/shapes/flat_features.hpp"
#include "engine/collision/shapes/polyhedral.hpp"

#include <type_traits>

namespace tumble {

/// A shape with flat faces, of the family of `Base`: ConvexShape, or Shape for meshes. Implements
/// the queries for surface elements and features, by the faces of a convex shape or by the
/// triangles of a mesh.
template <class Base>
class PolyhedralShape : public Base, public Polyhedral {
 public:
  const Polyhedral* polyhedral() const final { return this; }
  SurfaceElement element_at(const Vec3& point, const Vec3& outward) const final {
    return flat_element(faces(), point, outward);
  }
  SurfaceElement border_at(const Vec3& point, const Vec3& outward) const final {
    return flat_border(faces(), point, outward);
  }
  bool has_point(const SurfaceElement& element) const final {
    return has_vertex(surface(), element.origin);
  }
  PolyhedronFeature feature_at(const Vec3& point, uint32_t triangle) const final {
    return flat_feature(faces(), point, triangle);
  }

 protected:
  using Base::Base;

 private:
  const auto& faces() const {
    if constexpr (std::is_base_of_v<ConvexShape, Base>)
      return static_cast<const ConvexShape&>(*this);
    else
      return surface();
  }
};

}  // namespace tumble
