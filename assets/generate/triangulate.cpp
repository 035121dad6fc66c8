#include "assets/generate/triangulate.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <utility>

namespace tumble::assets {
namespace {

double cross(const Point2& a, const Point2& b, const Point2& c) {
  return (b.u - a.u) * (c.w - a.w) - (b.w - a.w) * (c.u - a.u);
}

double squared_distance(const Point2& a, const Point2& b) {
  return (a.u - b.u) * (a.u - b.u) + (a.w - b.w) * (a.w - b.w);
}

bool same(const Point2& a, const Point2& b) {
  return a.u == b.u && a.w == b.w;
}

/// Proper or touching crossing of two segments that share no end point.
bool cross_each_other(const Point2& a, const Point2& b, const Point2& c, const Point2& d) {
  if (same(a, c) || same(a, d) || same(b, c) || same(b, d)) return false;
  return cross(a, b, c) * cross(a, b, d) <= 0 && cross(c, d, a) * cross(c, d, b) <= 0;
}

using Chain = std::vector<int>;

bool crosses_chain(const std::vector<Point2>& p, const Chain& chain, int a, int b) {
  for (size_t i = 0; i < chain.size(); ++i) {
    const int c = chain[i], d = chain[(i + 1) % chain.size()];
    if (cross_each_other(p[size_t(a)], p[size_t(b)], p[size_t(c)], p[size_t(d)])) return true;
  }
  return false;
}

/// Joins holes[h] to `outer` by the shortest bridge that crosses nothing.
void join_hole(const std::vector<Point2>& p, Chain& outer, const std::vector<Chain>& holes,
               size_t h) {
  double best = std::numeric_limits<double>::infinity();
  size_t best_o = 0, best_h = 0;
  for (size_t o = 0; o < outer.size(); ++o) {
    for (size_t k = 0; k < holes[h].size(); ++k) {
      const int a = outer[o], b = holes[h][k];
      const double distance = squared_distance(p[size_t(a)], p[size_t(b)]);
      if (distance >= best || crosses_chain(p, outer, a, b)) continue;
      bool clear = true;
      for (size_t g = h; g < holes.size() && clear; ++g) clear = !crosses_chain(p, holes[g], a, b);
      if (!clear) continue;
      best = distance;
      best_o = o;
      best_h = k;
    }
  }
  Chain joined(outer.begin(), outer.begin() + long(best_o) + 1);
  for (size_t k = 0; k <= holes[h].size(); ++k) {
    joined.push_back(holes[h][(best_h + k) % holes[h].size()]);
  }
  joined.insert(joined.end(), outer.begin() + long(best_o), outer.end());
  outer = joined;
}

/// Shape of a triangle, without unit: 0 for a needle or one that is turned over.
double quality(const Point2& a, const Point2& b, const Point2& c) {
  const double area = cross(a, b, c);
  if (area <= 1e-12) return 0;
  const double ab = squared_distance(a, b), bc = squared_distance(b, c),
               ca = squared_distance(c, a);
  return area * area / (std::max({ab, bc, ca}) * (ab + bc + ca));
}

/// Quality of the ear at chain[i]; 0 when it is no ear.
double ear_quality(const std::vector<Point2>& p, const Chain& chain, size_t i) {
  const size_t n = chain.size();
  const Point2& a = p[size_t(chain[(i + n - 1) % n])];
  const Point2& b = p[size_t(chain[i])];
  const Point2& c = p[size_t(chain[(i + 1) % n])];
  if (cross(a, b, c) <= 1e-12) return 0;
  for (const int k : chain) {
    const Point2& q = p[size_t(k)];
    if (same(q, a) || same(q, b) || same(q, c)) continue;
    if (cross(a, b, q) >= 0 && cross(b, c, q) >= 0 && cross(c, a, q) >= 0) return 0;
  }
  return quality(a, b, c);
}

using Triangles = std::vector<std::array<int, 3>>;

/// Swaps one diagonal whose change lifts the worse of its two triangles; false when there is none.
bool flip_one(const std::vector<Point2>& p, Triangles& triangles) {
  std::map<std::pair<int, int>, std::pair<size_t, int>> edges;  // edge -> triangle, its far corner
  for (size_t i = 0; i < triangles.size(); ++i) {
    const auto& t = triangles[i];
    for (size_t k = 0; k < 3; ++k) edges[{t[k], t[(k + 1) % 3]}] = {i, t[(k + 2) % 3]};
  }
  for (const auto& [edge, left] : edges) {
    const auto other = edges.find({edge.second, edge.first});
    if (edge.first > edge.second || other == edges.end()) continue;
    const int a = edge.first, b = edge.second, c = left.second, d = other->second.second;
    const auto q = [&](int i, int j, int k) {
      return quality(p[size_t(i)], p[size_t(j)], p[size_t(k)]);
    };
    const double before = std::min(q(a, b, c), q(b, a, d));
    const double after = std::min(q(a, d, c), q(d, b, c));
    if (after <= before * (1 + 1e-6)) continue;
    triangles[left.first] = {a, d, c};
    triangles[other->second.first] = {d, b, c};
    return true;
  }
  return false;
}

}  // namespace

double twice_area(const Loop2& loop) {
  double sum = 0;
  for (size_t i = 0; i < loop.size(); ++i) {
    const Point2& a = loop[i];
    const Point2& b = loop[(i + 1) % loop.size()];
    sum += a.u * b.w - a.w * b.u;
  }
  return sum;
}

std::vector<std::array<int, 3>> triangulate(const std::vector<Loop2>& loops) {
  std::vector<Point2> p;
  std::vector<Chain> chains;
  for (const Loop2& loop : loops) {
    chains.emplace_back();
    for (const Point2& point : loop) {
      chains.back().push_back(int(p.size()));
      p.push_back(point);
    }
  }
  Chain outer = chains.front();
  const std::vector<Chain> holes(chains.begin() + 1, chains.end());
  for (size_t h = 0; h < holes.size(); ++h) join_hole(p, outer, holes, h);

  Triangles triangles;
  while (outer.size() >= 3) {
    size_t best = outer.size();
    double best_quality = 0;
    for (size_t i = 0; i < outer.size(); ++i) {
      const double shape = ear_quality(p, outer, i);
      if (shape > best_quality * (1 + 1e-9)) {
        best_quality = shape;
        best = i;
      }
    }
    if (best == outer.size()) break;  // a bad polygon: the audit will find the opening
    const size_t n = outer.size();
    triangles.push_back({outer[(best + n - 1) % n], outer[best], outer[(best + 1) % n]});
    outer.erase(outer.begin() + long(best));
  }
  for (size_t flips = 0; flips < 4 * triangles.size(); ++flips) {
    if (!flip_one(p, triangles)) break;
  }
  return triangles;
}

}  // namespace tumble::assets
