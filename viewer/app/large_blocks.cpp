// Blocks of memory for pictures, on large pages.
#include "viewer/app/large_blocks.hpp"

#include "viewer/render/frame_setup.hpp"

#include <algorithm>
#include <cerrno>
#include <condition_variable>
#include <cstdint>
#include <cstdlib>
#include <mutex>

#include <sys/mman.h>

namespace tumble {
namespace {

/// Of a huge page on x86-64, and on most other machines [byte].
constexpr size_t huge_page = size_t{1} << 21;

/// Larger blocks are not made ahead: their pictures may yet be refused, and take far longer to draw
/// [byte].
#ifdef TUMBLE_SANITIZED
constexpr size_t most_ahead = 0;  // sanitizers have their own posix_memalign: nothing asks for them
#else
constexpr size_t most_ahead = size_t{64} << 20;
#endif

/// The last large page is used whole: a rest in small ones would cost more than its memory.
size_t in_huge_pages(size_t size) {
  return (size + huge_page - 1) / huge_page * huge_page;
}

void* make_block(size_t alignment, size_t whole) {
  void* made = std::aligned_alloc(std::max(alignment, huge_page), whole);
  // From aligned blocks of 2 MB the system makes large pages.
  if (made) madvise(made, whole, MADV_HUGEPAGE);
  return made;
}

/// What BlocksAhead makes.
struct AheadBlock {
  size_t size = 0;
  void* data = nullptr;
  enum class State { wanted, being_made, ready, taken } state = State::wanted;
};
constinit std::mutex ahead_mutex;
std::condition_variable ahead_changed;
constinit std::vector<AheadBlock>* ahead = nullptr;  ///< null: there are none
constinit int waiting = 0;                           ///< threads that wait for a block

#ifndef TUMBLE_SANITIZED
/// A block made ahead, or null. One that is being made is waited for: half of the work is done.
void* take_ahead(size_t whole) {
  std::unique_lock lock(ahead_mutex);
  if (!ahead) return nullptr;
  using State = AheadBlock::State;
  for (AheadBlock& block : *ahead) {
    if (block.size != whole || block.state == State::taken) continue;
    if (block.state == State::wanted) {  // as quick without help
      block.state = State::taken;
      return nullptr;
    }
    ++waiting;
    ahead_changed.wait(lock, [&block] { return block.state != State::being_made; });
    --waiting;
    ahead_changed.notify_all();
    if (block.state == State::taken) continue;  // by another thread that waited
    block.state = State::taken;
    return block.data;
  }
  return nullptr;
}
#endif

/// Has the system make all pages of a block.
void write_pages([[maybe_unused]] void* data, [[maybe_unused]] size_t size) {
#ifdef MADV_POPULATE_WRITE
  if (data && madvise(data, size, MADV_POPULATE_WRITE) == 0) return;
#endif
  constexpr size_t page = 4096;
  auto* bytes = static_cast<volatile char*>(data);
  for (size_t i = 0; data && i < size; i += page) bytes[i] = 0;
}

void make_all_ahead() {
  using State = AheadBlock::State;
  std::unique_lock lock(ahead_mutex);
  for (AheadBlock& block : *ahead) {
    if (block.state != State::wanted) continue;
    block.state = State::being_made;
    lock.unlock();
    block.data = make_block(huge_page, block.size);
    write_pages(block.data, block.size);
    lock.lock();
    block.state = State::ready;
    ahead_changed.notify_all();
  }
}

}  // namespace

BlocksAhead::BlocksAhead(std::vector<size_t> sizes) {
  std::vector<AheadBlock> blocks;
  for (const size_t size : sizes)
    if (size >= huge_page && size <= most_ahead)
      blocks.push_back({in_huge_pages(size), nullptr, {}});
  const std::scoped_lock lock(ahead_mutex);
  ahead = new std::vector<AheadBlock>(std::move(blocks));
  maker_ = std::thread(make_all_ahead);
}

BlocksAhead::~BlocksAhead() {
  {
    const std::scoped_lock lock(ahead_mutex);
    for (AheadBlock& block : *ahead)
      if (block.state == AheadBlock::State::wanted) block.state = AheadBlock::State::taken;
  }
  maker_.join();
  std::unique_lock lock(ahead_mutex);
  ahead_changed.wait(lock, [] { return waiting == 0; });
  for (const AheadBlock& block : *ahead)
    if (block.state == AheadBlock::State::ready) std::free(block.data);
  delete ahead;
  ahead = nullptr;
}

std::vector<size_t> blocks_of_picture(int width, int height, Quality quality) {
  const QualityValues values = values_of(quality);
  constexpr size_t texel = 4;  // of colours and of depths [byte]
  const size_t picture = size_t(width) * size_t(height) * texel;
  const size_t canvas = picture * size_t(values.samples);
  const size_t shadow = size_t(values.shadow_size) * size_t(values.shadow_size) * texel;
  return {canvas, canvas, picture, shadow};
}

}  // namespace tumble

#ifndef TUMBLE_SANITIZED  // sanitizers have their own memory
/// Takes the place of the C library's for the whole program. Software renderers get from it the
/// memory of their targets, which are cleared at once: in pages of 4 kB that costs as much time as
/// everything else of the first picture together, since each page is a call into the system.
extern "C" int posix_memalign(void** block, size_t alignment, size_t size) noexcept {
  using namespace tumble;
  const bool power = alignment != 0 && (alignment & (alignment - 1)) == 0;
  if (!power || alignment % sizeof(void*) != 0) return EINVAL;
  if (size > SIZE_MAX - huge_page) return ENOMEM;  // rounded up it would wrap around
  void* made = nullptr;
  if (size >= huge_page) {
    const size_t whole = in_huge_pages(size);
    if (alignment <= huge_page) made = take_ahead(whole);
    if (!made) made = make_block(alignment, whole);
  } else {
    made = std::aligned_alloc(alignment, size);
  }
  if (!made) return ENOMEM;
  *block = made;
  return 0;
}
#endif
