#pragma once
#include "viewer/render/gpu_layout.hpp"
#include "viewer/render/render_scene.hpp"

namespace tumble {

/// Lines and points as three runs: those tested against depth, the faint copies of what lies
/// behind, and those over everything.
template <class T>
struct MarkRuns {
  std::vector<T> all;
  uint32_t tested = 0, faint = 0, over = 0;
};
MarkRuns<GpuLine> line_runs(const std::vector<LineSegment>& lines);
MarkRuns<GpuPoint> point_runs(const std::vector<PointMark>& points);

/// sRGB bytes, red lowest, of a linear colour.
uint32_t rgba_bytes(const Vec4f& linear);

}  // namespace tumble
