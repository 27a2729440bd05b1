// Settings of glibc's malloc; nothing with another C library.
#include "memory.h"

#ifdef __GLIBC__
#include <malloc.h>

#include <limits>
#endif

namespace crescent::cli {

void keep_freed_memory() {
#ifdef __GLIBC__
    mallopt(M_MMAP_MAX, 0);
    mallopt(M_TRIM_THRESHOLD, std::numeric_limits<int>::max());
#endif
}

}  // namespace crescent::cli
