// Blocks of memory for pictures, on large pages.
#include <cerrno>
#include <cstdint>
#include <cstdlib>

#include <sys/mman.h>

namespace {

/// Of a huge page on x86-64, and on most other machines [byte].
constexpr size_t huge_page = size_t{1} << 21;

}  // namespace

/// Takes the place of the C library's for the whole program. Software renderers get from it the
/// memory of their targets, which are cleared at once: in pages of 4 kB that costs as much time as
/// everything else of the first picture together, since each page is a call into the system. From
/// aligned blocks of 2 MB the system makes large pages.
extern "C" int posix_memalign(void** block, size_t alignment, size_t size) noexcept {
  const bool power = alignment != 0 && (alignment & (alignment - 1)) == 0;
  if (!power || alignment % sizeof(void*) != 0) return EINVAL;
  if (size > SIZE_MAX - huge_page) return ENOMEM;  // rounded up it would wrap around
  const bool large = size >= huge_page;
  // The last large page is used whole: a rest in small ones would cost more than its memory.
  const size_t whole = large ? (size + huge_page - 1) / huge_page * huge_page : size;
  void* made = std::aligned_alloc(large && alignment < huge_page ? huge_page : alignment, whole);
  if (!made) return ENOMEM;
  if (large) madvise(made, whole, MADV_HUGEPAGE);
  *block = made;
  return 0;
}
