#pragma once
#include "engine/collision/v_clip/voronoi_polyhedron.hpp"

#include <mutex>
#include <optional>

namespace tumble {

/// The Voronoi planes of a shape, computed on first use and then shared.
class LazyVoronoi {
 public:
  /// Null when the polyhedron has none: see make_voronoi_polyhedron.
  template <class MakePolyhedron>
  const VoronoiPolyhedron* get(const MakePolyhedron& make) const {
    std::call_once(once_, [&] {
      const Result<ConvexPolyhedron> polyhedron = make();
      if (!polyhedron.ok()) return;
      if (auto voronoi = make_voronoi_polyhedron(*polyhedron); voronoi.ok())
        voronoi_.emplace(std::move(*voronoi));
    });
    return voronoi_ ? &*voronoi_ : nullptr;
  }

 private:
  mutable std::once_flag once_;
  mutable std::optional<VoronoiPolyhedron> voronoi_;
};

}  // namespace tumble
