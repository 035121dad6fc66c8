// Reference: a list of all that was put away, of which the piles are found anew for every question
// by walking from body to body. Sums are of integers and of numbers that are given: exact.
#include "engine/dynamics/contact/resting_contacts.hpp"

#include "engine/core/random.hpp"
#include "tests/support/test_world.hpp"

#include <algorithm>
#include <set>

#include <doctest/doctest.h>

using namespace tumble;
using test::scaled;

namespace {

constexpr uint32_t body_count = 24;

Contact contact(uint32_t a, uint32_t b, uint64_t part, int count, double depth) {
  Contact c;
  static_cast<ContactHead&>(c) = {};
  c.key = {std::min(a, b), 0, std::max(a, b), 0, part};
  c.count = count;
  for (int i = 0; i < count; ++i) {
    c.points[size_t(i)] = {};
    c.points[size_t(i)].gap = i == 0 ? -depth : 1;
  }
  return c;
}

std::vector<ContactKey> keys(const ContactKnowledge& known) {
  std::vector<ContactKey> out;
  for (const Contact& c : known.contacts) out.push_back(c.key);
  for (const CachedPair& s : known.seen) out.push_back(s.pair);
  std::ranges::sort(out);
  return out;
}

/// Every third body is fixed.
struct Model {
  std::vector<RigidBody> bodies{body_count};
  ContactKnowledge known;

  Model() {
    for (uint32_t i = 0; i < body_count; i += 3) bodies[i].type = BodyType::fixed;
  }
  template <class F>
  void each_key(const F& f) const {
    for (const Contact& c : known.contacts) f(c.key);
    for (const CachedPair& s : known.seen) f(s.pair);
  }
  bool holds(uint32_t body) const {
    bool found = false;
    each_key([&](const ContactKey& k) { found |= k.body_a == body || k.body_b == body; });
    return found && bodies[body].dynamic();
  }
  /// Dynamic bodies that can be reached from some.
  std::set<uint32_t> reach(std::set<uint32_t> from) const {
    for (size_t before = 0; before != from.size();) {
      before = from.size();
      each_key([&](const ContactKey& k) {
        if (!bodies[k.body_a].dynamic() || !bodies[k.body_b].dynamic()) return;
        if (from.contains(k.body_a) || from.contains(k.body_b)) from.insert({k.body_a, k.body_b});
      });
    }
    return from;
  }
  ContactKnowledge take(const std::set<uint32_t>& from) {
    const std::set<uint32_t> pile = reach(from);
    const auto in = [&](const ContactKey& k) {
      return (bodies[k.body_a].dynamic() && pile.contains(k.body_a)) ||
             (bodies[k.body_b].dynamic() && pile.contains(k.body_b));
    };
    ContactKnowledge out;
    std::erase_if(known.contacts, [&](const Contact& c) {
      if (in(c.key)) out.contacts.push_back(c);
      return in(c.key);
    });
    std::erase_if(known.seen, [&](const CachedPair& s) {
      if (in(s.pair)) out.seen.push_back(s);
      return in(s.pair);
    });
    return out;
  }
  /// Dynamic bodies of pairs with this one.
  std::set<uint32_t> beside(uint32_t body) const {
    std::set<uint32_t> out;
    each_key([&](const ContactKey& k) {
      if (k.body_a != body && k.body_b != body) return;
      for (const uint32_t end : {k.body_a, k.body_b})
        if (bodies[end].dynamic()) out.insert(end);
    });
    return out;
  }
};

struct Both {
  Random r;
  Model model;
  RestingContacts resting;
  uint64_t next_part = 0;

  explicit Both(uint64_t seed) : r(seed) {}
  uint32_t any() { return uint32_t(r.below(body_count)); }

  void add() {
    ContactKnowledge news;
    for (uint64_t k = r.below(5); k-- > 0;) {
      const uint32_t a = any(), b = any();
      if (a == b || (a % 3 == 0 && b % 3 == 0)) continue;
      if (r.below(3) == 0)
        news.seen.push_back({{std::min(a, b), uint32_t(next_part++), std::max(a, b), 0, 0}, {}, 1});
      else
        news.contacts.push_back(contact(a, b, next_part++, int(r.below(5)), double(r.below(9))));
    }
    if (news.empty()) return;
    news.sort();
    resting.add(news, model.bodies);
    model.known.append(news);
    model.known.sort();
  }
  void take() {
    const uint32_t body = any();
    ContactKnowledge out;
    const bool held = model.holds(body);
    CHECK(resting.take(body, out) == held);
    CHECK(keys(out) == keys(held ? model.take({body}) : ContactKnowledge{}));
  }
  void take_all_of() {
    const uint32_t body = any();
    ContactKnowledge out;
    resting.take_all_of(std::span(&body, 1), out);
    CHECK(keys(out) == keys(model.take(model.beside(body))));
  }
  void check() {
    uint64_t points = 0;
    double deepest = 0;
    for (const Contact& c : model.known.contacts) {
      points += uint64_t(c.count);
      for (const ContactPoint& p : c.used()) deepest = std::max(deepest, -p.gap);
    }
    CHECK(resting.contacts() == model.known.contacts.size());
    CHECK(resting.points() == points);
    CHECK(resting.max_penetration() == deepest);
    CHECK(resting.empty() == model.known.empty());
    for (uint32_t body = 0; body < body_count; ++body)
      CHECK(resting.holds(body) == model.holds(body));
    ContactKnowledge all;
    resting.for_piles([&](const ContactKnowledge& pile) {
      CHECK(std::ranges::is_sorted(pile.contacts, {}, &Contact::key));
      CHECK(std::ranges::is_sorted(pile.seen, {}, &CachedPair::pair));
      CHECK(std::is_sorted(pile.pieces.begin(), pile.pieces.end()));
      all.append(pile);
    });
    CHECK(keys(all) == keys(model.known));
  }
};

}  // namespace

TEST_CASE("resting contacts are those of a list, put away and taken by pile, and undone by tick") {
  uint64_t undone = 0, most = 0;
  const int histories = scaled(100);
  for (int k = 0; k < histories; ++k) {
    Both both{uint64_t(k + 1)};
    both.resting.begin_tick();
    Model start = both.model;
    for (int change = 0; change < 80; ++change) {
      switch (both.r.below(8)) {
        case 0:
          both.take();
          break;
        case 1:
          both.take_all_of();
          break;
        case 2:
          both.resting.begin_tick();
          start = both.model;
          break;
        case 3:
          undone += keys(start.known) != keys(both.model.known);
          both.resting.go_back();
          both.model = start;
          break;
        case 4:
          if (both.r.below(6) > 0) break;
          both.resting.drop();
          both.model.known.clear();
          break;
        default:
          both.add();
      }
      most = std::max(most, uint64_t(both.model.known.contacts.size()));
      both.check();
    }
  }
  CHECK(undone > uint64_t(histories));
  CHECK(most > 4);
}
