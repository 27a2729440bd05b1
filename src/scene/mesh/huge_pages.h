// An allocator for large arrays that are read in random order: on Linux in pages of 2 MiB where the system has them,
// because most reads of 4 KiB pages would miss the table of recent translations. Aligned to a cache line.
#pragma once

#include <cstddef>
#include <cstdlib>
#include <new>
#include <vector>

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace crescent::inline scene {

template <class T> struct HugePages {
    using value_type = T;
    static constexpr std::size_t page = std::size_t{1} << 21, line = 64;

    HugePages() = default;
    template <class U> HugePages(const HugePages<U>&) {}  // NOLINT(google-explicit-constructor): as allocators are

    T* allocate(std::size_t count) {
        const bool large = count * sizeof(T) >= page;
        const std::size_t unit = large ? page : line, bytes = (count * sizeof(T) + unit - 1) / unit * unit;
        void* at = std::aligned_alloc(unit, bytes);
        if (!at) throw std::bad_alloc();
#ifdef __linux__
        if (large) static_cast<void>(madvise(at, bytes, MADV_HUGEPAGE));  // a hint
#endif
        return static_cast<T*>(at);
    }
    void deallocate(T* at, std::size_t) { std::free(at); }
    bool operator==(const HugePages&) const { return true; }
};

template <class T> using HugeVector = std::vector<T, HugePages<T>>;

}  // namespace crescent::inline scene
