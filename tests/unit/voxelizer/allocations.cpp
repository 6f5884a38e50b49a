#include "allocations.h"

#include <malloc.h>
#include <atomic>
#include <cstdlib>
#include <limits>
#include <new>

namespace {

constexpr std::size_t kNever = std::numeric_limits<std::size_t>::max();

std::atomic<std::size_t> g_count{0};
std::atomic<std::size_t> g_bytes{0};
std::atomic<std::size_t> g_peak{0};
std::atomic<std::size_t> g_until_failure{kNever};
std::atomic<bool> g_failed{false};

void* allocate(std::size_t size, std::size_t alignment) {
    g_count += 1;
    if (g_until_failure != kNever && g_until_failure-- == 0) {
        g_until_failure = kNever;
        g_failed = true;
        throw std::bad_alloc();
    }
    void* const memory = std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
    if (memory == nullptr) throw std::bad_alloc();
    const std::size_t now = g_bytes += malloc_usable_size(memory);
    std::size_t peak = g_peak;
    while (now > peak && !g_peak.compare_exchange_weak(peak, now)) {
    }
    return memory;
}

void release(void* memory) {
    if (memory == nullptr) return;
    g_bytes -= malloc_usable_size(memory);
    std::free(memory);
}

}  // namespace

void* operator new(std::size_t size) {
    return allocate(size, alignof(std::max_align_t));
}
void* operator new(std::size_t size, std::align_val_t alignment) {
    return allocate(size, static_cast<std::size_t>(alignment));
}
void* operator new(std::size_t size, const std::nothrow_t&) noexcept try {
    return allocate(size, alignof(std::max_align_t));
} catch (const std::bad_alloc&) {
    return nullptr;
}
void* operator new[](std::size_t size) {
    return allocate(size, alignof(std::max_align_t));
}
void operator delete(void* memory) noexcept {
    release(memory);
}
void operator delete(void* memory, const std::nothrow_t&) noexcept {
    release(memory);
}
void operator delete[](void* memory) noexcept {
    release(memory);
}
void operator delete[](void* memory, std::size_t) noexcept {
    release(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
    release(memory);
}
void operator delete(void* memory, std::align_val_t) noexcept {
    release(memory);
}
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
    release(memory);
}

namespace xorvox::test {

std::size_t allocation_count() {
    return g_count;
}
std::size_t allocated_bytes() {
    return g_bytes;
}
std::size_t peak_bytes() {
    return g_peak;
}
void reset_peak() {
    g_peak = g_bytes.load();
}
void fail_after(std::size_t count) {
    g_failed = false;
    g_until_failure = count;
}
bool has_failed() {
    g_until_failure = kNever;
    return g_failed;
}

}  // namespace xorvox::test
