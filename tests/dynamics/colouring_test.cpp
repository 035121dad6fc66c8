// Colouring of contact graphs. Reference: the definition, checked edge by edge, and the bound of
// the greedy rule, one colour less than the degrees of both ends together.
#include "engine/dynamics/realtime/wide/colouring.hpp"

#include "tests/dynamics/piles.hpp"

#include <algorithm>

using namespace tumble;
using namespace tumble::test;

namespace {

struct Graph {
  uint32_t nodes = 0;
  std::vector<ColourEdge> edges;

  std::vector<uint32_t> degrees() const {
    std::vector<uint32_t> degree(nodes);
    for (const ColourEdge& e : edges)
      for (const uint32_t end : {e.a, e.b})
        if (end != ColourEdge::fixed) ++degree[end];
    return degree;
  }
};

/// Edges between random nodes; one in ten ends at what is fixed.
Graph random_graph(Random& random, uint32_t nodes, size_t edges) {
  Graph g{nodes, {}};
  const auto node = [&] { return std::min(nodes - 1, uint32_t(random.uniform(0, nodes))); };
  while (g.edges.size() < edges) {
    ColourEdge e{node(), node()};
    if (random.uniform(0, 1) < 0.1) e.a = ColourEdge::fixed;
    if (e.a != e.b) g.edges.push_back(e);
  }
  return g;
}

/// Every edge once, ascending within its colour, no node twice in a colour; what is left over
/// finds every colour taken at its ends.
void check_colouring(const Graph& g, const Colouring& c) {
  std::vector<int> seen(g.edges.size());
  std::vector<uint32_t> taken(g.nodes);
  for (uint32_t k = 0; k < c.colours(); ++k) {
    std::vector<bool> here(g.nodes);
    uint32_t last = 0;
    CHECK(!c.of(k).empty());
    for (const uint32_t i : c.of(k)) {
      CHECK(i >= last);
      last = i;
      ++seen[i];
      for (const uint32_t end : {g.edges[i].a, g.edges[i].b}) {
        if (end == ColourEdge::fixed) continue;
        CHECK(!here[end]);
        here[end] = true;
        taken[end] |= uint32_t{1} << k;
      }
    }
  }
  for (const uint32_t i : c.left_over()) {
    ++seen[i];
    uint32_t both = 0;
    for (const uint32_t end : {g.edges[i].a, g.edges[i].b})
      if (end != ColourEdge::fixed) both |= taken[end];
    CHECK(both == ~uint32_t{0});
  }
  for (const int n : seen) CHECK(n == 1);
}

}  // namespace

TEST_CASE("no two edges of a colour share a node, and greedy needs no more than it may") {
  Random random(11);
  int crowded = 0;
  Colouring c;  // one for all: what an earlier graph leaves behind must not show
  for (int round = 0; round < scaled(400, 40); ++round) {
    const auto nodes = uint32_t(random.uniform(2, 200));
    const Graph g = random_graph(random, nodes, size_t(random.uniform(1, 25) * nodes));
    c.assign(g.edges, g.nodes);
    check_colouring(g, c);
    const std::vector<uint32_t> degree = g.degrees();
    uint32_t bound = 0;
    for (const ColourEdge& e : g.edges) {
      uint32_t both = 0;
      for (const uint32_t end : {e.a, e.b})
        if (end != ColourEdge::fixed) both += degree[end];
      bound = std::max(bound, e.a == ColourEdge::fixed ? both : both - 1);
    }
    CHECK(c.colours() <= bound);
    crowded += !c.left_over().empty();
    Colouring again;
    again.assign(g.edges, g.nodes);
    for (uint32_t k = 0; k < c.colours(); ++k) CHECK(std::ranges::equal(again.of(k), c.of(k)));
  }
  CHECK(crowded > 0);
}

TEST_CASE("a star has as many colours as edges, a chain two, fixed ends cost nothing") {
  Colouring c;
  Graph star{41, {}};
  for (uint32_t i = 1; i <= 40; ++i) star.edges.push_back({0, i});
  c.assign(star.edges, star.nodes);
  CHECK(c.colours() == Colouring::most);
  CHECK(c.left_over().size() == 40 - Colouring::most);
  check_colouring(star, c);

  Graph chain{100, {}};
  for (uint32_t i = 0; i + 1 < 100; ++i) chain.edges.push_back({i, i + 1});
  c.assign(chain.edges, chain.nodes);
  CHECK(c.colours() == 2);

  Graph floor{100, {}};
  for (uint32_t i = 0; i < 100; ++i) floor.edges.push_back({ColourEdge::fixed, i});
  c.assign(floor.edges, floor.nodes);
  CHECK(c.colours() == 1);
  CHECK(c.of(0).size() == 100);

  c.assign({}, 0);
  CHECK(c.colours() == 0);
}
