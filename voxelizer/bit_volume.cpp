#include "voxelizer/bit_volume.h"

#include <cstdlib>
#include <new>

#include <sys/mman.h>

namespace xorvox {
namespace {

constexpr std::size_t kCacheLine = 64;
constexpr std::size_t kHugePage = std::size_t{2} << 20;

}  // namespace

std::uint64_t* allocate_words(std::size_t words) {
    if (words > SIZE_MAX / sizeof(std::uint64_t) - kHugePage) throw std::bad_alloc();
    std::size_t bytes = words * sizeof(std::uint64_t);
    const std::size_t alignment = bytes < kHugePage ? kCacheLine : kHugePage;
    bytes = (bytes + alignment - 1) / alignment * alignment;
    void* const memory = std::aligned_alloc(alignment, bytes);
    if (memory == nullptr) throw std::bad_alloc();
#ifdef MADV_HUGEPAGE
    // A wish: without huge pages the memory is as good, but slower to touch for the first time.
    if (alignment == kHugePage) (void)madvise(memory, bytes, MADV_HUGEPAGE);
#endif
    return static_cast<std::uint64_t*>(memory);
}

void release_words(std::uint64_t* first, std::size_t) {
    std::free(first);
}

}  // namespace xorvox
