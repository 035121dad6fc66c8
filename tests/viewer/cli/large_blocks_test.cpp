// Memory that is made ahead of a software renderer's targets. Reference: mincore, by which the
// system itself says which pages are there.
#include "viewer/app/large_blocks.hpp"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <thread>
#include <vector>

#include <doctest/doctest.h>
#include <sys/mman.h>
#include <unistd.h>

using namespace tumble;

namespace {

constexpr size_t megabyte = size_t{1} << 20;

/// Share of a block's pages that are in memory.
double share_there(void* block, size_t size) {
  std::vector<unsigned char> pages(size / size_t(sysconf(_SC_PAGESIZE)));
  REQUIRE(mincore(block, size, pages.data()) == 0);
  return double(std::ranges::count_if(pages, [](unsigned char p) { return p & 1; })) /
         double(pages.size());
}

void* ask(size_t size, size_t alignment = 64) {
  void* block = nullptr;
  REQUIRE(posix_memalign(&block, alignment, size) == 0);
  CHECK(reinterpret_cast<size_t>(block) % alignment == 0);
  return block;
}

}  // namespace

TEST_CASE("blocks made ahead are there when they are asked for, each once, and no others") {
  constexpr size_t size = 6 * megabyte;
  for (const bool at_once : {false, true}) {
    const BlocksAhead ahead({size, size, 4 * megabyte, 0, 1000});
    if (!at_once) std::this_thread::sleep_for(std::chrono::milliseconds(300));
    void* first = ask(size);
    void* second = ask(size - 100, 4096);  // its last large page is used whole
    if (!at_once) {
      CHECK(share_there(first, size) == 1);
      CHECK(share_there(second, size - megabyte) == 1);
    }
    void* third = ask(size);
    void* other = ask(8 * megabyte);
    CHECK(third != first);
    CHECK(third != second);
    CHECK(share_there(other, 8 * megabyte) == 0);
    for (void* block : {first, second, third, other}) {
      static_cast<char*>(block)[0] = 1;
      static_cast<char*>(block)[size - 101] = 1;
      std::free(block);
    }
  }
}

TEST_CASE("no block is made ahead of a picture that may be refused, and none stays behind") {
  { const BlocksAhead none(blocks_of_picture(16384, 16384, Quality::high)); }
  void* block = ask(16 * megabyte);
  CHECK(share_there(block, 16 * megabyte) == 0);
  std::free(block);
}
