#include "assets/generate/constructions.hpp"

#include "engine/math/det/det.hpp"

#include <algorithm>
#include <cmath>

namespace tumble::assets {

Loop2 arc(double centre_u, double centre_w, double radius, double from_angle, double to_angle,
          int segments) {
  Loop2 points;
  for (int i = 0; i <= segments; ++i) {
    const double angle = from_angle + (to_angle - from_angle) * i / segments;
    points.push_back({centre_u + radius * det::cos(angle), centre_w + radius * det::sin(angle)});
  }
  return points;
}

Loop2 regular_polygon(double corner_radius, int corners, double first_angle) {
  Loop2 loop = arc(0, 0, corner_radius, first_angle, first_angle + 2 * det::pi, corners);
  loop.pop_back();
  return loop;
}

Loop2 inset(const Loop2& loop, double distance) {
  Loop2 result;
  const size_t n = loop.size();
  for (size_t i = 0; i < n; ++i) {
    const Point2 &a = loop[(i + n - 1) % n], &b = loop[i], &c = loop[(i + 1) % n];
    const double ab = std::sqrt((b.u - a.u) * (b.u - a.u) + (b.w - a.w) * (b.w - a.w));
    const double bc = std::sqrt((c.u - b.u) * (c.u - b.u) + (c.w - b.w) * (c.w - b.w));
    // Inward normals of the two edges; their sum over (1 + cos of the turn) is the mitre.
    const Point2 m{-(b.w - a.w) / ab, (b.u - a.u) / ab}, n2{-(c.w - b.w) / bc, (c.u - b.u) / bc};
    const double scale = distance / (1 + m.u * n2.u + m.w * n2.w);
    result.push_back({b.u + scale * (m.u + n2.u), b.w + scale * (m.w + n2.w)});
  }
  return result;
}

Loop3 at_height(const Loop2& loop, double y) {
  Loop3 points;
  for (const Point2& p : loop) points.emplace_back(p.u, y, -p.w);
  return points;
}

void skin(Builder& builder, const std::vector<Loop3>& sections, bool closed_path) {
  const size_t count = sections.size();
  for (size_t i = 0; i + (closed_path ? 0 : 1) < count; ++i) {
    const Loop3 &here = sections[i], &next = sections[(i + 1) % count];
    for (size_t j = 0; j < here.size(); ++j) {
      const size_t k = (j + 1) % here.size();
      builder.quad(here[j], here[k], next[k], next[j]);
    }
  }
}

void loft(Builder& builder, const std::vector<Loop3>& sections) {
  skin(builder, sections, false);
  Loop3 first = sections.front();
  std::reverse(first.begin(), first.end());
  builder.polygon(first);
  builder.polygon(sections.back());
}

void sweep(Builder& builder, const Loop2& section, const std::vector<Station>& path,
           bool closed_path) {
  std::vector<Loop3> sections;
  for (const Station& station : path) {
    sections.emplace_back();
    for (const Point2& p : section) {
      sections.back().push_back(station.origin + p.u * station.u + p.w * station.w);
    }
  }
  if (closed_path) {
    skin(builder, sections, true);
  } else {
    loft(builder, sections);
  }
}

void revolve(Builder& builder, const Loop2& profile, int segments) {
  std::vector<Station> path;
  for (const Point2& p : regular_polygon(1, segments)) {
    path.push_back({Vec3::Zero(), Vec3(p.u, 0, p.w), Vec3::UnitY()});
  }
  sweep(builder, profile, path, true);
}

void extrude(Builder& builder, const Loop2& outer, const std::vector<Loop2>& holes, double height,
             double bevel) {
  const auto walls = [&](const Loop2& loop, const Loop2& rim) {
    std::vector<Loop3> rings = {at_height(loop, bevel), at_height(loop, height - bevel)};
    if (bevel > 0) {
      rings.insert(rings.begin(), at_height(rim, 0));
      rings.push_back(at_height(rim, height));
    }
    skin(builder, rings, false);
  };
  const Loop2 outer_rim = inset(outer, bevel);
  walls(outer, outer_rim);
  std::vector<Loop3> top_holes, bottom_holes;
  for (Loop2 hole : holes) {
    std::reverse(hole.begin(), hole.end());  // the solid is outside a hole
    const Loop2 rim = inset(hole, bevel);
    walls(hole, rim);
    top_holes.push_back(at_height(rim, height));
    bottom_holes.push_back(at_height(rim, 0));
  }
  Loop3 bottom = at_height(outer_rim, 0);
  std::reverse(bottom.begin(), bottom.end());
  builder.polygon(bottom, bottom_holes);
  builder.polygon(at_height(outer_rim, height), top_holes);
}

void closed_tube(Builder& builder, const Loop3& curve, double radius, int section_segments,
                 const Vec3& up) {
  std::vector<Station> path;
  const size_t n = curve.size();
  for (size_t i = 0; i < n; ++i) {
    const Vec3 along = (curve[(i + 1) % n] - curve[(i + n - 1) % n]).normalized();
    const Vec3 u = up.cross(along).normalized();
    path.push_back({curve[i], u, along.cross(u)});
  }
  sweep(builder, regular_polygon(radius, section_segments), path, true);
}

}  // namespace tumble::assets
