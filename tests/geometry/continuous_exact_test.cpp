// Vertex-face and edge-edge under linear motion against integer arithmetic
// (continuous_reference.hpp: nothing is rounded): random and near queries, then families chosen to
// be as awkward as we could think of, at magnitudes from 1e-12 to 1e12, at the origin and far from
// it.
#include "engine/geometry/constructions/closest_points.hpp"
#include "tests/geometry/continuous_families.hpp"
#include "tests/geometry/continuous_reference.hpp"

#include <doctest/doctest.h>

using namespace tumble;
using namespace tumble::continuous;

namespace {

std::optional<exact::ExactContact> in_integers(const Query& q) {
  return q.edges ? exact::edge_edge(q.first(), q.second()) : exact::vertex_face(q.p[0], q.face());
}

double distance_at(const Query& q, double t) {
  const auto at = [&](size_t i) {  // relative to a corner, to keep digits
    const Vec3& o = q.p[0].start;
    return Vec3((1 - t) * (q.p[i].start - o) + t * (q.p[i].end - o));
  };
  return std::sqrt(q.edges ? closest_segment_segment(at(0), at(1), at(2), at(3)).squared_distance
                           : closest_on_triangle(at(0), at(1), at(2), at(3)).squared_distance);
}

/// Greatest or least of 33 distances in [from, to].
double greatest_distance(const Query& q, double from, double to) {
  double out = 0;
  for (int k = 0; k <= 32; ++k) out = std::max(out, distance_at(q, from + (to - from) * k / 32));
  return out;
}
double least_distance(const Query& q, double from, double to) {
  double out = distance_at(q, from);
  for (int k = 1; k <= 32; ++k) out = std::min(out, distance_at(q, from + (to - from) * k / 32));
  return out;
}

struct Counts {
  int n = 0, contacts = 0, certain = 0, negatives = 0, positives = 0;
};

/// All that is promised of an answer.
void compare(const Query& q, Counts& counts) {
  const auto ours = q.answer();
  const auto reference = in_integers(q);
  ++counts.n;
  counts.contacts += reference.has_value();
  if (reference && !ours) ++counts.negatives;
  if (!ours) return;
  const double negligible = 1e-9 * size_of(q);
  counts.certain += ours->certain;
  REQUIRE(ours->t_lo >= 0);
  REQUIRE(ours->t_lo <= ours->t_hi);
  REQUIRE(ours->t_hi <= 1);
  REQUIRE(std::fabs(ours->normal.norm() - 1) < 1e-9);
  if (!reference) {
    ++counts.positives;
    REQUIRE_FALSE(ours->certain);
    REQUIRE(least_distance(q, ours->t_lo, ours->t_hi) <= negligible);
    return;
  }
  REQUIRE(ours->t_lo <= reference->hi);
  if (ours->certain) REQUIRE(ours->t_hi >= reference->lo);
  if (reference->lo - ours->t_lo > 1e-6) {
    // Nearly in contact before: for as long as we say.
    REQUIRE(greatest_distance(q, ours->t_lo, std::min(ours->t_hi - 1e-9, reference->lo)) <=
            negligible);
  }
}

/// Corners found by looking for trouble, with what went wrong.
struct Found {
  const char* what;
  bool edges;
  double at[4][6];
};

const Found found[] = {
    {"edges nearly on one line: no direction was tried that tells them apart",
     true,
     {{0x1.10c0b044e9097p-38, 0x1.a5148fa66f74dp-38, -0x1.26a0a8f49a2f8p-38, 0x1.b354b719f8a54p-40,
       0x1.3dabcd5f83a39p-38, -0x1.3d2cf3aa1b18bp-38},
      {0x1.1a113b94b7d56p-38, 0x1.c04963496bd28p-38, 0x1.6b14b5f8f28fdp-37, 0x1.b91d84e4f17f3p-40,
       0x1.b863772626e93p-38, 0x1.4c71d8afa04fcp-37},
      {0x1.e392a3f249303p-39, 0x1.46a9241b8cf43p-38, 0x1.cddb405094902p-40, 0x1.615eab2622844p-39,
       0x1.126934f8394b1p-37, -0x1.56c0747b7fd99p-40},
      {0x1.17898f06398fcp-38, 0x1.b8a5c5a48e698p-38, 0x1.57e706eb3cbbdp-37, 0x1.c9cc79736a51cp-40,
       0x1.bf32f56fbd75ep-38, 0x1.34df9ac6c1737p-37}}},
    {"in a plane: doubt ended before the contact that caused it",
     false,
     {{0x1.3333333333334p-2, 0x1.3333333333334p-2, 0, -0x1.3333333333334p-2, -0x1.999999999999ap-3,
       0},
      {0, 0, 0, -0x1.3333333333334p-2, -0x1.3333333333334p-2, 0},
      {-0x1.999999999999ap-3, -0x1.999999999999ap-3, 0, 0x1.999999999999ap-3, -0x1.3333333333334p-2,
       0},
      {0x1.999999999999ap-3, 0x1.999999999999ap-3, 0, 0x1.999999999999ap-4, 0x1.3333333333334p-2,
       0}}},
    {"a plane that turns away slowly: steps did not grow, the march gave up",
     false,
     {{0x1.05f668ba4d095p-44, -0x1.396409adc0c5ep-69, -0x1.c747a884627f8p-44, 0x1.9aecc6331661bp-28,
       -0x1.e889a3168c01bp-60, -0x1.a3a5d182c84efp-24},
      {0x1.fff9cd92f1e49p-55, 0x1.e4b8e44aeb688p-36, -0x1.735237c888c3ap-57, 0x1.502f4c8c8e0f1p-71,
       0x1.8642f2a168a47p-69, -0x1.9de23c54e6badp-24},
      {0x1.d6a3f2827451p-68, -0x1.74e8236cfd1c2p-38, -0x1.aa5ddbdf9e76ep-24, 0x1.1c005b2866fd4p-74,
       -0x1.cbbe897868c9dp-25, -0x1.2f45f8a8300f6p-60},
      {0x1.db33eeb6ccb4ep-40, -0x1.f0b5ecce5607fp-31, -0x1.04fa8fdb54235p-41, 0x1.68f5094b90499p-23,
       -0x1.e88d94eca37d6p-57, -0x1.7207018201d71p-28}}},
    {"grazed by 1e-15 of the size before a true contact: only doubles were tried",
     true,
     {{0x1.0a77dd5873487p+26, -0x1.d4b8b0238e62ep+25, 0x1.20fb3acbb4304p+25, 0x1.ee06a8dbb139fp+25,
       -0x1.d4c2b9ad0b3bfp+25, 0x1.55b70f062c273p+25},
      {0x1.db89538bb4739p+25, -0x1.0a1368e2c3e63p+26, 0x1.7944a05602f66p+25, 0x1.ee3c47b7b3e65p+25,
       -0x1.d1bd3141df514p+25, 0x1.a76fc0e001caap+25},
      {0x1.facb5975d276ep+25, -0x1.090a2430b195bp+26, 0x1.97b5b696fde26p+25, 0x1.b9e2bfd920989p+25,
       -0x1.cd56fb16ec9ddp+25, 0x1.90736ad727acbp+25},
      {0x1.dcce8cd70cbfp+25, -0x1.e95382acfa897p+25, 0x1.4206977ee6322p+25, 0x1.09f177fbb5ed5p+26,
       -0x1.d6e213c6479a2p+25, 0x1.6fee02f4ca034p+25}}},
};

}  // namespace

TEST_CASE("continuous exact: random and near queries") {
  for (const bool edges : {false, true}) {
    for (const bool near : {false, true}) {
      Random r(edges ? 71 : 70, near);
      Counts c;
      const int n = test::graded_count(8000, 1000);
      for (int i = 0; i < n; ++i) {
        compare(near ? near_query(r, edges) : random_query(r, edges), c);
      }
      MESSAGE(std::string(edges ? "edge-edge, " : "vertex-face, "), (near ? "near: " : "random: "),
              c.n, " queries, ", c.contacts, " meet, ", c.certain, " certain, ", c.negatives,
              " missed, ", c.positives, " false");
      CHECK(c.negatives == 0);
      CHECK(c.positives * 10000.0 <= c.n);
      if (n < 1000) continue;
      CHECK(c.certain > 0.999 * c.contacts);
      CHECK(c.contacts > (near ? 0.999 : 0.02) * n);
    }
  }
}

TEST_CASE("continuous exact: awkward families") {
  for (int family = 0; family < hostile_families; ++family) {
    Random r(80 + uint64_t(family));
    Counts c;
    const int n = test::graded_count(1000, 25);
    for (int i = 0; i < n; ++i) {
      Query q = hostile_query(r, family, i % 2 != 0);
      rescale(r, q);
      compare(q, c);
    }
    MESSAGE(std::string(hostile_name(family)), ": ", c.n, " queries, ", c.contacts, " meet, ",
            c.certain, " certain, ", c.negatives, " missed, ", c.positives, " nearly");
    CHECK(c.negatives == 0);
    if (n >= 1000 && family != 9) CHECK(c.contacts > n / 20);
  }
}

TEST_CASE("continuous exact: queries that went wrong once") {
  for (const Found& f : found) {
    CAPTURE(f.what);
    Query q;
    q.edges = f.edges;
    for (size_t i = 0; i < 4; ++i) {
      q.p[i] = {{f.at[i][0], f.at[i][1], f.at[i][2]}, {f.at[i][3], f.at[i][4], f.at[i][5]}};
    }
    Counts c;
    compare(q, c);
    CHECK(c.negatives == 0);
    CHECK(c.positives == 0);
  }
}
