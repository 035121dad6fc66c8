// GJK and penetration depth of convex hulls against FCL (libccd), ns a query. Families: see
// convex_pair_draws.hpp; an orbit cold and from the last frame's simplex. The target column is the
// ratio to FCL that shared tables of other libraries ask for: 0.6 of the best peer cold, half of
// Coal's time for depth.
#include "engine/collision/gjk/epa.hpp"
#include "tests/bench/contest.hpp"
#include "tests/bench/convex_pair_draws.hpp"

using namespace tumble;
using namespace tumble::bench;

namespace {

double by_epa(const Query& q) {
  const auto [A, B] = placed(q);
  const GjkResult g = gjk(A, B);
  return g.status == GjkStatus::intersecting ? epa(A, B, g.simplex).depth : 0;
}

void compare(const char* title, const Candidate& peer, const Candidate& ours, size_t count,
             double target, const char* note) {
  const auto t = contest({peer, ours}, 9);
  const double each = 1e6 / double(count);
  std::printf("  %-14s FCL %8.1f ns  ours %7.1f ns  %.3f x (target %.3f)  %s", title,
              each * t[0].cpu, each * t[1].cpu, t[1].cpu / t[0].cpu, target, note);
  std::printf("  difference %.1e\n", std::abs(t[1].answer - t[0].answer) / double(count));
  std::fflush(stdout);
}

void distance(const char* title, const std::vector<Query>& all, double target) {
  long steps = 0, precise = 0;
  for (const Query& q : all) {
    const GjkResult g = by_gjk(q);
    steps += g.iterations;
    precise += g.precise;
  }
  char note[80];
  std::snprintf(note, sizeof note, "%.1f steps, %ld precise", double(steps) / double(all.size()),
                precise);
  compare(title, {"FCL", [&] { return sum(all, by_fcl); }},
          {"GJK", [&] { return sum(all, [](const Query& q) { return by_gjk(q).distance; }); }},
          all.size(), target, note);
}

void warm(const char* title, const std::vector<Query>& all, double target) {
  Simplex last;
  long steps = 0;
  const auto follow = [&](const Query& q) {
    GjkOptions options;
    options.start = &last;
    const GjkResult g = by_gjk(q, options);
    last = g.simplex;
    steps += g.iterations;
    return g.distance;
  };
  sum(all, follow);
  char note[80];
  std::snprintf(note, sizeof note, "%.1f steps", double(steps) / double(all.size()));
  compare(title, {"FCL", [&] { return sum(all, by_fcl); }},
          {"GJK", [&] { return sum(all, follow); }}, all.size(), target, note);
}

void depth(const char* title, const std::vector<Query>& all, double target) {
  long steps = 0, open = 0;
  for (const Query& q : all) {
    const auto [A, B] = placed(q);
    const EpaResult e = epa(A, B, gjk(A, B).simplex);
    steps += e.iterations;
    open += !e.converged;
  }
  char note[80];
  std::snprintf(note, sizeof note, "%.1f steps, %ld open", double(steps) / double(all.size()),
                open);
  compare(title, {"FCL", [&] { return sum(all, depth_by_fcl); }},
          {"EPA", [&] { return sum(all, by_epa); }}, all.size(), target, note);
}

}  // namespace

int main() {
  struct Size {
    int points;
    double cold, warm, shallow, deep;  // ratios to FCL
  };
  // peers' shared table: cold 140/350/1100/2500 where FCL has 1180/1922/4961/9264; Coal's depth
  // 2063/2925 ... 10941/29768 where FCL has 4606/11500 ... 29187/157202
  for (const Size& s : {Size{8, .119, .062, .224, .127}, Size{32, .182, .045, .22, .12},
                        Size{128, .222, .053, .20, .11}, Size{512, .270, .040, .187, .095}}) {
    Random r{uint64_t(s.points)};
    std::vector<Body> bodies;
    for (int i = 0; i < 32; ++i) bodies.push_back(body(r, s.points));
    std::printf("%d points\n", s.points);
    distance("apart", queries(r, bodies, Family::sep, 1024), s.cold);
    distance("near", queries(r, bodies, Family::near, 1024), s.cold);
    distance("overlapping", queries(r, bodies, Family::deep, 1024), s.cold);
    const auto orbit = orbits(r, bodies, 4, 628);
    distance("orbit, cold", orbit, s.cold);
    warm("orbit, warm", orbit, s.warm);
    depth("depth, shallow", queries(r, bodies, Family::shallow, 256), s.shallow);
    depth("depth, deep", queries(r, bodies, Family::deep, 256), s.deep);
  }
}
