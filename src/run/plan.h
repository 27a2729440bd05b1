// First step of a run: turns an experiment into a list of jobs, as plain values that can be sent elsewhere, and checks
// the resources that they need. Nothing is computed here.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <oneapi/tbb/info.h>
#include <string>
#include <vector>

#include "base/parallel.h"
#include "base/progress.h"
#include "experiment/experiment.h"
#include "samplers/sampler_adapter.h"
#include "scene/scene.h"

namespace crescent {

/// One pass over the pixels: one arm, every sample count, one exponent, one seed.
struct Job {
    std::string arm, sampler;      // its name in the experiment, and its sampler in samplers/all.h
    std::vector<std::uint64_t> n;  // ascending
    double s = 0;
    std::uint32_t seed = 0;
    std::shared_ptr<const SamplerAdapter> outside = {};  // set by execute() if the arm is not built in
};

/// A part of an experiment's series of seeds, counted from 1, both ends included; last = 0: to the end of the series.
struct SeedRange {
    int first = 1, last = 0;
};

struct RunPlan {
    /// The experiment as given, with its published values. What does not depend on the seeds of this plan is measured
    /// for it.
    Experiment whole;
    /// The same; its seed is the first of this plan's, and `seeds` is their number.
    Experiment experiment;
    std::uint64_t hash = 0;            // of the whole
    SeedRange range;                   // last is never 0 here
    std::vector<std::uint32_t> seeds;  // all different; films of the first are kept, only metrics of the others
    std::vector<double> exponents;     // every s of a job: each needs a reference
    std::vector<Job> jobs;             // seed by seed
    bool references = true;            // false: films alone, without metrics
};

/// Throws InputError if the series has no such seeds, or the published values cannot be read.
RunPlan plan(const Experiment& experiment, SeedRange range = {});

/// Returns the series of seeds of an experiment, all different: its own first.
std::vector<std::uint32_t> seeds_of(const Experiment& experiment);

/// Returns every pass of one seed: each arm at the experiment's own s, then the exponent control if it adds any.
std::vector<Job> jobs_of(const Experiment& experiment, std::uint32_t seed);

// ---- The memory and fonts that a run needs, checked before the work begins.

/// Returns the peak memory of a run in bytes if its shading points are kept in `points` bytes: the films of its first
/// seed and of one more pass, the references at each exponent, what the camera sees, and the program itself.
std::uint64_t memory_needed(const Experiment& experiment, std::uint64_t points = 0);

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

}  // namespace crescent
