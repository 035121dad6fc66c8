// Distance of convex polyhedra, ns a query: hulls of N points on ellipsoids with semi-axes in
// (0.5, 1.5), 32 shapes for each N. Families: gap U(0.1, 2); gap 1e-3 along the exact normal; deep
// (centres 0.3 apart); an orbit at radius 3.2 that moves 0.01 rad and turns half a degree a frame,
// cold and from the last frame's features. Rotation matrices are given to all.
#include "tests/bench/contest.hpp"
#include "tests/bench/convex_pair_draws.hpp"

using namespace tumble;
using namespace tumble::bench;

namespace {

void compare(const char* title, const std::vector<bench::Candidate>& candidates, size_t count,
             const char* note = "") {
  const auto timings = bench::contest(candidates, 9);
  std::printf("  %-12s", title);
  for (size_t i = 0; i < candidates.size(); ++i)
    std::printf("  %s %7.1f ns", candidates[i].name.c_str(),
                1e6 * timings[i].milliseconds / double(count));
  const double error = std::abs(timings.back().answer - timings[0].answer) / double(count);
  std::printf("  %.3f x%s%s\n", timings.back().milliseconds / timings[0].milliseconds, note,
              error < 1e-5 ? "" : "  ANSWERS DIFFER");
  std::fflush(stdout);
}

void cold(const char* title, const std::vector<Query>& all) {
  long steps = 0;
  for (const Query& q : all) steps += by_v_clip(q).steps;
  char note[64];
  std::snprintf(note, sizeof note, "  %.1f steps", double(steps) / double(all.size()));
  compare(
      title,
      {{"FCL", [&] { return sum(all, by_fcl); }},
       {"GJK", [&] { return sum(all, [](const Query& q) { return by_gjk(q).distance; }); }},
       {"V-Clip", [&] { return sum(all, [](const Query& q) { return by_v_clip(q).distance; }); }}},
      all.size(), note);
}

void warm(const char* title, const std::vector<Query>& all) {
  ClosestFeatures last;
  Vec3 normal;
  long steps = 0;
  VClipOptions options;
  options.start = &last;
  const auto follow = [&](const Query& q) {
    const VClipResult v = by_v_clip(q, options);
    last = v.features;
    steps += v.steps;
    return v.distance;
  };
  sum(all, follow);
  char note[64];
  std::snprintf(note, sizeof note, "  %.2f steps", double(steps) / double(all.size()));
  compare(title,
          {{"FCL", [&] { return sum(all, by_fcl); }},
           {"GJK",
            [&] {
              normal.setZero();
              return sum(all, [&](const Query& q) {
                GjkOptions from_last;
                from_last.initial_direction = normal;
                const GjkResult g = by_gjk(q, from_last);
                normal = g.normal;
                return g.distance;
              });
            }},
           {"V-Clip",
            [&] {
              last = {};
              return sum(all, follow);
            }}},
          all.size(), note);
}

}  // namespace

int main() {
  for (const int n : {8, 32, 128, 512}) {
    Random r{uint64_t(n)};
    std::vector<Body> bodies;
    for (int i = 0; i < 32; ++i) bodies.push_back(body(r, n));
    std::printf("%d points (last figure: V-Clip over FCL)\n", n);
    cold("apart", queries(r, bodies, Family::sep, 1024));
    cold("near", queries(r, bodies, Family::near, 1024));
    cold("deep", queries(r, bodies, Family::deep, 1024));
    const auto orbit = orbits(r, bodies, 4, 628);
    cold("orbit, cold", orbit);
    warm("orbit, warm", orbit);
  }
}
