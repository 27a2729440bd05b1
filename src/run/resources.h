// What a run needs of the machine, checked before it starts, and when it is asked to stop.
#pragma once

#include <algorithm>
#include <cstdint>
#include <oneapi/tbb/info.h>
#include <string>

#include "base/parallel.h"
#include "base/progress.h"
#include "experiment/experiment.h"
#include "run/plan.h"
#include "scene/scene.h"

namespace crescent::inline runs {

// ---- What a run needs of the machine, told before the work begins.

/// Bytes that a run holds at its largest: the films of its first seed and of one pass more, the references at each
/// exponent, what the camera sees, and what the program takes for itself.
std::uint64_t memory_needed(const Experiment& experiment);

/// "this run needs about 70 GB of memory ...", with what would need less; "" where `available` bytes are enough.
std::string why_too_large(const Experiment& experiment, std::uint64_t available);

/// Whether half of `available` bytes hold what is needed and the shading points of the image, which a run is
/// faster with.
bool can_keep_points(const RunPlan& plan, const Scene& scene, std::uint64_t available);

/// Throws OutputError where the memory is not there.
void check_memory(const Experiment& experiment);
/// Throws OutputError where the font that the experiment's plates are drawn with is not there.
void check_font(const Experiment& experiment);

// ---- Inside the steps of a run a stop is an exception; outside it is an answer.

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
