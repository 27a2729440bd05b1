// A pipe whose ends are not inherited by programs that are started: in one call where the system has it (Linux), else
// in two, between which another thread's child may inherit them.
#pragma once

#include <fcntl.h>
#include <unistd.h>

namespace crescent::inline base {

/// ends[0] to read from, ends[1] to write to; false and errno where there is none to be had.
inline bool make_pipe(int (&ends)[2]) {
#ifdef __linux__
    return ::pipe2(ends, O_CLOEXEC) == 0;
#else
    if (::pipe(ends) != 0) return false;
    for (const int end : ends) ::fcntl(end, F_SETFD, FD_CLOEXEC);
    return true;
#endif
}

}  // namespace crescent::inline base
