// Same bits for every number of threads, and save, load, step equals step. Reference: the run on
// one thread, byte for byte.
#include "tests/dynamics/piles.hpp"

using namespace tumble;
using namespace tumble::test;

namespace {

std::vector<uint64_t> hashes(int threads, std::string_view broad_phase, int ticks) {
  RigidWorld w(60, threads, broad_phase);
  add_mixed_pile(w, 120);
  // A second island, and something fast.
  for (int i = 0; i < 4; ++i) w.add(body(box(0.5, 0.5, 0.5), {10, 0.5 + i, 0}));
  BodyDef bullet = body(sphere(0.05), {30, 2, 0});
  bullet.velocity = {-300, 0, 0};
  w.add(bullet);
  std::vector<uint64_t> out;
  for (int k = 0; k < ticks; ++k) {
    w.step();
    out.push_back(w.hash());
  }
  return out;
}

}  // namespace

TEST_CASE("1, 2 and 4 threads give the same bits, with any broad phase") {
  const int ticks = scaled(120, 20);
  const std::vector<uint64_t> one = hashes(1, "uniform_grid", ticks);
  CHECK(hashes(2, "uniform_grid", ticks) == one);
  CHECK(hashes(4, "uniform_grid", ticks) == one);
  for (const BroadPhaseEntry& entry : all_broad_phases()) {
    CAPTURE(entry.name);
    CHECK(hashes(1, entry.name, ticks) == one);
  }
}

TEST_CASE("contacts survive the way to bytes and back") {
  RigidWorld a;
  add_mixed_pile(a, 40);
  a.run(1);
  REQUIRE(a.contacts.size() > 20);
  ByteWriter out;
  a.contacts.save(out);
  RigidWorld b;
  b.bodies = a.bodies;
  ByteReader in(out.bytes());
  REQUIRE(b.contacts.load(in, uint32_t(b.bodies.size())));
  CHECK(in.remaining() == 0);
  for (int k = 0; k < 20; ++k) {
    a.step();
    b.step();
    CHECK(a.hash() == b.hash());
  }
}

TEST_CASE("bytes that are cut short or name bodies that are not there are refused") {
  RigidWorld a;
  add_mixed_pile(a, 20);
  a.run(1);
  ByteWriter out;
  a.contacts.save(out);
  ContactSet set;
  for (size_t n = 0; n < out.bytes().size(); n += 97) {
    ByteReader in(std::span(out.bytes()).first(n));
    CHECK_FALSE(set.load(in, uint32_t(a.bodies.size())));
    CHECK(set.size() == 0);
  }
  ByteReader in(out.bytes());
  CHECK_FALSE(set.load(in, 3));
}

TEST_CASE("a body that breaks down is named with its contact") {
  RigidWorld w;
  w.floor();
  w.add(body(box(0.5, 0.5, 0.5), {0, 0.5, 0}));
  w.run(0.1);
  w.bodies[1].force = {std::numeric_limits<double>::infinity(), 0, 0};
  const auto solved =
      w.solver.step(w.bodies, w.contacts, w.islands, w.gravity, w.h, w.settings, w.crew);
  REQUIRE_FALSE(solved.ok());
  CHECK(solved.error().code == ErrorCode::numeric);
  CHECK(solved.error().place == "body 1");
  CHECK(solved.error().message.find("with body 1 shape 0") != std::string::npos);
}
