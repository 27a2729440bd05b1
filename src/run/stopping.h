// Inside the steps of a run a stop is an exception; outside it is an answer.
#pragma once

#include <oneapi/tbb/info.h>

#include <algorithm>

#include "base/parallel.h"
#include "base/progress_monitor.h"

namespace crescent::inline runs {

/// As many of these as oneTBB has: it complains on stderr of more.
inline int threads_to_be_had(int threads) { return std::min(threads, oneapi::tbb::info::default_concurrency()); }

/// Does the work on so many threads; false where the monitor stopped it, on the way or before its end.
template <class Work> bool unless_stopped(int threads, const ProgressMonitor& monitor, const Work& work) {
    try {
        on_threads(threads_to_be_had(threads), work);
        monitor.check();
        return true;
    } catch (const Interrupted&) { return false; }
}

}  // namespace crescent::inline runs
