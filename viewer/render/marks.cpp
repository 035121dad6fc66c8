#include "viewer/render/marks.hpp"

#include "engine/math/det/det.hpp"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

constexpr float faintness = 0.25f;

std::array<float, 3> three(const Vec3f& v) {
  return {v.x(), v.y(), v.z()};
}
std::array<float, 4> four(const Vec4f& v) {
  return {v.x(), v.y(), v.z(), v.w()};
}

GpuLine pack(const LineSegment& l) {
  return {three(l.a), three(l.b), four(l.colour), l.width};
}
GpuPoint pack(const PointMark& p) {
  return {three(p.x), four(p.colour), p.size};
}

/// What is not finite has no place in a picture.
bool has_place(const LineSegment& l) {
  return l.a.allFinite() && l.b.allFinite();
}
bool has_place(const PointMark& p) {
  return p.x.allFinite();
}

template <class Gpu, class Mark>
MarkRuns<Gpu> runs(const std::vector<Mark>& marks) {
  MarkRuns<Gpu> out;
  out.all.reserve(marks.size());
  for (const Mark& m : marks)
    if (m.occlusion != Occlusion::none && has_place(m)) out.all.push_back(pack(m));
  out.tested = uint32_t(out.all.size());
  for (const Mark& m : marks)
    if (m.occlusion == Occlusion::faint && has_place(m)) {
      out.all.push_back(pack(m));
      out.all.back().colour[3] *= faintness;
    }
  out.faint = uint32_t(out.all.size()) - out.tested;
  for (const Mark& m : marks)
    if (m.occlusion == Occlusion::none && has_place(m)) out.all.push_back(pack(m));
  out.over = uint32_t(out.all.size()) - out.tested - out.faint;
  return out;
}

}  // namespace

MarkRuns<GpuLine> line_runs(const std::vector<LineSegment>& lines) {
  return runs<GpuLine>(lines);
}
MarkRuns<GpuPoint> point_runs(const std::vector<PointMark>& points) {
  return runs<GpuPoint>(points);
}

uint32_t rgba_bytes(const Vec4f& linear) {
  uint32_t out = 0;
  for (int i = 0; i < 4; ++i) {
    const double c = std::clamp(double(linear[i]), 0.0, 1.0);
    const double s = i == 3 ? c : c <= 0.0031308 ? 12.92 * c : 1.055 * det::pow(c, 1 / 2.4) - 0.055;
    out |= uint32_t(s * 255 + 0.5) << (8 * i);
  }
  return out;
}

}  // namespace tumble
