#include "engine/dynamics/particles/neighbours/neighbour_lists.hpp"

#include "engine/core/random.hpp"
#include "tests/support/scale.hpp"

#include <algorithm>
#include <cmath>

#include <doctest/doctest.h>

using namespace tumble;

namespace {

std::vector<Vec3> cloud(Random& r, size_t n, const Vec3& low, const Vec3& size) {
  std::vector<Vec3> x(n);
  for (Vec3& p : x)
    p = low + Vec3(r.uniform() * size[0], r.uniform() * size[1], r.uniform() * size[2]);
  return x;
}

/// For every point the distances of all that are within reach, copies in a periodic box included.
std::vector<std::vector<double>> all_pairs(std::span<const Vec3> x, double reach,
                                           const PeriodicBox& box) {
  std::vector<std::vector<double>> near(x.size());
  const int last[3] = {box.along(0) ? 1 : 0, box.along(1) ? 1 : 0, box.along(2) ? 1 : 0};
  for (size_t a = 0; a < x.size(); ++a)
    for (size_t b = 0; b < x.size(); ++b)
      for (int i = -last[0]; i <= last[0]; ++i)
        for (int j = -last[1]; j <= last[1]; ++j)
          for (int k = -last[2]; k <= last[2]; ++k) {
            if (a == b && i == 0 && j == 0 && k == 0) continue;
            const Vec3 shift(i * box.size[0], j * box.size[1], k * box.size[2]);
            const double d = (box.wrapped(x[b]) + shift - box.wrapped(x[a])).norm();
            if (d <= reach) near[a].push_back(d);
          }
  for (auto& n : near) std::ranges::sort(n);
  return near;
}

/// The same from lists, which may hold more than is within reach, but nothing twice.
std::vector<std::vector<double>> from_lists(const NeighbourLists& lists, double reach) {
  std::vector<std::vector<double>> near(lists.size());
  for (size_t p = 0; p < lists.size(); ++p) {
    const auto of = lists.of(p);
    REQUIRE(of.size() % NeighbourLists::batch == 0);
    REQUIRE(of.size() < lists.count(p) + NeighbourLists::batch);
    for (size_t k = 0; k < of.size(); ++k) {
      const uint32_t q = of[k];
      const double d = Vec3(lists.x()[q] - lists.x()[p], lists.y()[q] - lists.y()[p],
                            lists.z()[q] - lists.z()[p])
                           .norm();
      if (d <= reach) near[lists.order()[p]].push_back(d);
      CHECK((k < lists.count(p) || d > 10 * reach));
    }
  }
  for (auto& n : near) std::ranges::sort(n);
  return near;
}

void check_same(const std::vector<std::vector<double>>& a,
                const std::vector<std::vector<double>>& b) {
  REQUIRE(a.size() == b.size());
  for (size_t i = 0; i < a.size(); ++i) {
    REQUIRE(a[i].size() == b[i].size());
    for (size_t k = 0; k < a[i].size(); ++k)
      CHECK(a[i][k] == doctest::Approx(b[i][k]).epsilon(1e-9));
  }
}

}  // namespace

TEST_CASE("neighbour lists hold what all pairs of points give, in periodic boxes too") {
  Random r(71);
  for (int n = 0; n < test::scaled_count(60, 6); ++n) {
    const Vec3 low(r.uniform(-50, 50), r.uniform(-50, 50), r.uniform(-50, 50));
    const Vec3 size(r.uniform(0.5, 4), r.uniform(0.5, 4), r.uniform(0.5, 4));
    NeighbourLists::Request request{.reach = r.uniform(0.05, 0.4), .skin = r.uniform(0, 0.1)};
    if (n % 2 == 1) {
      request.box.low = low;
      for (int k = 0; k < 3; ++k) request.box.size[k] = r.uniform() < 0.7 ? size[k] : 0;
    }
    // Outside the box as well, where it is periodic.
    std::vector<Vec3> x = cloud(r, 1 + r.below(400), low - 0.3 * size, 1.6 * size);
    if (x.size() > 5) x[3] = x[4];
    NeighbourLists lists;
    REQUIRE(lists.update(x, request, nullptr).value());
    check_same(from_lists(lists, request.reach), all_pairs(x, request.reach, request.box));
    // Less than half of the skin, and a copy elsewhere: lists stay.
    for (Vec3& p : x)
      p += 0.28 * request.skin * Vec3(r.uniform(-1, 1), r.uniform(-1, 1), r.uniform(-1, 1));
    if (request.box.along(0)) x[0][0] += 3 * request.box.size[0];
    CHECK(lists.update(x, request, nullptr).value() == (request.skin == 0));
    check_same(from_lists(lists, request.reach), all_pairs(x, request.reach, request.box));
    x[x.size() / 2] += Vec3(0, request.skin, 0);
    CHECK(lists.update(x, request, nullptr).value());
    check_same(from_lists(lists, request.reach), all_pairs(x, request.reach, request.box));
  }
}

TEST_CASE("the list of a group holds what is in reach of any of its points, and these") {
  Random r(23);
  for (int n = 0; n < test::scaled_count(20, 4); ++n) {
    const NeighbourLists::Request request{
        .reach = r.uniform(0.1, 0.4), .skin = r.uniform(0, 0.1), .box = {}, .by_group = true};
    std::vector<Vec3> x =
        cloud(r, 1 + r.below(500), {-1, 3, -2}, {r.uniform(0.1, 2), r.uniform(0.1, 2), 1});
    NeighbourLists lists;
    REQUIRE(lists.update(x, request, nullptr).value());
    // Lists stay when points move by less than half of the skin.
    for (Vec3& p : x)
      p += 0.28 * request.skin * Vec3(r.uniform(-1, 1), r.uniform(-1, 1), r.uniform(-1, 1));
    CHECK(lists.update(x, request, nullptr).value() == (request.skin == 0));
    const double longest = std::sqrt(3.0) * (request.reach + 2 * request.skin);
    uint32_t next = 0;
    for (const NeighbourLists::Group& g : lists.groups()) {
      CHECK(g.first == next);
      REQUIRE(g.count > 0);
      REQUIRE(g.count <= NeighbourLists::group_size);
      next += g.count;
      const auto at = [&](size_t p) { return x[lists.order()[p]]; };
      std::vector<uint32_t> found;
      for (const uint32_t q : lists.of(g))
        if (q + 1 < lists.places()) found.push_back(q);
      CHECK(lists.of(g).size() % NeighbourLists::group_size == 0);
      CHECK(lists.of(g).size() < found.size() + NeighbourLists::group_size);
      std::ranges::sort(found);
      CHECK(std::ranges::adjacent_find(found) == found.end());
      for (uint32_t p = g.first; p < g.first + g.count; ++p) {
        CHECK((at(p) - at(g.first)).norm() < longest);
        CHECK(std::ranges::binary_search(found, p));
        for (uint32_t q = 0; q < lists.size(); ++q)
          if ((at(q) - at(p)).norm() <= request.reach) CHECK(std::ranges::binary_search(found, q));
      }
    }
    CHECK(next == x.size());
  }
}

TEST_CASE("neighbour lists are the same for any number of threads") {
  Random r(5);
  const std::vector<Vec3> x = cloud(r, 20000, Vec3::Zero(), Vec3::Constant(3));
  const NeighbourLists::Request request{.reach = 0.15, .skin = 0.02};
  NeighbourLists alone;
  REQUIRE(alone.update(x, request, nullptr));
  for (const int threads : {1, 2, 4}) {
    Crew crew(threads);
    NeighbourLists lists;
    REQUIRE(lists.update(x, request, &crew));
    CHECK(std::ranges::equal(lists.order(), alone.order()));
    bool same = true;
    for (size_t p = 0; p < lists.size(); ++p)
      same = same && std::ranges::equal(lists.of(p), alone.of(p));
    CHECK(same);
  }
}

TEST_CASE(
    "neighbour lists by index: what is in reach, and where, tells nothing of when they were made") {
  Random r(13);
  for (int n = 0; n < test::scaled_count(30, 4); ++n) {
    const Vec3 low(-3, 1, 2), size(1.1, 0.9, 1.3);
    NeighbourLists::Request kept{.reach = 0.3, .skin = 0.2, .by_index = true}, anew = kept;
    if (n % 2 == 0) kept.box = {low, size};
    if (n % 2 == 0 && n % 3 == 0) kept.box.size = {0.55, 0, 1.3};  // several copies of one point
    anew.box = kept.box;
    anew.skin = r.uniform(0, 0.1);
    std::vector<Vec3> x = cloud(r, 1 + r.below(300), low - 0.3 * size, 1.6 * size);
    NeighbourLists old_lists, new_lists;
    REQUIRE(old_lists.update(x, kept, nullptr).value());
    for (Vec3& p : x) p += 0.057 * Vec3(r.uniform(-1, 1), r.uniform(-1, 1), r.uniform(-1, 1));
    REQUIRE_FALSE(old_lists.update(x, kept, nullptr).value());
    REQUIRE(new_lists.update(x, anew, nullptr).value());
    // By the caller's index: others in reach in the order of the list, and where they are exactly.
    struct Seen {
      uint32_t index;
      Vec3 away;
      bool before;
    };
    const auto seen = [&](const NeighbourLists& lists) {
      std::vector<std::vector<Seen>> out(x.size());
      for (size_t p = 0; p < lists.size(); ++p)
        for (size_t k = 0; k < lists.count(p); ++k) {
          const uint32_t q = lists.of(p)[k];
          const Vec3 d = lists.beside(p, q) - lists.beside(p, p);
          if (!lists.strayed(p))
            CHECK(d == Vec3(lists.x()[q], lists.y()[q], lists.z()[q]) -
                           Vec3(lists.x()[p], lists.y()[p], lists.z()[p]));
          if (d.norm() > kept.reach) continue;
          const uint32_t owner = q < lists.size() ? q : lists.ghost_owners()[q - lists.size()];
          out[lists.order()[p]].push_back({lists.order()[owner], d, k < lists.before(p)});
        }
      return out;
    };
    const auto a = seen(old_lists), b = seen(new_lists);
    size_t first = 0, all = 0;
    for (size_t i = 0; i < x.size(); ++i) {
      REQUIRE(a[i].size() == b[i].size());
      for (size_t k = 0; k < a[i].size(); ++k) {
        CHECK(a[i][k].index == b[i][k].index);
        CHECK(a[i][k].away == b[i][k].away);
        CHECK(a[i][k].before == b[i][k].before);
        CHECK((k == 0 || a[i][k - 1].index <= a[i][k].index));
        first += a[i][k].before ? 1 : 0;
        ++all;
      }
    }
    CHECK(2 * first == all);
  }
}

TEST_CASE("neighbour lists of points in one spot, of points far apart, and of none") {
  NeighbourLists lists;
  const NeighbourLists::Request request{.reach = 1};
  REQUIRE(lists.update({}, request, nullptr));
  CHECK(lists.size() == 0);
  std::vector<Vec3> x(50, Vec3(1e3, -7, 2));
  REQUIRE(lists.update(x, request, nullptr));
  for (size_t p = 0; p < 50; ++p) CHECK(lists.count(p) == 49);
  // Cells that are the same modulo 2^21.
  const double turn = double(1 << 21);
  x = {Vec3(0.5, 0, 0), Vec3(turn + 0.5, 0, 0), Vec3(0.7, 0, 0), Vec3(turn + 0.9, 0, 0),
       Vec3(turn + 1.1, 0, 0)};
  REQUIRE(lists.update(x, request, nullptr));
  check_same(from_lists(lists, 1), all_pairs(x, 1, {}));
}

TEST_CASE("neighbour lists refuse what has no answer") {
  NeighbourLists lists;
  const std::vector<Vec3> x{Vec3::Zero(), Vec3(0, INFINITY, 0)};
  CHECK_FALSE(lists.update(x, {.reach = 1}, nullptr));
  CHECK_FALSE(lists.update(std::vector<Vec3>{Vec3(1e300, 0, 0)}, {.reach = 1}, nullptr));
  CHECK_FALSE(lists.update({}, {.reach = 0}, nullptr));
  CHECK_FALSE(lists.update({}, {.reach = NAN}, nullptr));
  PeriodicBox box;
  box.size = Vec3(0.5, 0, 0);
  CHECK_FALSE(lists.update({}, {.reach = 1, .box = box}, nullptr));
}

TEST_CASE("points lined up are in the order in which cells sort them") {
  Random r(9);
  const std::vector<Vec3> x = cloud(r, 3000, {-4, 1, -2}, {7, 3, 5});
  CellOrder sorted, lined_up;
  sorted.sort(x, 0.4);
  lined_up.line_up(x, 0.4);
  CHECK(std::ranges::equal(sorted.order(), lined_up.order()));
  CHECK(lined_up.cells().empty());
}

TEST_CASE("points are sorted alike on any threads, and those of a cell stay in their order") {
  Random r(10);
  const double size = 0.1;
  const std::vector<Vec3> x = cloud(r, 30000, {-4, 1, -2}, {4, 2, 3});
  CellOrder alone;
  alone.sort(x, size);
  for (const int threads : {1, 3}) {
    Crew crew(threads);
    CellOrder sorted;
    sorted.sort(x, size, &crew);
    CHECK(std::ranges::equal(sorted.order(), alone.order()));
    CHECK(sorted.cells().back().end == x.size());
    bool ascending = true, inside = true;
    for (const CellOrder::Cell& cell : sorted.cells())
      for (uint32_t k = cell.first; k < cell.end; ++k) {
        const uint32_t p = sorted.order()[k];
        ascending = ascending && (k == cell.first || sorted.order()[k - 1] < p);
        const auto at = [&](int axis) { return int64_t(std::floor(x[p][axis] / size)); };
        inside = inside && cell.at(at(0), at(1), at(2));
      }
    CHECK(ascending);
    CHECK(inside);
  }
}
