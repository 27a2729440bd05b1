// First step of a run: turns an experiment into a list of jobs, as plain values that can be sent elsewhere. Nothing is
// computed here.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "experiment/experiment.h"
#include "samplers/external_sampler.h"

namespace crescent::inline runs {

/// One pass over the pixels: one arm, every sample count, one exponent, one seed.
struct Job {
    std::string arm, sampler;      // its name in the experiment, and its sampler in samplers/all.h
    std::vector<std::uint64_t> n;  // ascending
    double s = 0;
    std::uint32_t seed = 0;
    std::shared_ptr<const ExternalSampler> outside = {};  // set by execute() if the arm is not built in
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
};

/// Throws InputError if the series has no such seeds, or the published values cannot be read.
RunPlan plan(const Experiment& experiment, SeedRange range = {});

/// Returns the series of seeds of an experiment, all different: its own first.
std::vector<std::uint32_t> seeds_of(const Experiment& experiment);

/// Returns every pass of one seed: each arm at the experiment's own s, then the exponent control if it adds any.
std::vector<Job> jobs_of(const Experiment& experiment, std::uint32_t seed);

}  // namespace crescent::inline runs
