// Objects that are used again. Reference: addresses, and a count of the live objects.
#include "engine/core/recycler.hpp"

#include "engine/core/profiler.hpp"

#include <atomic>
#include <optional>
#include <thread>

#include <doctest/doctest.h>

using namespace tumble;

namespace {

struct Counted {
  inline static std::atomic<int> live{0};
  Counted() { ++live; }
  ~Counted() { --live; }
  std::vector<int> numbers;
};

}  // namespace

TEST_CASE("an object comes back only when nobody holds it, as it was left") {
  Recycler<Counted> recycler;
  auto a = recycler.get();
  a->numbers.assign(100, 7);
  const Counted* const place = a.get();
  std::shared_ptr<const Counted> reader = a;
  a.reset();
  CHECK(recycler.get().get() != place);
  CHECK(reader->numbers.size() == 100);
  const std::weak_ptr<const Counted> watcher = reader;
  reader.reset();
  CHECK(watcher.expired());
  CHECK(recycler.get().get() != place);  // who watches holds the counts, which are in the object
}

TEST_CASE("idle objects are as many as was said, and go with the recycler or after it") {
  {
    std::optional<Recycler<Counted>> recycler(std::in_place, 2);
    std::vector<std::shared_ptr<Counted>> held;
    for (int i = 0; i < 5; ++i) held.push_back(recycler->get());
    CHECK(Counted::live == 5);
    const Counted* const last = held.back().get();
    held.resize(1);
    CHECK(Counted::live == 3);
    const auto again = recycler->get();
    CHECK(Counted::live == 3);
    CHECK(again.get() != last);  // it came when two were there
    recycler.reset();
    held[0]->numbers.push_back(1);  // outlives it
  }
  CHECK(Counted::live == 0);
}

TEST_CASE("objects may be let go on another thread") {
  Recycler<std::vector<int>> recycler;
  for (int i = 0; i < 200; ++i) {
    const auto made = recycler.get();
    made->assign(50, i);
    std::jthread reader(
        [seen = std::shared_ptr<const std::vector<int>>(made), i] { CHECK(seen->back() == i); });
  }
}

TEST_CASE("times of more stages than there is room for go to the last one") {
  static constexpr std::string_view names = "abcdefghijklmnopqrstuvwxyz";
  StageTimes times;
  for (size_t i = 0; i < names.size(); ++i) times.add(names.substr(i, 1), 1);
  times.add("b", 2);
  CHECK(times.size() == StageTimes::most);
  CHECK(times.begin()[1].seconds == 3);
  CHECK((times.end() - 1)->name == names.substr(StageTimes::most - 1, 1));
  double sum = 0;
  for (const StageTime& s : times) sum += s.seconds;
  CHECK(sum == double(names.size()) + 2);
}
