// The resources that a run needs, checked before it starts, and the handling of stops.
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

// ---- The memory and fonts that a run needs, checked before the work begins.

/// Returns the peak memory of a run in bytes: the films of its first seed and of one more pass, the references at each
/// exponent, what the camera sees, and the program itself.
std::uint64_t memory_needed(const Experiment& experiment);

/// Returns "this run needs about 70 GB of memory ...", with a smaller alternative; "" if `available` bytes are enough.
std::string why_too_large(const Experiment& experiment, std::uint64_t available);

/// Returns whether half of `available` bytes hold what is needed and the shading points of the image, which make a run
/// faster.
bool can_keep_points(const RunPlan& plan, const Scene& scene, std::uint64_t available);

/// Throws OutputError if the memory is insufficient.
void check_memory(const Experiment& experiment);
/// Throws OutputError if the font of the experiment's plates is missing.
void check_font(const Experiment& experiment);

// ---- Inside the steps of a run a stop is an exception; the steps return it as a value.

/// Limits the number to that of oneTBB, which otherwise prints a warning on stderr.
inline int threads_to_be_had(int threads) { return std::min(threads, oneapi::tbb::info::default_concurrency()); }

/// Does the work on this many threads; returns false if the monitor stopped it, during the work or at its end.
template <class Work> bool unless_stopped(int threads, const ProgressMonitor& monitor, const Work& work) {
    try {
        on_threads(threads_to_be_had(threads), work);
        monitor.check();
        return true;
    } catch (const Interrupted&) { return false; }
}

}  // namespace crescent::inline runs
