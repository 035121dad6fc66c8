// Exact convex decompositions of meshes that we and others made, each checked by what a partition
// is, in long double arithmetic on the exported doubles and by code of this file alone: every piece
// convex, the volume that pairs of pieces share (one clipped against the other) nothing, and
// volume, first and second moments of all pieces together those of the mesh (signed tetrahedra).
// That the checker sees faults is tested first.
#include "engine/geometry/decomposition/convex_decomposition.hpp"
#include "engine/geometry/make_mesh.hpp"
#include "engine/geometry/solid/solid_report.hpp"
#include "engine/scene/mesh_import.hpp"
#include "tests/support/assimp_models.hpp"
#include "tests/support/scale.hpp"
#include "tests/support/why_not.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <doctest/doctest.h>

using namespace tumble;

namespace {

using Real = long double;
using Point = std::array<Real, 3>;

Point minus(const Point& a, const Point& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
Point cross(const Point& a, const Point& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Real dot(const Point& a, const Point& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
Real length(const Point& a) {
  return std::sqrt(dot(a, a));
}
Point point(const Vec3& v) {
  return {v.x(), v.y(), v.z()};
}

/// Integrals of 1, x_i and x_i x_j over a solid, about a point.
struct Moments {
  Real volume = 0;
  Point first{};
  std::array<Real, 6> second{};

  /// The tetrahedron of the origin and a triangle.
  void add(const Point& a, const Point& b, const Point& c) {
    const Real d = dot(a, cross(b, c));
    Point s{};
    volume += d / 6;
    for (size_t i = 0; i < 3; ++i) {
      s[i] = a[i] + b[i] + c[i];
      first[i] += d / 24 * s[i];
    }
    for (size_t i = 0, n = 0; i < 3; ++i)
      for (size_t j = i; j < 3; ++j, ++n)
        second[n] += d / 120 * (s[i] * s[j] + a[i] * a[j] + b[i] * b[j] + c[i] * c[j]);
  }
};

/// How far moments differ, of 1, of an extent and of its square [of the volume].
Real difference(const Moments& a, const Moments& b, Real extent) {
  Real worst = std::fabs(a.volume - b.volume);
  for (size_t i = 0; i < 3; ++i)
    worst = std::max(worst, std::fabs(a.first[i] - b.first[i]) / extent);
  for (size_t i = 0; i < 6; ++i)
    worst = std::max(worst, std::fabs(a.second[i] - b.second[i]) / (extent * extent));
  return worst / std::fabs(a.volume);
}

/// A piece, about the middle of its mesh.
struct Piece {
  struct HalfSpace {
    Point normal{};
    Real offset = 0;  ///< all vertices are beneath, whatever the normal
  };
  std::vector<Point> v;
  std::vector<std::vector<Point>> faces;
  std::vector<HalfSpace> halves;
  Point low{}, high{};
  /// How far a vertex is over a face [of what rounding makes uncertain there: a unit in the last
  /// place, larger by the lever from a narrow face to the vertex].
  Real bulge = 0;

  Piece(const ConvexPolyhedron& p, const Point& middle, Real unit) {
    for (const Vec3& x : p.vertices) v.push_back(minus(point(x), middle));
    low = high = v[0];
    for (const Point& x : v)
      for (size_t k = 0; k < 3; ++k) {
        low[k] = std::min(low[k], x[k]);
        high[k] = std::max(high[k], x[k]);
      }
    for (size_t f = 0; f < p.face_count(); ++f) {
      std::vector<Point>& face = faces.emplace_back();
      for (const uint32_t i : p.face(f)) face.push_back(v[i]);
      add_half_space(face, unit);
    }
  }

 private:
  void add_half_space(const std::vector<Point>& face, Real unit) {
    Point area{};
    Real extent = 0;
    for (size_t k = 1; k < face.size(); ++k) {
      const Point side = minus(face[k], face[0]);
      extent = std::max(extent, length(side));
      if (k + 1 == face.size()) break;
      const Point turn = cross(side, minus(face[k + 1], face[0]));
      for (size_t i = 0; i < 3; ++i) area[i] += turn[i];
    }
    const Real size = length(area);
    if (!(size > 0)) return;
    HalfSpace& half = halves.emplace_back();
    half.offset = -std::numeric_limits<Real>::infinity();
    for (size_t i = 0; i < 3; ++i) half.normal[i] = area[i] / size;
    for (const Point& x : v) {
      half.offset = std::max(half.offset, dot(half.normal, x));
      const Point from = minus(x, face[0]);
      const Real uncertain = unit * (1 + length(from) / (size / extent));
      bulge = std::max(bulge, dot(half.normal, from) / uncertain);
    }
  }
};

/// A convex polygon as far as it lies in all half-spaces (Sutherland & Hodgman 1974).
std::vector<Point> clipped(std::vector<Point> polygon,
                           const std::vector<Piece::HalfSpace>& halves) {
  std::vector<Point> next;
  for (const Piece::HalfSpace& h : halves) {
    next.clear();
    for (size_t k = 0; k < polygon.size(); ++k) {
      const Point &a = polygon[k], &b = polygon[(k + 1) % polygon.size()];
      const Real da = dot(h.normal, a) - h.offset, db = dot(h.normal, b) - h.offset;
      if (da <= 0) next.push_back(a);
      if ((da < 0 && db > 0) || (da > 0 && db < 0)) {
        Point cut{};
        for (size_t i = 0; i < 3; ++i) cut[i] = a[i] + da / (da - db) * (b[i] - a[i]);
        next.push_back(cut);
      }
    }
    std::swap(polygon, next);
    if (polygon.size() < 3) return {};
  }
  return polygon;
}

bool separated(const Piece& a, const Piece& b) {
  for (const Piece::HalfSpace& h : a.halves) {
    bool over = true;
    for (const Point& x : b.v) over = over && dot(h.normal, x) >= h.offset;
    if (over) return true;
  }
  return false;
}

/// The volume that two pieces share: its surface is what of either's faces is in the other.
/// Faces that coincide and look the same way count for both, so it may be up to twice as much.
Real shared_volume(const Piece& a, const Piece& b) {
  for (size_t k = 0; k < 3; ++k)
    if (a.high[k] <= b.low[k] || b.high[k] <= a.low[k]) return 0;
  if (separated(a, b) || separated(b, a)) return 0;
  std::vector<std::vector<Point>> surface;
  for (const auto& [of, in] : {std::pair{&a, &b}, std::pair{&b, &a}})
    for (const std::vector<Point>& face : of->faces)
      if (auto part = clipped(face, in->halves); !part.empty()) surface.push_back(std::move(part));
  Real six = 0;
  for (const std::vector<Point>& f : surface)
    for (size_t k = 2; k < f.size(); ++k) {
      // About a point of it, so that a skin has no height anywhere.
      const Point &o = surface[0][0], p = minus(f[0], o);
      six += dot(p, cross(minus(f[k - 1], o), minus(f[k], o)));
    }
  return std::fabs(six) / 6;
}

struct Verdict {
  Real moments = 0;  ///< difference from the mesh's [volumes]
  Real shared = 0;   ///< by pairs of pieces [volumes]
  Real bulge = 0;    ///< of the worst piece, as above
  bool partition() const { return moments < 1e-12L && shared < 1e-12L && bulge < 8; }
};

Verdict judge(const TriangleMesh& mesh, const std::vector<ConvexPiece>& pieces) {
  const Aabb box = bounds(mesh);
  const Point middle = point(box.centre());
  const Real extent = box.extent().norm();
  const Real unit = std::numeric_limits<double>::epsilon() *
                    (extent + box.min.cwiseAbs().cwiseMax(box.max.cwiseAbs()).maxCoeff());
  Moments whole, sum;
  for (const Triangle& t : mesh.triangles)
    whole.add(minus(point(mesh.vertices[t[0]]), middle), minus(point(mesh.vertices[t[1]]), middle),
              minus(point(mesh.vertices[t[2]]), middle));
  Verdict out;
  std::vector<Piece> all;
  for (const ConvexPiece& p : pieces) {
    const Piece& piece = all.emplace_back(p.hull, middle, unit);
    out.bulge = std::max(out.bulge, piece.bulge);
    for (const std::vector<Point>& f : piece.faces)
      for (size_t k = 2; k < f.size(); ++k) sum.add(f[0], f[k - 1], f[k]);
  }
  out.moments = difference(whole, sum, extent);
  std::ranges::sort(all, {}, [](const Piece& p) { return p.low[0]; });
  for (size_t a = 0; a < all.size(); ++a)
    for (size_t b = a + 1; b < all.size() && all[b].low[0] < all[a].high[0]; ++b)
      out.shared += shared_volume(all[a], all[b]) / std::fabs(whole.volume);
  return out;
}

ConvexPiece moved(ConvexPiece piece, const Vec3& by) {
  for (Vec3& v : piece.hull.vertices) v += by;
  return piece;
}

}  // namespace

TEST_CASE("the checker of partitions sees pieces that overlap, lack, lie elsewhere or are dented") {
  const TriangleMesh torus = make_mesh::torus(0.5, 0.2, 12, 6);
  const auto made = decompose_exactly(torus);
  REQUIRE(made.ok());
  const std::vector<ConvexPiece> good = made->pieces;
  REQUIRE(good.size() > 4);
  CHECK(judge(torus, good).partition());

  std::vector<ConvexPiece> bad = good;
  bad[1] = moved(bad[1], {1e-9, 2e-9, 0});
  CHECK(judge(torus, bad).shared > 1e-10L);
  bad = good;
  bad.push_back(bad[0]);
  const double copied = double(judge(torus, bad).shared) * made->mesh_volume / good[0].volume;
  CHECK(copied > 1 - 1e-9);
  CHECK(copied < 2 + 1e-9);
  bad = good;
  bad.pop_back();
  CHECK(judge(torus, bad).moments > 1e-3L);
  bad = good;
  bad[0] = moved(bad[0], {7, 0, 0});  // as much volume, no overlap
  CHECK(judge(torus, bad).shared < 1e-12L);
  CHECK(judge(torus, bad).moments > 1e-3L);
  bad = good;
  Vec3& corner = bad[0].hull.vertices[0];
  Vec3 mean = Vec3::Zero();
  for (const Vec3& v : bad[0].hull.vertices) mean += v / double(bad[0].hull.vertices.size());
  corner += 1e-9 * (mean - corner);
  CHECK(judge(torus, bad).bulge > 1e3L);
}

namespace {

/// Of the solids among these files: in the gate those of few triangles, which take no second.
size_t check_solids(const std::vector<std::filesystem::path>& files) {
  const size_t most_triangles = test::all_counts() ? 4000 : 320;
  constexpr uintmax_t most_bytes = 400'000;
  size_t checked = 0, pieces = 0, left_out = 0;
  Verdict worst;
  for (const std::filesystem::path& file : files) {
    if (std::filesystem::file_size(file) > most_bytes) continue;
    const auto imported = import_mesh(file);
    if (!imported || imported->mesh.triangles.size() > most_triangles) continue;
    if (!check_solid(imported->mesh).solid()) continue;
    CAPTURE(file.string());
    const auto d = decompose_exactly(imported->mesh);
    REQUIRE_MESSAGE(d.ok(), test::why_not(d));
    const Verdict v = judge(imported->mesh, d->pieces);
    CHECK(v.moments < 1e-12L);
    CHECK(v.shared < 1e-12L);
    CHECK(v.bulge < 8);
    CHECK(d->left_out_volume < 1e-12 * d->mesh_volume);
    worst.moments = std::max(worst.moments, v.moments);
    worst.shared = std::max(worst.shared, v.shared);
    worst.bulge = std::max(worst.bulge, v.bulge);
    ++checked;
    pieces += d->pieces.size();
    left_out += d->left_out;
  }
  MESSAGE(checked, " solids, ", pieces, " pieces, ", left_out, " parts left out; moments off by ",
          double(worst.moments), ", shared ", double(worst.shared), ", bulge ",
          double(worst.bulge));
  return checked;
}

}  // namespace

TEST_CASE("exact pieces of our meshes are convex, share nothing and are the mesh") {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(
           std::filesystem::path(TUMBLE_SOURCE_DIR) / "assets/meshes"))
    files.push_back(entry.path());
  CHECK(check_solids(files) >= 10);
}

TEST_CASE("exact pieces of the models of assimp are convex, share nothing and are the mesh") {
  if (!have_assimp_models()) return;
  std::vector<std::filesystem::path> files;
  for (const std::filesystem::path& file : assimp_model_files())
    for (const char* folder : {"/3DS/", "/AMF/", "/Collada/", "/OBJ/", "/OFF/", "/PLY/", "/STL/"})
      if (file.string().find("/models" + std::string(folder)) != std::string::npos)
        files.push_back(file);
  CHECK(check_solids(files) >= 20);
}
