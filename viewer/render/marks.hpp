#pragma once
#include "viewer/render/gpu_layout.hpp"
#include "viewer/render/render_scene.hpp"

namespace tumble {

/// Lines or points in three runs: those tested against depth, the faint copies of their hidden
/// parts, and those drawn over everything.
template <class T>
struct MarkRuns {
  std::vector<T> all;
  uint32_t tested = 0, faint = 0, over = 0;
};
MarkRuns<GpuLine> line_runs(const std::vector<LineSegment>& lines);
MarkRuns<GpuPoint> point_runs(const std::vector<PointMark>& points);

/// The sRGB bytes, red lowest, of a linear colour.
uint32_t rgba_bytes(const Vec4f& linear);

}  // namespace tumble
