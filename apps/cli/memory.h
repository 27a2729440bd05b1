// How this process allocates memory.
#pragma once

namespace crescent::cli {

/// For commands that allocate and free arrays of the same sizes again and again: keeps freed memory, so that the system
/// need not provide new pages each time.
void keep_freed_memory();

}  // namespace crescent::cli
