// core: handles, byte sections, hash (published XXH64 vectors), disjoint sets, name lookup.
#include "engine/core/bytes.hpp"
#include "engine/core/disjoint_sets.hpp"
#include "engine/core/handle.hpp"
#include "engine/core/hash.hpp"
#include "engine/core/random.hpp"
#include "engine/core/text.hpp"

#include <vector>

#include <doctest/doctest.h>

using namespace tumble;

TEST_CASE("a stale handle is detected after its slot is reused") {
  struct Tag;
  HandlePool<Tag> pool;
  const auto a = pool.allocate();
  const auto b = pool.allocate();
  CHECK(pool.contains(a));
  CHECK_FALSE(pool.contains({}));
  CHECK(pool.release(a));
  CHECK_FALSE(pool.release(a));
  const auto c = pool.allocate();
  CHECK(c.index == a.index);
  CHECK(c != a);
  CHECK_FALSE(pool.contains(a));
  CHECK(pool.contains(b));
  CHECK(pool.count() == 2);
}

TEST_CASE("sections: read back, truncated input fails without reading outside, first difference") {
  const auto write = [](int x) {
    ByteWriter w;
    w.begin_section("one", 3);
    w.vector(std::vector<int>{1, 2, 3});
    w.end_section();
    w.begin_section("two", 1);
    w.value(x);
    w.end_section();
    return w.take();
  };
  const Bytes bytes = write(7);
  ByteReader r(bytes);
  CHECK(r.begin_section("one") == 3);
  std::vector<int> v;
  r.vector(v);
  r.end_section();
  CHECK(v == std::vector<int>{1, 2, 3});
  CHECK(r.begin_section("two") == 1);
  CHECK(r.get<int>() == 7);
  r.end_section();
  CHECK(r.ok());
  CHECK(r.remaining() == 0);
  CHECK(first_difference(bytes, write(8)) == "two");
  CHECK(first_difference(bytes, write(7)).empty());
  for (size_t n = 0; n < bytes.size(); ++n) {
    const std::span<const std::byte> all(bytes);
    ByteReader cut(all.first(n));
    cut.begin_section("one");
    cut.vector(v);
    cut.end_section();
    cut.begin_section("two");
    cut.get<int>();
    cut.end_section();
    CHECK_FALSE(cut.ok());
  }
}

TEST_CASE("hash is XXH64: the published vector of the empty input") {
  CHECK(hash_text(hash_bytes(nullptr, 0)) == "ef46db3751d8e999");
}

TEST_CASE("random draws: PCG32's published first outputs for seed 42, stream 54") {
  Random r(42, 54);
  CHECK(r.next() == 0xa15c02b7u);
  CHECK(r.next() == 0x7b47f409u);
  CHECK(r.next() == 0xba1d3330u);
}

TEST_CASE("disjoint sets: the least member that joins lead to, by relabelling all at every join") {
  Random random(3);
  constexpr uint32_t n = 40;
  for (int round = 0; round < 50; ++round) {
    DisjointSets sets(n);
    std::vector<uint32_t> label(n);
    for (uint32_t i = 0; i < n; ++i) label[i] = i;
    for (int k = 0; k < round; ++k) {
      const auto a = uint32_t(random.uniform(0, n)), b = uint32_t(random.uniform(0, n));
      sets.join(a, b);
      const uint32_t low = std::min(label[a], label[b]), high = std::max(label[a], label[b]);
      for (uint32_t& l : label)
        if (l == high) l = low;
    }
    for (uint32_t i = 0; i < n; ++i) CHECK(sets.root(i) == label[i]);
  }
}

TEST_CASE("an unknown name gets the nearest known one") {
  const std::vector<std::string> known = {"sphere", "box", "capsule"};
  CHECK(nearest_word("shpere", known) == "sphere");
  CHECK(nearest_word("Boxx", known) == "box");
  CHECK(nearest_word("quaternion", known).empty());
  const std::vector<std::string> keys = {"angular_velocity", "velocity", "mass"};
  CHECK(nearest_word("linear_velocity", keys) == "velocity");
  CHECK(nearest_word("total_mass", keys) == "mass");
  CHECK(nearest_word("massive_body_of", keys).empty());
}
